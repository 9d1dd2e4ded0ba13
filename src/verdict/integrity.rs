//! Is everything there, and is it a number?

use std::cmp::Ordering;

use scenarios::slung_load::{Model, State};
use scenarios::{CheckSpec, Plan, Scenario, Trajectory, Vehicle};

use crate::verdict::Check;
use crate::verdict::compare::exceeds;
use crate::verdict::evidence::{Decide, Measurement};

/// A first node may differ from the vehicle's start by this much, which is what a file's decimals leave, m and m/s.
const START_TOLERANCE: f64 = 0.01;
/// The first time may differ from 0 by this much, s.
pub const TIME_TOLERANCE_S: f64 = 1e-9;

/// Can the plan be flown at all: has every vehicle a trajectory, whole, finite, from its start, forward in time?
///
/// The reason if not, naming the vehicle.
pub fn is_flyable(scenario: &Scenario, plan: &Plan) -> Result<(), String> {
    if plan.trajectories.is_empty() {
        return Err("there is no plan".to_owned());
    }
    if let Some(defect) = trajectory_defects(scenario, plan).into_iter().next() {
        return Err(defect);
    }
    match plan
        .trajectories
        .iter()
        .find(|trajectory| trajectory.nodes().numbers().iter().any(|value| !value.is_finite()))
    {
        Some(trajectory) => Err(format!("{}: the trajectory holds a number that is not finite", trajectory.vehicle())),
        None => Ok(()),
    }
}

/// Number of numbers in the plan that are not finite, in its trajectories and in what it says of itself.
pub fn check_plan_finite(spec: &CheckSpec, plan: &Plan) -> Check {
    if plan.trajectories.is_empty() {
        return spec.fail("there is no plan");
    }
    let mut count = plan_numbers(plan).filter(|value| !value.is_finite()).count();
    let mut odd = Vec::new();
    for trajectory in &plan.trajectories {
        let here = trajectory.nodes().numbers().iter().filter(|value| !value.is_finite()).count();
        if here > 0 {
            odd.push(trajectory.vehicle());
        }
        count += here;
    }
    none_of(spec, count, &odd, None)
}

/// Number of vehicles whose trajectory is missing, misnamed, too short, of unequal lengths, not forward in time, or not
/// from the vehicle's start; and of trajectories without a vehicle.
pub fn check_plan_complete(spec: &CheckSpec, scenario: &Scenario, plan: &Plan) -> Check {
    let defects = trajectory_defects(scenario, plan);
    none_of(spec, defects.len(), &[], defects.first())
}

/// Passes if `count` is 0.
pub fn none_of(spec: &CheckSpec, count: usize, between: &[&str], reason: Option<&String>) -> Check {
    let mut measured = between.iter().fold(Measurement::value(count as f64), |measured, name| measured.with(name));
    if let Some(reason) = reason {
        measured = measured.with_reason(reason);
    }
    spec.at_most(measured, 0.0)
}

/// What is wrong with each vehicle's trajectory, in words, one entry for each that is not in order.
fn trajectory_defects(scenario: &Scenario, plan: &Plan) -> Vec<String> {
    let of_vehicle = |(index, vehicle): (usize, &Vehicle)| match plan.trajectories.get(index) {
        None => Some(format!("{}: there is no trajectory", vehicle.name)),
        Some(trajectory) => {
            trajectory_defect(scenario, vehicle, trajectory).map(|defect| format!("{}: {defect}", vehicle.name))
        }
    };
    let surplus = plan.trajectories.iter().skip(scenario.vehicles.len());
    let no_vehicle = surplus.map(|trajectory| format!("{}: no such vehicle, or twice", trajectory.vehicle()));
    scenario.vehicles.iter().enumerate().filter_map(of_vehicle).chain(no_vehicle).collect()
}

