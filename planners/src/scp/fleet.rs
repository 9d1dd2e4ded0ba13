//! Planner `fleet-scp`: sequential convex programming whose plans hold between the nodes.
//!
//! As in the papers everybody's subproblem is linearised about his last trajectory, and all are solved in parallel. What
//! is different:
//!
//! - the dynamics are the flow itself (multiple shooting), not the trapezoid rule;
//! - rows are placed where two vehicles, or a vehicle and an obstacle, come nearest to each other, not at the nodes, and
//!   the two share what is missing;
//! - the first guess is a way that could nearly be flown, around obstacles, and around each other where many meet;
//! - the common time bound gives way while the ways are being looked for;
//! - a plan is accepted when its own flow keeps every limit at all times, and not before.

mod acceptance;
mod closest;
mod detour;
mod dubins;
mod first_guess;
mod grid;
mod guess;
mod inside;
mod roundabout;
mod route;
mod rows;
mod schedule;
mod sequence;
mod speed;
mod track;
mod traffic;

use std::time::Instant;

use scenarios::{Plan, PlanStatus, Scenario, Transcription};

use super::options::Options;
use super::plan;
use crate::convex::{Program, Solution};
use crate::planner::{Planner, PlanningMode, Progress};
use sequence::Sequence;

/// The planner, for the registry.
pub const PLANNER: Planner = Planner {
    name: NAME,
    summary: "Sequential convex programming that holds between the nodes: shooting, rows at closest approach",
    handles: "fixed-wing fleets among cylinders",
    unsupported_reason,
    mode: PlanningMode::BeforeFlight(plan),
};

const NAME: &str = "fleet-scp";

/// Plans for the whole fleet. `progress` sees every iteration as it ends.
pub fn plan(scenario: &Scenario, seed: u64, progress: Progress<'_>) -> Plan {
    plan_and_inspect(scenario, seed, progress, &|_, _| {})
}

/// [`plan()`], with `inspect` called for the subproblems of every iteration and their solutions.
pub fn plan_and_inspect(
    scenario: &Scenario,
    seed: u64,
    progress: Progress<'_>,
    inspect: &dyn Fn(&[Program], &[Solution]),
) -> Plan {
    let begin = Instant::now();
    let options = Options::fleet(&scenario.planner);
    let most = options.max_iterations;
    let mut sequence = Sequence::new(scenario, options);
    let mut history = Vec::new();
    let mut accepted = false;
    while !accepted && history.len() < most {
        let iteration = sequence.advance(inspect);
        accepted = sequence.is_accepted();
        progress(&iteration);
        history.push(iteration);
    }
    let (status, trajectories) = if accepted {
        ((PlanStatus::Solved, None), sequence.together())
    } else {
        ((PlanStatus::NoPlan, Some(complaint(&sequence, history.len()))), Vec::new())
    };
    plan::assemble(scenario, NAME, seed, &trajectories, history, status, begin.elapsed())
}

fn complaint(sequence: &Sequence, iterations: usize) -> String {
    let what = sequence.fault().map_or("the flight time has not settled".to_string(), |fault| fault.to_string());
    format!("after {iterations} iterations {what}")
}

fn unsupported_reason(scenario: &Scenario) -> Option<String> {
    if scenario.planner.transcription == Some(Transcription::Trapezoid) && scenario.planner.name == NAME {
        return Some("its dynamics are `shooting`, not `trapezoid`".to_string());
    }
    super::unsupported_reason(scenario)
}
