//! From the last iterates to a plan, and what the planner says of it.

use std::time::Duration;

use scenarios::fixed_wing::{Control, State, Trajectory};
use scenarios::{Cylinder, Interpolation, Iteration, Plan, PlanStatus, PlanTimings, Scenario};

use super::interval::Interval;
use super::iterate::Iterate;
use super::{dynamics, shooting};

/// Violation of a linearised row, in scaled units, above which a plan is not called solved: a millimetre of position.
const SLACK_TOLERANCE: f64 = 1e-6;

/// Defect of the planner's own equations above which a plan is not called solved, m.
const DEFECT_TOLERANCE_M: f64 = 0.1;

/// Relative difference of two step lengths below which they are one: vehicles that arrive together then share their
/// nodes, which the solver's tolerance would otherwise set apart by microseconds.
const SAME_STEP: f64 = 1e-7;

/// The plan that the last iterates make.
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
    let objective = trajectories.iter().map(Iterate::flight_time_s).fold(0.0, f64::max);
    let longest_dt_s = trajectories.iter().map(|iterate| iterate.dt_s).fold(0.0, f64::max);
    let is_longest = |iterate: &Iterate| longest_dt_s - iterate.dt_s <= SAME_STEP * longest_dt_s;
    let dt_s = |iterate: &Iterate| if is_longest(iterate) { longest_dt_s } else { iterate.dt_s };
    let distributed_s = history.iter().map(|iteration| iteration.distributed_s).sum();
    Plan {
        status,
        reason,
        objective: Some(objective),
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

/// The iterate in the form of a plan. Controls that stop running within an interval get a node of their own there, so
/// that they run linearly from node to node.
fn trajectory(vehicle: &str, iterate: &Iterate, dt_s: f64) -> Trajectory {
    let mut trajectory = Trajectory {
        vehicle: vehicle.to_string(),
        interpolation: Interpolation::FirstOrderHold,
        times_s: Vec::new(),
        states: Vec::new(),
        controls: Vec::new(),
    };
    let mut push = |t_s: f64, state: dynamics::State, control: dynamics::Control| {
        trajectory.times_s.push(t_s);
        trajectory.states.push(State::from_array(state.into()));
        trajectory.controls.push(Control::from_array(control.into()));
    };
    for k in 0..=iterate.intervals() {
        push(k as f64 * dt_s, iterate.states[k], iterate.controls[k]);
        if k < iterate.intervals() && iterate.ramp < 1.0 {
            let interval = Interval { dt_s, ..iterate.interval(k) };
            push((k as f64 + iterate.ramp) * dt_s, shooting::ramp_end(&interval), interval.controls[1]);
        }
    }
    trajectory
}

/// What the planner can say honestly: solved only if it has come to rest, the rows and its own equations hold, and its
/// own constraints hold at the nodes.
pub fn status(
    scenario: &Scenario,
    history: &[Iteration],
    converged: bool,
    limit: usize,
) -> (PlanStatus, Option<String>) {
    let Some(last) = history.last() else {
        return (PlanStatus::NotConverged, Some("no iteration was allowed".to_string()));
    };
    let separation_m = scenario.fleet.separation_m.unwrap_or(0.0);
    let too_close = last.separation_m.is_some_and(|distance| distance < separation_m);
    let complaint = if last.unsolved > 0 {
        // a trajectory whose subproblem was not solved may stand still without having converged
        Some(format!("{} subproblems of the last iteration were not solved", last.unsolved))
    } else if !converged {
        Some(format!("the trajectories still moved by {:.3} m after {limit} iterations", last.change_m))
    } else if last.slack > SLACK_TOLERANCE {
        Some(format!("constraints are violated by up to {:.2e} scaled units", last.slack))
    } else if last.defect_m > DEFECT_TOLERANCE_M {
        Some(format!("the equations of motion are violated by up to {:.3} m per interval", last.defect_m))
    } else if too_close || last.clearance_m.is_some_and(|clearance| clearance < 0.0) {
        Some("separation or clearance is violated at the nodes".to_string())
    } else {
        None
    };
    (if complaint.is_none() { PlanStatus::Solved } else { PlanStatus::NotConverged }, complaint)
}

/// Smallest horizontal distance between two vehicles at the nodes, m: node by node a sweep from west to east, so that
/// nobody farther east than the best so far is looked at.
pub fn node_separation_m(trajectories: &[&Iterate]) -> Option<f64> {
    let nodes = trajectories.iter().map(|trajectory| trajectory.states.len()).max()?;
    let mut nearest_m = f64::INFINITY;
    for node in 0..nodes {
        let present = trajectories.iter().filter(|trajectory| node < trajectory.states.len());
        let mut eastward: Vec<[f64; 2]> = present.map(|trajectory| trajectory.position_m(node)).collect();
        eastward.sort_by(|a, b| a[0].total_cmp(&b[0]));
        for (place, a) in eastward.iter().enumerate() {
            let near = eastward[place + 1..].iter().take_while(|b| b[0] - a[0] < nearest_m);
            let closest_m = near.map(|b| distance_m(*a, *b)).fold(f64::INFINITY, f64::min);
            nearest_m = nearest_m.min(closest_m);
        }
    }
    nearest_m.is_finite().then_some(nearest_m)
}

/// Smallest distance from a node to the surface of a cylinder, m.
pub fn node_clearance_m(trajectories: &[&Iterate], cylinders: &[Cylinder]) -> Option<f64> {
    let nodes = trajectories.iter().flat_map(|trajectory| trajectory.states.iter());
    nodes
        .flat_map(|state| cylinders.iter().map(|cylinder| cylinder.signed_distance_m(state[0], state[1])))
        .reduce(f64::min)
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
    fn a_plan_that_rests_on_an_unsolved_subproblem_is_not_called_solved() {
        let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../scenarios/fixed-wing/rendezvous-1.toml");
        let scenario = scenarios::load(&path).expect("a shipped scenario");
        assert_eq!(status(&scenario, &[iteration(0)], true, 60), (PlanStatus::Solved, None));
        let (unsolved, reason) = status(&scenario, &[iteration(1)], true, 60);
        assert_eq!(unsolved, PlanStatus::NotConverged);
        assert!(reason.is_some_and(|reason| reason.contains("not solved")));
    }
}
