//! Converts the last iterates to a plan and determines its status.

use std::time::Duration;

use scenarios::fixed_wing::{Control, State, Trajectory};
use scenarios::{Interpolation, Iteration, Plan, PlanStatus, PlanTimings, Scenario};

use super::interval::Interval;
use super::iterate::{Iterate, max_dt_s, max_flight_time_s};
use super::{dynamics, shooting};

/// Largest violation of a linearised row of a solved plan, in scaled units: a millimetre of position.
const SLACK_TOLERANCE: f64 = 1e-6;

/// Largest position defect of a solved plan by the planner's own transcription, m.
const DEFECT_TOLERANCE_M: f64 = 0.1;

/// Distance by which a solved plan may fall short of separation and clearance at its nodes, m: the rounding of a solver
/// whose rows hold to its tolerance.
const NODE_TOLERANCE_M: f64 = 1e-5;

/// Relative difference below which step lengths are made equal: vehicles that arrive together then share their nodes,
/// which the solver tolerance would otherwise set apart by microseconds.
const EQUAL_DT_TOLERANCE: f64 = 1e-7;

/// The plan of the last iterates.
pub fn assemble(
    scenario: &Scenario,
    planner: &str,
    seed: u64,
    trajectories: &[Iterate],
    history: Vec<Iteration>,
    (status, reason): (PlanStatus, Option<String>),
    elapsed: Duration,
) -> Plan {
    let named = scenario.vehicles.iter().zip(trajectories);
    let max_dt_s = max_dt_s(trajectories);
    let is_max = |iterate: &Iterate| max_dt_s - iterate.dt_s <= EQUAL_DT_TOLERANCE * max_dt_s;
    let dt_s = |iterate: &Iterate| if is_max(iterate) { max_dt_s } else { iterate.dt_s };
    let distributed_s = history.iter().map(|iteration| iteration.distributed_s).sum();
    Plan {
        status,
        reason,
        objective: Some(max_flight_time_s(trajectories)),
        history,
        timings: PlanTimings { wall_s: elapsed.as_secs_f64(), distributed_s },
        ..Plan::new(
            &scenario.name,
            planner,
            seed,
            named.map(|(vehicle, iterate)| trajectory(&vehicle.name, iterate, dt_s(iterate)).into()).collect(),
        )
    }
}

/// The iterate as a trajectory of a plan. The end of a control ramp within an interval becomes a node, so that controls
/// are linear between nodes.
fn trajectory(vehicle: &str, iterate: &Iterate, dt_s: f64) -> Trajectory {
    let mut trajectory = Trajectory {
        vehicle: vehicle.to_string(),
        interpolation: Interpolation::FirstOrderHold,
        times_s: Vec::new(),
        states: Vec::new(),
        controls: Vec::new(),
    };
    append(&mut trajectory, iterate, dt_s);
    trajectory
}

/// Adds the nodes of an iterate after the last node of a trajectory, where it begins.
fn append(trajectory: &mut Trajectory, iterate: &Iterate, dt_s: f64) {
    let from_s = trajectory.times_s.last().copied();
    let mut push = |t_s: f64, state: dynamics::State, control: dynamics::Control| {
        trajectory.times_s.push(from_s.unwrap_or(0.0) + t_s);
        trajectory.states.push(State::from_array(state.into()));
        trajectory.controls.push(Control::from_array(control.into()));
    };
    for k in 0..=iterate.intervals() {
        if k > 0 || from_s.is_none() {
            push(k as f64 * dt_s, iterate.states[k], iterate.controls[k]);
        }
        if k < iterate.intervals() && iterate.ramp < 1.0 {
            let interval = Interval { dt_s, ..iterate.interval(k) };
            push((k as f64 + iterate.ramp) * dt_s, shooting::ramp_end(&interval), interval.controls[1]);
        }
    }
}

/// Adds to the trajectories of a plan of fixed wings what follows on their arrival.
pub fn go_on(plan: &mut Plan, holds: &[Option<Iterate>]) {
    let end_s = plan.flight_time_s().unwrap_or(0.0);
    for (trajectory, hold) in plan.trajectories.iter_mut().zip(holds) {
        if let (scenarios::Trajectory::FixedWing(trajectory), Some(hold)) = (trajectory, hold) {
            append(trajectory, hold, hold.dt_s);
            // the sum of the intervals may round to beyond the last arrival
            if let Some(last_s) = trajectory.times_s.last_mut() {
                *last_s = end_s;
            }
        }
    }
}

