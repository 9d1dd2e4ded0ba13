//! Plan integrity: every vehicle has a whole trajectory of finite numbers.

use scenarios::{CheckSpec, Plan, Scenario, Trajectory};

use crate::verdict::Check;
use crate::verdict::evidence::{Decide, Measurement};
use crate::verdict::missing_evidence::MissingEvidence;
use crate::verdict::trajectory_defect::{self, TrajectoryDefect};

/// Whether the plan can be simulated: every vehicle has a trajectory that is whole and finite, begins at the vehicle's start,
/// and goes forward in time.
///
/// # Errors
///
/// The first defect, with the vehicle's name.
pub fn is_flyable(scenario: &Scenario, plan: &Plan) -> Result<(), MissingEvidence> {
    if plan.trajectories.is_empty() {
        return Err(MissingEvidence::NoPlan);
    }
    let not_finite = plan.trajectories.iter().filter(|trajectory| not_finite_count(trajectory) > 0);
    let mut defects = trajectory_defects(scenario, plan)
        .chain(not_finite.map(|trajectory| (trajectory.vehicle(), TrajectoryDefect::NotFinite)));
    match defects.next() {
        None => Ok(()),
        Some((vehicle, defect)) => Err(MissingEvidence::NotFlyable { vehicle: vehicle.to_owned(), defect }),
    }
}

/// Number of values in the plan that are not finite: in its trajectories and in the planner's own figures.
pub fn check_plan_finite(spec: &CheckSpec, plan: &Plan) -> Check {
    if plan.trajectories.is_empty() {
        return spec.fail(MissingEvidence::NoPlan);
    }
    let mut count = planner_figures(plan).filter(|value| !value.is_finite()).count();
    let mut concerned = Vec::new();
    for trajectory in &plan.trajectories {
        let own = not_finite_count(trajectory);
        if own > 0 {
            concerned.push(trajectory.vehicle());
        }
        count += own;
    }
    none_of(spec, count, &concerned, None)
}

/// Number of vehicles whose trajectory has a [defect](TrajectoryDefect), and of trajectories without a vehicle.
pub fn check_plan_complete(spec: &CheckSpec, scenario: &Scenario, plan: &Plan) -> Check {
    let defects: Vec<String> =
        trajectory_defects(scenario, plan).map(|(vehicle, defect)| format!("{vehicle}: {defect}")).collect();
    none_of(spec, defects.len(), &[], defects.first())
}

/// The check of a `count` that should be 0.
pub fn none_of(spec: &CheckSpec, count: usize, between: &[&str], reason: Option<&String>) -> Check {
    let mut measured = between.iter().fold(Measurement::value(count as f64), |measured, name| measured.with(name));
    if let Some(reason) = reason {
        measured = measured.with_reason(reason);
    }
    spec.at_most(measured, 0.0)
}

fn not_finite_count(trajectory: &Trajectory) -> usize {
    trajectory.nodes().numbers().iter().filter(|value| !value.is_finite()).count()
}

/// At most one defect per vehicle, with its name.
fn trajectory_defects<'a>(scenario: &'a Scenario, plan: &'a Plan) -> impl Iterator<Item = (&'a str, TrajectoryDefect)> {
    let of_vehicles = scenario.vehicles.iter().enumerate().filter_map(|(index, vehicle)| {
        let defect = match plan.trajectories.get(index) {
            None => Some(TrajectoryDefect::Missing),
            Some(trajectory) => trajectory_defect::find(scenario, vehicle, trajectory),
        };
        defect.map(|defect| (vehicle.name.as_str(), defect))
    });
    let surplus = plan.trajectories.iter().skip(scenario.vehicles.len());
    of_vehicles.chain(surplus.map(|trajectory| (trajectory.vehicle(), TrajectoryDefect::WithoutVehicle)))
}

/// The numbers that the planner reports about its plan.
fn planner_figures(plan: &Plan) -> impl Iterator<Item = f64> + '_ {
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
    let alternatives =
        plan.diagnostics.alternatives.iter().flat_map(|alternative| {
            alternative.objective.into_iter().chain(alternative.path_m.iter().copied().flatten())
        });
    let timings = [plan.timings.wall_s, plan.timings.distributed_s];
    history.chain(plan.objective).chain(timings).chain(events).chain(alternatives)
}
