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

#[cfg(test)]
mod tests {
    use std::path::Path;

    use scenarios::fixed_wing::{Control, State, Trajectory};
    use scenarios::{Interpolation, Plan, check_spec};

    use super::{check_plan_complete, check_plan_finite};
    use crate::verdict::Status;

    fn plan(vehicles: &[&str]) -> Plan {
        let trajectory = |vehicle: &&str| Trajectory {
            vehicle: (*vehicle).into(),
            interpolation: Interpolation::FirstOrderHold,
            times_s: vec![0.0, 1.0],
            states: vec![State::from_array([0.0, 0.0, 300.0, 35.0, 0.0, 0.0]); 2],
            controls: vec![Control::CRUISE; 2],
        };
        Plan::new("pair", "by-hand", 0, vehicles.iter().map(|vehicle| trajectory(vehicle).into()).collect())
    }

    #[test]
    fn every_number_that_is_not_finite_is_counted_and_its_vehicle_named() {
        let mut plan = plan(&["uav-1", "uav-2"]);
        let spec = check_spec("plan.finite").unwrap();
        assert_eq!(check_plan_finite(spec, &plan).status, Status::Pass);
        let scenarios::Trajectory::FixedWing(second) = &mut plan.trajectories[1] else { unreachable!() };
        (second.times_s[1], second.states[0].speed_mps, second.states[1].speed_mps) =
            (f64::NAN, f64::INFINITY, f64::NAN);
        plan.objective = Some(f64::NAN);
        let check = check_plan_finite(spec, &plan);
        assert_eq!((check.status, check.value), (Status::Fail, Some(4.0)));
        assert_eq!(check.between, ["uav-2"]);
        plan.trajectories.clear();
        assert_eq!(check_plan_finite(spec, &plan).status, Status::Fail);
    }

    #[test]
    fn a_vehicle_without_a_trajectory_and_a_trajectory_without_a_vehicle_are_defects() {
        let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenarios/fixed-wing/rendezvous-2.toml");
        let scenario = scenarios::load(&file).unwrap();
        let defects = |vehicles: &[&str]| {
            let mut plan = plan(vehicles);
            for (trajectory, vehicle) in plan.trajectories.iter_mut().zip(&scenario.vehicles) {
                let scenarios::Trajectory::FixedWing(trajectory) = trajectory else { unreachable!() };
                let start = &vehicle.start;
                let ([x, y, z], [turn, climb]) =
                    (start.position_m(), [start.heading_deg, start.flight_path_deg].map(f64::to_radians));
                trajectory.states = vec![State::from_array([x, y, z, start.speed_mps, turn, climb]); 2];
            }
            check_plan_complete(check_spec("plan.complete").unwrap(), &scenario, &plan).value.unwrap()
        };
        let [one, two] = [0, 1].map(|index| scenario.vehicles[index].name.as_str());
        assert_eq!([defects(&[one, two]), defects(&[one]), defects(&[one, two, "uav-99"])], [0.0, 1.0, 1.0]);
    }
}
