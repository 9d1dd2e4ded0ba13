use scenarios::in_loop::ReplanStatus;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use sim::{EventKind, Flight, PlanningLog, Replan};

use super::finite;
use crate::statistics::mean;

/// Figures of planning in the loop: the same on every machine, unless the scenario takes planning times from the clock.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct InLoopMetrics {
    /// Times that a planner was asked.
    pub replans: usize,
    /// Answers that came too late, and were joined in their middle.
    pub late: usize,
    /// By how much at most, s.
    pub latest_s: f64,
    /// Answers that kept the reference in force.
    pub kept: usize,
    /// Answers that could not be flown.
    pub rejected: usize,
    /// Requests without an answer that can be used.
    #[serde(default)]
    pub failed: usize,
    /// What is to be said of the planners beyond their answers.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub remarks: Vec<String>,
    /// Iterations per answer, mean.
    pub iterations: Option<f64>,
    /// First iteration with a feasible candidate, mean over the answers that tell.
    pub first_feasible: Option<f64>,
    /// Obstacles that were found during the flight, counted for every vehicle.
    pub discovered: usize,
    /// Length of the flown paths, sum over the vehicles, m.
    pub path_m: Option<f64>,
}

/// Measures a flight that was planned in the loop.
pub fn measure(flight: &Flight, log: &PlanningLog) -> InLoopMetrics {
    let count = |is_such: fn(&Replan) -> bool| log.replans.iter().filter(|replan| is_such(replan)).count();
    let late_s = log.replans.iter().map(|replan| match replan.outcome {
        ReplanStatus::Late { by_s } => by_s,
        _ => 0.0,
    });
    let is_discovery = |kind: &EventKind| matches!(kind, EventKind::Discovered { .. });
    InLoopMetrics {
        replans: log.replans.len(),
        late: count(|replan| matches!(replan.outcome, ReplanStatus::Late { .. })),
        latest_s: late_s.fold(0.0, f64::max),
        kept: count(|replan| matches!(replan.outcome, ReplanStatus::Kept { .. })),
        rejected: count(|replan| matches!(replan.outcome, ReplanStatus::Rejected { .. })),
        failed: count(|replan| matches!(replan.outcome, ReplanStatus::Failed { .. })),
        remarks: log.remarks.notes.iter().chain(&log.remarks.failure).cloned().collect(),
        iterations: mean(log.replans.iter().map(|replan| replan.diagnostics.iterations as f64)),
        first_feasible: mean(
            log.replans.iter().filter_map(|replan| replan.diagnostics.first_feasible).map(|iteration| iteration as f64),
        ),
        discovered: flight.events.iter().filter(|event| is_discovery(&event.kind)).count(),
        path_m: finite(path_m(flight)),
    }
}

fn path_m(flight: &Flight) -> f64 {
    let step_m = |pair: &[sim::Sample]| {
        (0..3).map(|axis| (pair[1].position_m[axis] - pair[0].position_m[axis]).powi(2)).sum::<f64>().sqrt()
    };
    let of_vehicle = |log: &sim::VehicleLog| log.samples.windows(2).map(step_m).sum::<f64>();
    flight.vehicles.iter().map(of_vehicle).sum()
}
