//! Planner `fleet-scp`: sequential convex programming whose plans hold between the nodes.
//!
//! As in the papers, the subproblem of each vehicle is linearised about its last trajectory, and all are solved in
//! parallel. The differences:
//!
//! - the dynamics are multiple-shooting constraints, not the trapezoid rule;
//! - avoidance rows are placed at the closest approach of two vehicles, or of a vehicle and an obstacle, not at the
//!   nodes, and two vehicles share the missing distance;
//! - the initial guess is nearly flyable: Dubins paths around obstacles, with a roundabout where many vehicles meet;
//! - the common time bound is released in the search phase;
//! - unless the scenario gives their number, the intervals are as long as the vehicle's agility allows;
//! - a plan is accepted only when the motion that its controls lead to, integrated in small steps, keeps every limit at
//!   all times.

mod acceptance;
mod agility;
mod avoidance_rows;
mod climb;
mod closest_approach;
mod conflict_detection;
mod detour;
mod dubins;
mod grid;
mod initial_guess;
mod initial_route;
mod intersample_bounds;
mod lengthening;
mod motion;
mod refined_motion;
mod roundabout;
mod route;
mod schedule;
mod scp_solver;
mod speed;

use std::time::Instant;

use scenarios::{Plan, PlanStatus, Scenario, Transcription};

use super::options::Options;
use super::plan;
use crate::convex::{Program, Solution};
use crate::planner::{Planner, PlanningMode, Progress};
use scp_solver::{Coarse, ScpSolver};

/// The planner, for the registry.
pub const PLANNER: Planner = Planner {
    name: NAME,
    summary: "Sequential convex programming that holds between the nodes: shooting, rows at closest approach",
    handles: "fixed-wing fleets among cylinders",
    unsupported_reason,
    mode: PlanningMode::BeforeFlight(plan),
};

const NAME: &str = "fleet-scp";

/// Plans for the whole fleet. `progress` receives every iteration.
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
    let max_iterations = options.max_iterations;
    let mut solver = ScpSolver::new(scenario, options.clone(), 0);
    let mut history = Vec::new();
    let (mut accepted, mut attempt) = (false, 0);
    while !accepted && history.len() < max_iterations {
        if solver.has_stalled() {
            attempt += 1;
            solver = ScpSolver::new(scenario, options.clone(), attempt);
        }
        let iteration = solver.advance(inspect);
        accepted = solver.is_accepted();
        progress(&iteration);
        history.push(iteration);
    }
    let (status, trajectories) = if accepted {
        ((PlanStatus::Solved, None), solver.synchronised())
    } else {
        ((PlanStatus::NoPlan, Some(failure_reason(&solver, history.len()))), Vec::new())
    };
    plan::assemble(scenario, NAME, seed, &trajectories, history, status, begin.elapsed())
}

fn failure_reason(solver: &ScpSolver, iterations: usize) -> String {
    let reason = solver
        .first_violation()
        .map_or("the flight time has not settled".to_string(), |violation| violation.to_string());
    let cure = solver.coarsest().map_or(String::new(), |coarse| {
        let Coarse { vehicle, interval_s, intervals } = coarse;
        format!("; intervals of {interval_s:.1} s are long for {vehicle}: set `planner.intervals` to {intervals}, or omit it")
    });
    format!("after {iterations} iterations {reason}{cure}")
}

fn unsupported_reason(scenario: &Scenario) -> Option<String> {
    if scenario.planner.transcription == Some(Transcription::Trapezoid) && scenario.planner.name == NAME {
        return Some("its dynamics are `shooting`, not `trapezoid`".to_string());
    }
    super::unsupported_reason(scenario)
}