fn trajectory_defect(scenario: &Scenario, vehicle: &Vehicle, trajectory: &Trajectory) -> Option<String> {
    let (nodes, times_s) = (trajectory.nodes(), trajectory.times_s());
    if trajectory.vehicle() != vehicle.name {
        return Some(format!("the trajectory of {} stands in its place", trajectory.vehicle()));
    }
    if trajectory.family() != scenario.family() {
        return Some(format!(
            "a trajectory of a {}, where the vehicle is a {}",
            trajectory.family(),
            scenario.family()
        ));
    }
    if nodes.counts().iter().any(|(_, count)| *count != times_s.len()) {
        let counts = nodes.counts().iter().map(|(what, count)| format!("{count} {what}")).collect::<Vec<_>>();
        let counted = counts.join(" and ");
        return Some(format!("{} times, {counted}, which should be as many", times_s.len()));
    }
    if let Some(node) = stray_node(trajectory) {
        return Some(format!("it names node {node} as its planner's own, of {}", times_s.len()));
    }
    if times_s.len() < 2 {
        return Some(format!("{} nodes, at least 2 are needed", times_s.len()));
    }
    time_defect(trajectory).or_else(|| {
        let load = match trajectory {
            Trajectory::FixedWing(_) | Trajectory::Multirotor(_) => None,
            Trajectory::SlungLoad(trajectory) => {
                load_defect(scenario.slung_load_model(vehicle), vehicle, &trajectory.states[0])
            }
        };
        start_defect("m", nodes.position_m(0), vehicle.start.position_m(), START_TOLERANCE)
            .or_else(|| start_defect("m/s", nodes.velocity_mps(0), vehicle.start.velocity_mps(), START_TOLERANCE))
            .or(load)
    })
}

/// A planner's own node that is none.
fn stray_node(trajectory: &Trajectory) -> Option<usize> {
    match trajectory {
        Trajectory::FixedWing(_) | Trajectory::Multirotor(_) => None,
        Trajectory::SlungLoad(it) => it.planner_nodes.iter().copied().find(|node| *node >= it.times_s.len()),
    }
}

/// Does a quadrotor begin level, not turning, and with its load where it is?
fn load_defect(model: &Model, vehicle: &Vehicle, first: &State) -> Option<String> {
    let start = State::at(&vehicle.start, model.cable_length_m);
    start_defect("m (the load)", first.load_position_m, start.load_position_m, START_TOLERANCE)
        .or_else(|| start_defect("m/s (the load)", first.load_velocity_mps, start.load_velocity_mps, START_TOLERANCE))
        .or_else(|| start_defect("rad", first.roll_pitch_yaw_rad, start.roll_pitch_yaw_rad, START_TOLERANCE))
        .or_else(|| start_defect("rad/s", first.body_rate_radps, start.body_rate_radps, START_TOLERANCE))
}

/// Do the times start at 0 and increase? (Or stand still, where a jump is in order.)
fn time_defect(trajectory: &Trajectory) -> Option<String> {
    let times_s = trajectory.times_s();
    if exceeds(times_s[0].abs(), TIME_TOLERANCE_S) {
        return Some(format!("the first time is {} s, which should be 0 s", times_s[0]));
    }
    let is_in_order = |pair: &&[f64]| match pair[0].partial_cmp(&pair[1]) {
        Some(Ordering::Less) => true,
        Some(Ordering::Equal) => trajectory.allows_discontinuity(),
        _ => false,
    };
    let pair = times_s.windows(2).find(|pair| !is_in_order(pair))?;
    Some(format!("after the time {} s comes {} s", pair[0], pair[1]))
}

/// Is `first` the vehicle's `start`, within `tolerance`? All in `unit`.
pub fn start_defect(unit: &str, first: [f64; 3], start: [f64; 3], tolerance: f64) -> Option<String> {
    let distance = (0..3).map(|axis| (first[axis] - start[axis]).powi(2)).sum::<f64>().sqrt();
    exceeds(distance, tolerance).then(|| format!("it begins {distance:.3} {unit} away from the vehicle's start"))
}

/// The numbers that a plan says of itself.
fn plan_numbers(plan: &Plan) -> impl Iterator<Item = f64> + '_ {
    let history = plan.history.iter().flat_map(|iteration| {
        let always = [
            iteration.objective,
            iteration.dt_s,
            iteration.defect_m,
            iteration.slack,
            iteration.change_m,
            iteration.trust_region_m,
            iteration.wall_s,
            iteration.distributed_s,
        ];
        always.into_iter().chain(iteration.separation_m).chain(iteration.clearance_m)
    });
    let events = plan.diagnostics.events.iter().map(|event| event.at_s);
    let alternatives = plan.diagnostics.alternatives.iter();
    let ways = alternatives.flat_map(|way| way.objective.into_iter().chain(way.path_m.iter().copied().flatten()));
    let timings = [plan.timings.wall_s, plan.timings.distributed_s];
    history.chain(plan.objective).chain(timings).chain(events).chain(ways)
}
