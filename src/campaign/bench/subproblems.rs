//! Subproblems for benchmarks, taken from a run of the planner.

use std::sync::{Mutex, PoisonError};

use planners::convex::Program;
use planners::scp::parallel::plan_and_inspect;
use scenarios::{PlannerSettings, Scenario, Transcription};

/// Distance kept beyond obstacles and separation, m. It adds avoidance constraints.
const MARGIN_M: f64 = 80.0;

/// Fraction by which the common time bound is released, so that the run converges.
const TIME_BOUND_RELEASE: f64 = 0.08;

/// One subproblem of a run.
#[derive(Clone, Debug)]
pub struct Subproblem {
    /// `K=40 early`.
    pub name: String,
    /// The planner's iteration that it comes from, from 1.
    pub iteration: usize,
    /// The subproblem.
    pub program: Program,
    /// The subproblem and others of the same iteration, up to four: what the planner solves in one pass.
    pub batch: Vec<Program>,
}

/// Number of subproblems in one pass.
const BATCH_SIZE: usize = 4;

/// An early, a middle and a late subproblem of a run of `scenario` with `intervals` intervals. The early one (of the first
/// iteration) and the middle one (after a third of the iterations) are those with the most avoidance constraints, the late one
/// (of the last iteration) has the fewest.
pub fn from_run(scenario: &Scenario, intervals: usize) -> Vec<Subproblem> {
    let iterations = iterations(scenario, intervals);
    let (middle, last) = (iterations.len() / 3, iterations.len() - 1);
    let most = |programs: &[Program]| programs.iter().rev().cloned().collect();
    let fewest = |programs: &[Program]| programs.to_vec();
    let pick = |what: &str, iteration: usize, order: &dyn Fn(&[Program]) -> Vec<Program>| {
        let mut batch = order(&iterations[iteration]);
        batch.truncate(BATCH_SIZE);
        let (name, program) = (format!("K={intervals} {what}"), batch[0].clone());
        Subproblem { name, iteration: iteration + 1, program, batch }
    };
    vec![pick("early", 0, &most), pick("middle", middle, &most), pick("late", last, &fewest)]
}

/// The subproblems of every iteration, in the order of their numbers of avoidance constraints.
fn iterations(scenario: &Scenario, intervals: usize) -> Vec<Vec<Program>> {
    let mut scenario = scenario.clone();
    scenario.planner = PlannerSettings {
        intervals: Some(intervals),
        transcription: Some(Transcription::Shooting),
        margin_m: Some(MARGIN_M),
        time_bound_release: Some(TIME_BOUND_RELEASE),
        ..PlannerSettings::default()
    };
    let all = Mutex::new(Vec::new());
    plan_and_inspect(&scenario, scenario.simulation.seed, &mut |_| {}, &|program, solution| {
        all.lock().unwrap_or_else(PoisonError::into_inner).push((solution.objective, program.clone()));
    });
    let all = all.into_inner().unwrap_or_else(PoisonError::into_inner);
    let by_iteration = all.chunks(scenario.vehicles.len()).map(|iteration| {
        let mut iteration = iteration.to_vec();
        iteration.sort_by(|a, b| a.1.halfspaces.len().cmp(&b.1.halfspaces.len()).then(a.0.total_cmp(&b.0)));
        iteration.into_iter().map(|(_, program)| program).collect()
    });
    by_iteration.collect()
}