/// The status of a plan: solved only if the sequence has converged, all subproblems of the last iteration are solved,
/// the vehicles arrive together where they have to (`excess_spread_s` is absent), and the rows, the transcribed equations of motion and the constraints at the nodes hold.
pub fn status(
    scenario: &Scenario,
    history: &[Iteration],
    converged: bool,
    limit: usize,
    excess_spread_s: Option<f64>,
) -> (PlanStatus, Option<String>) {
    let Some(last) = history.last() else {
        return (PlanStatus::NotConverged, Some("no iteration was allowed".to_string()));
    };
    let separation_m = scenario.horizontal_separation_m().unwrap_or(0.0);
    let too_close = last.separation_m.is_some_and(|distance| distance < separation_m - NODE_TOLERANCE_M);
    let failure_reason = if last.unsolved > 0 {
        // a trajectory whose subproblem was not solved may be unchanged without having converged
        Some(format!("{} subproblems of the last iteration were not solved", last.unsolved))
    } else if let Some(spread_s) = excess_spread_s {
        Some(format!("the flight times differ by {spread_s:.3} s"))
    } else if !converged {
        Some(format!("the trajectories still moved by {:.3} m after {limit} iterations", last.change_m))
    } else if last.slack > SLACK_TOLERANCE {
        Some(format!("constraints are violated by up to {:.2e} scaled units", last.slack))
    } else if last.defect_m > DEFECT_TOLERANCE_M {
        Some(format!("the equations of motion are violated by up to {:.3} m per interval", last.defect_m))
    } else if too_close || last.clearance_m.is_some_and(|clearance| clearance < -NODE_TOLERANCE_M) {
        Some("separation or clearance is violated at the nodes".to_string())
    } else {
        None
    };
    (if failure_reason.is_none() { PlanStatus::Solved } else { PlanStatus::NotConverged }, failure_reason)
}

/// Smallest horizontal distance between two vehicles at the nodes, m, by sweep and prune along x.
pub fn node_separation_m(trajectories: &[&Iterate]) -> Option<f64> {
    let nodes = trajectories.iter().map(|trajectory| trajectory.states.len()).max()?;
    let mut min_m = f64::INFINITY;
    for node in 0..nodes {
        let present = trajectories.iter().filter(|trajectory| node < trajectory.states.len());
        let mut by_x: Vec<[f64; 2]> = present.map(|trajectory| trajectory.position_m(node)).collect();
        by_x.sort_by(|a, b| a[0].total_cmp(&b[0]));
        for (index, a) in by_x.iter().enumerate() {
            let near = by_x[index + 1..].iter().take_while(|b| b[0] - a[0] < min_m);
            let closest_m = near.map(|b| distance_m(*a, *b)).fold(f64::INFINITY, f64::min);
            min_m = min_m.min(closest_m);
        }
    }
    min_m.is_finite().then_some(min_m)
}

/// Smallest distance from the body of a vehicle at a node to the surface of a cylinder, m.
pub fn node_clearance_m(scenario: &Scenario, trajectories: &[&Iterate]) -> Option<f64> {
    let vehicles = scenario.vehicles.iter().zip(trajectories);
    let clearances = vehicles.flat_map(|(vehicle, trajectory)| {
        let body_m = scenario.fixed_wing_model(vehicle).body_radius_m;
        let nodes = trajectory.states.iter();
        nodes.flat_map(move |state| {
            let distances_m = scenario.world.cylinders.iter().map(|it| it.signed_distance_m(state[0], state[1]));
            distances_m.map(move |distance_m| distance_m - body_m)
        })
    });
    clearances.reduce(f64::min)
}

fn distance_m(a: [f64; 2], b: [f64; 2]) -> f64 {
    (a[0] - b[0]).hypot(a[1] - b[1])
}

#[cfg(test)]
mod tests {
    use super::*;

    fn iteration(unsolved: usize) -> Iteration {
        Iteration {
            objective: 200.0,
            dt_s: 5.0,
            defect_m: 0.0,
            slack: 0.0,
            separation_m: None,
            clearance_m: Some(20.0),
            change_m: 0.0,
            trust_region_m: 1.0,
            solver_iterations: 70,
            unsolved,
            wall_s: 0.0,
            distributed_s: 0.0,
        }
    }

    #[test]
    fn a_plan_with_an_unsolved_subproblem_is_not_solved() {
        let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../scenarios/fixed-wing/rendezvous-1.toml");
        let scenario = scenarios::load(&path).expect("a shipped scenario");
        assert_eq!(status(&scenario, &[iteration(0)], true, 60, None), (PlanStatus::Solved, None));
        let (unsolved, reason) = status(&scenario, &[iteration(1)], true, 60, None);
        assert_eq!(unsolved, PlanStatus::NotConverged);
        assert!(reason.is_some_and(|reason| reason.contains("not solved")));
    }

    /// The start is an elastic row: a trajectory may have converged with a start of its own.
    #[test]
    fn a_plan_off_its_start_or_of_different_flight_times_is_not_solved() {
        let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../scenarios/fixed-wing/rendezvous-1.toml");
        let scenario = scenarios::load(&path).expect("a shipped scenario");
        let off = Iteration { slack: 2e-6, ..iteration(0) };
        assert_eq!(status(&scenario, &[off], true, 60, None).0, PlanStatus::NotConverged);
        let (late, reason) = status(&scenario, &[iteration(0)], true, 60, Some(0.3));
        assert_eq!(late, PlanStatus::NotConverged);
        assert!(reason.is_some_and(|reason| reason.contains("differ by 0.300 s")));
    }
}
