//! The references that were followed in an in-loop flight, as a plan.

use scenarios::in_loop::ReplanStatus;
use scenarios::{Plan, PlanStatus, PlanTimings, Scenario, Vehicle};
use sim::{PlanningLog, Replan};

/// The plan of an in-loop flight: for every vehicle the references that it followed, one after the other.
///
/// There is no plan if a vehicle that is not at its goal from the beginning never received a reference that could be flown. It
/// is not converged if a planner failed.
pub fn as_plan(scenario: &Scenario, planner: &str, seed: u64, log: &PlanningLog) -> Plan {
    let is_idle = |index: &usize| !answers(log, *index).any(|replan| replan.outcome.is_flown());
    let idle = (0..scenario.vehicles.len()).filter(|index| has_to_move(scenario, *index)).find(is_idle);
    let wall_s = |vehicle: usize| answers(log, vehicle).map(|replan| replan.wall_s).sum::<f64>();
    let walls_s: Vec<f64> = (0..scenario.vehicles.len()).map(wall_s).collect();
    let failure = log.replans.iter().find_map(failure_reason);
    let status = match (idle, &failure) {
        (Some(_), _) => PlanStatus::NoPlan,
        (None, Some(_)) => PlanStatus::NotConverged,
        (None, None) => PlanStatus::Solved,
    };
    Plan {
        status,
        reason: idle.map(|index| idle_reason(scenario, log, index)).or(failure),
        timings: PlanTimings {
            wall_s: walls_s.iter().sum(),
            distributed_s: walls_s.iter().copied().fold(0.0, f64::max),
        },
        ..Plan::new(&scenario.name, planner, seed, log.followed.iter().cloned().map(Into::into).collect())
    }
}

/// Whether a vehicle has via-points, or does not start within the tolerance of its goal, where it may stay.
fn has_to_move(scenario: &Scenario, vehicle: usize) -> bool {
    let Vehicle { start, goal, via, .. } = &scenario.vehicles[vehicle];
    let [start_m, goal_m] = [start.position_m(), goal.position_m()];
    let distance_m = (0..3).map(|axis| (start_m[axis] - goal_m[axis]).powi(2)).sum::<f64>().sqrt();
    distance_m > scenario.limits().goal_m || !via.is_empty()
}

fn failure_reason(replan: &Replan) -> Option<String> {
    match &replan.outcome {
        ReplanStatus::Failed { reason } => Some(reason.clone()),
        _ => None,
    }
}

fn answers(log: &PlanningLog, vehicle: usize) -> impl Iterator<Item = &Replan> {
    log.replans.iter().filter(move |replan| replan.vehicle == vehicle)
}

fn idle_reason(scenario: &Scenario, log: &PlanningLog, vehicle: usize) -> String {
    let name = &scenario.vehicles[vehicle].name;
    let last = answers(log, vehicle).last();
    let why = last.map_or("it was never asked to plan", |replan| match &replan.outcome {
        ReplanStatus::Rejected { reason } | ReplanStatus::Kept { reason } | ReplanStatus::Failed { reason } => reason,
        ReplanStatus::None | ReplanStatus::InTime | ReplanStatus::Late { .. } => "it gave no reason",
    });
    format!("the planner of {name} never gave a reference that could be flown; the last result: {why}")
}
