//! The judge of multirotors: plans that were there before the flight, and flights that were planned in the loop.

mod clearance;
mod limits;
mod physics;
pub mod planning;
mod rest;

use scenarios::{CheckSpec, Family, Plan};

pub use clearance::{Clearances, ObstacleApproach, closest};

use crate::verdict::case::Case;
use crate::verdict::evidence::{Decide, Evidence};
use crate::verdict::motion::{Knot, Motion};
use crate::verdict::{Check, arrival, separation};

/// Why a plan of positions and velocities has no defects of its own.
const NO_DYNAMICS: &str =
    "positions and velocities name the accelerations that lead from one to the next: see control_limits";
/// Why a plan is not flown open loop.
const NO_ROLLOUT: &str = "without feedback a double integrator drifts, whatever its plan";

/// Every check of multirotors.
pub fn checks(case: &Case<'_>) -> Vec<Check> {
    let planned = case.flyable().map_err(str::to_owned).and_then(planned_motions);
    let planned = planned.as_deref().map_err(String::as_str);
    case.checks(Family::Multirotor, |spec| check(spec, case, planned))
}

fn check(spec: &CheckSpec, case: &Case<'_>, planned: Evidence<'_, [Motion]>) -> Check {
    let (scenario, flyable, flown) = (case.scenario, case.flyable(), case.flown());
    let flown_motions = flown.map(|flown| flown.motions.as_slice());
    match spec.name {
        "nodes.separation" => separation::check_nodes(spec, scenario, flyable),
        "nodes.clearance" => clearance::check_nodes(spec, scenario, planned),
        "nodes.state_limits" => limits::check_node_states(spec, scenario, planned),
        "nodes.control_limits" | "plan.control_limits" => limits::check_accelerations(spec, scenario, planned),
        "nodes.goal" => arrival::check_node_goals(spec, scenario, flyable),
        "plan.separation" => separation::check(spec, scenario, planned),
        "plan.clearance" => clearance::check(spec, scenario, planned),
        "plan.state_limits" => limits::check_planned_states(spec, scenario, planned),
        "plan.dynamics" => spec.skip(NO_DYNAMICS),
        "plan.rollout" => spec.skip(NO_ROLLOUT),
        "plan.goal" => arrival::check_planned_goals(spec, scenario, planned),
        "plan.rest" => rest::check_planned(spec, scenario, planned),
        "flight.crash" => case.crash(spec, flown),
        "flight.separation" => separation::check(spec, scenario, flown_motions),
        "flight.clearance" => clearance::check(spec, scenario, flown_motions),
        "flight.state_limits" => limits::check_flown_states(spec, scenario, flown),
        "flight.control_limits" => limits::check_flown_controls(spec, scenario, flown),
        "flight.dynamics" => physics::check(spec, scenario, case.flight()),
        "flight.goal" => arrival::check_flown_goals(spec, scenario, flown),
        "flight.rest" => rest::check_flown(spec, scenario, case.plan, flown),
        _ => case.shared(spec),
    }
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
