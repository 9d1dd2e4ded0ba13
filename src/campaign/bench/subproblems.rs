//! Subproblems to measure with, taken from a real run of the planner.

use std::sync::{Mutex, PoisonError};

use planners::convex::Program;
use planners::scp::parallel::plan_and_inspect;
use scenarios::{PlannerSettings, Scenario, Transcription};

/// Distance kept beyond obstacles and separation, m: it brings more rows.
const MARGIN_M: f64 = 80.0;

/// Share by which the common time bound is released, so that the run comes to a good end.
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
    /// It and others of the same iteration, four in all or as many as there are: what the planner solves in one pass.
    pub together: Vec<Program>,
}

/// Number of subproblems in one pass.
const TOGETHER: usize = 4;

/// An early, a middle and a late subproblem of a run of `scenario` with `intervals` intervals: of the first iteration
/// and of one a third of the way the vehicle with the most avoidance rows, of the last (rows out of reach are dropped, and by then
/// most are) the one with the fewest.
pub fn of_a_run(scenario: &Scenario, intervals: usize) -> Vec<Subproblem> {
    let iterations = iterations(scenario, intervals);
    let (middle, last) = (iterations.len() / 3, iterations.len() - 1);
    let most = |programs: &[Program]| programs.iter().rev().cloned().collect();
    let fewest = |programs: &[Program]| programs.to_vec();
    let pick = |what: &str, iteration: usize, order: &dyn Fn(&[Program]) -> Vec<Program>| {
        let mut together = order(&iterations[iteration]);
        together.truncate(TOGETHER);
        let (name, program) = (format!("K={intervals} {what}"), together[0].clone());
        Subproblem { name, iteration: iteration + 1, program, together }
    };
    vec![pick("early", 0, &most), pick("middle", middle, &most), pick("late", last, &fewest)]
}

/// The subproblems of every iteration, the one with the fewest avoidance rows first, whatever thread was faster.
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
