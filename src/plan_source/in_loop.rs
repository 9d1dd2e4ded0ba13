//! What a flight says of the plans that were made during it.

use scenarios::in_loop::ReplanStatus;
use scenarios::{Plan, PlanStatus, PlanTimings, Scenario};
use sim::{PlanningLog, Replan};

/// What was planned in the loop as one plan: of every vehicle the references that it followed, one after the other.
///
/// There is no plan if some vehicle never got an answer that could be flown.
pub fn as_plan(scenario: &Scenario, planner: &str, seed: u64, log: &PlanningLog) -> Plan {
    let idle = (0..scenario.vehicles.len()).find(|index| !answers(log, *index).any(is_flown));
    let wall_s = |vehicle: usize| answers(log, vehicle).map(|replan| replan.wall_s).sum::<f64>();
    let walls_s: Vec<f64> = (0..scenario.vehicles.len()).map(wall_s).collect();
    Plan {
        status: if idle.is_some() { PlanStatus::NoPlan } else { PlanStatus::Solved },
        reason: idle.map(|index| why_idle(scenario, log, index)),
        timings: PlanTimings {
            wall_s: walls_s.iter().sum(),
            distributed_s: walls_s.iter().copied().fold(0.0, f64::max),
        },
        ..Plan::new(&scenario.name, planner, seed, log.followed.iter().cloned().map(Into::into).collect())
    }
}

/// Is an answer flown, in time or late?
pub fn is_flown(replan: &Replan) -> bool {
    matches!(replan.outcome, ReplanStatus::InTime | ReplanStatus::Late { .. })
}

fn answers(log: &PlanningLog, vehicle: usize) -> impl Iterator<Item = &Replan> {
    log.replans.iter().filter(move |replan| replan.vehicle == vehicle)
}

fn why_idle(scenario: &Scenario, log: &PlanningLog, vehicle: usize) -> String {
    let name = &scenario.vehicles[vehicle].name;
    let last = answers(log, vehicle).last();
    let why = last.map_or("it was never asked", |replan| match &replan.outcome {
        ReplanStatus::Rejected { reason } | ReplanStatus::Kept { reason } => reason,
        ReplanStatus::None | ReplanStatus::InTime | ReplanStatus::Late { .. } => "it gives no reason",
    });
    format!("the planner of {name} never gave an answer that could be flown; of the last one: {why}")
}
