//! The judge of multirotors: plans that were there before the flight, and flights that were planned in the loop.

mod clearance;
mod limits;
mod physics;
pub mod planning;
mod rest;

use scenarios::{Plan, Scenario};
use sim::Flight;

pub use clearance::{Closest, closest, over_time as clearance_over_time};

use self::clearance::check as check_clearance;
use crate::verdict::motion::{Knot, Motion};
use crate::verdict::question::{Evidence, Group, Question};
use crate::verdict::{Check, Flown, arrival, integrity, separation, tracking};

/// Why nothing is asked of a plan that came into being during the flight.
const IN_THE_LOOP: &str = "planned in the loop: before the flight there was no plan";

/// What is asked of nodes and plan, with the units.
const NODES: [(&str, &str); 5] =
    [("separation", "m"), ("clearance", "m"), ("state_limits", "-"), ("control_limits", "-"), ("goal", "m")];
const PLAN: [(&str, &str); 12] = [
    ("finite", "numbers"),
    ("complete", "vehicles"),
    ("separation", "m"),
    ("clearance", "m"),
    ("state_limits", "-"),
    ("control_limits", "-"),
    ("dynamics", "m"),
    ("rollout", "m"),
    ("goal", "m"),
    ("rest", "m/s"),
    ("arrival", "s"),
    ("duration", "s"),
];

/// The groups `nodes` and `plan`.
///
/// - `in_the_loop`: was the plan made during the flight? Then neither is asked
pub fn plan_checks(scenario: &Scenario, plan: &Plan, flyable: Evidence<'_, ()>, in_the_loop: bool) -> Vec<Check> {
    if in_the_loop {
        let skipped = |group: Group, (name, unit): (&'static str, &'static str)| {
            Question::new(group, name, unit).skip(IN_THE_LOOP)
        };
        let nodes = NODES.into_iter().map(|asked| skipped(Group::Nodes, asked));
        return nodes.chain(PLAN.into_iter().map(|asked| skipped(Group::Plan, asked))).collect();
    }
    let nodes = flyable.map(|()| plan);
    let planned = flyable.map_err(str::to_owned).and_then(|()| planned_motions(plan));
    let motions = planned.as_deref().map_err(String::as_str);
    let node_motions = motions;
    let no_dynamics =
        "positions and velocities name the accelerations that lead from one to the next: see control_limits";
    let skip = |name, unit, why: &str| Question::new(Group::Plan, name, unit).skip(why);
    vec![
        separation::check_nodes(scenario, nodes),
        clearance::check_nodes(scenario, node_motions),
        limits::check_node_states(scenario, node_motions),
        limits::check_accelerations(Group::Nodes, scenario, motions),
        arrival::check_node_goals(scenario, nodes),
        integrity::check_plan_finite(plan),
        integrity::check_plan_complete(scenario, plan),
        separation::check(Group::Plan, scenario, motions),
        check_clearance(Group::Plan, scenario, motions),
        limits::check_planned_states(scenario, motions),
        limits::check_accelerations(Group::Plan, scenario, motions),
        skip("dynamics", "m", no_dynamics),
        skip("rollout", "m", "without feedback a double integrator drifts, whatever its plan"),
        arrival::check_planned_goals(scenario, motions),
        rest::check_planned(scenario, motions),
        arrival::check_planned_arrival(scenario, nodes),
        arrival::check_planned_duration(scenario, nodes),
    ]
}

/// The group `flight`, what concerns the log itself aside.
pub fn flight_checks(
    scenario: &Scenario,
    plan: &Plan,
    flight: Evidence<'_, Flight>,
    flown: Evidence<'_, Flown<'_>>,
) -> Vec<Check> {
    let motions = flown.map(|flown| flown.motions.as_slice());
    vec![
        separation::check(Group::Flight, scenario, motions),
        check_clearance(Group::Flight, scenario, motions),
        limits::check_flown_states(scenario, flown),
        limits::check_flown_controls(scenario, flown),
        physics::check(scenario, flight),
        arrival::check_flown_goals(scenario, flown),
        rest::check_flown(scenario, plan, flown),
        arrival::check_flown_arrival(scenario, flown),
        arrival::check_flown_duration(scenario, flown),
        tracking::check_root_mean_square(scenario, flown),
        tracking::check_largest(scenario, flown),
        tracking::check_saturation(scenario, flown),
    ]
}

/// The plan as continuous motions: its own cubics between its nodes.
fn planned_motions(plan: &Plan) -> Result<Vec<Motion>, String> {
    let motion = |trajectory: &scenarios::multirotor::Trajectory| {
        let knots = trajectory.nodes().into_iter();
        let knot = |node: scenarios::in_loop::Node| Knot {
            t_s: node.t_s,
            position_m: node.position_m,
            velocity_mps: node.velocity_mps,
        };
        Motion::new(&trajectory.vehicle, knots.map(knot).collect())
    };
    plan.trajectories.iter().map(|trajectory| motion(trajectory.multirotor())).collect()
}
