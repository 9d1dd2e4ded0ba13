//! `harness bench ipm`: our block sweep beside the paper's three ways to the Newton direction (Wang, Xu, Long 2020,
//! Table 1) and a general interior-point solver, on the same subproblems to the same tolerance.

mod cost;
mod measure;
mod show;

use planners::convex::{Backend, Program};
use scenarios::Scenario;
use serde::Serialize;

use super::subproblems::{self, Subproblem};
pub use cost::Sizes;
pub use measure::Measured;
use measure::Stopwatch;
pub use show::{markdown, text};

/// Relative gap to which everybody solves.
pub const TOLERANCE: f64 = 1e-8;

/// What is measured.
#[derive(Clone, Debug)]
pub struct Plan {
    /// Numbers K of intervals.
    pub intervals: Vec<usize>,
    /// Most repetitions of a solve, after one to warm up; the best counts.
    pub repetitions: usize,
    /// A backend whose solve is expected to take longer than this is not run, s.
    pub patience_s: f64,
}

impl Plan {
    /// The whole table.
    pub fn full() -> Self {
        Self { intervals: vec![4, 8, 20, 40, 80], repetitions: 9, patience_s: 4.0 }
    }

    /// The smallest size only, to see that everything runs.
    pub fn quick() -> Self {
        Self { intervals: vec![4], repetitions: 2, patience_s: 1.0 }
    }
}

/// Everything that was measured.
#[derive(Clone, Debug, Serialize)]
pub struct Results {
    /// Version of this form.
    pub schema: u32,
    /// Scenario that the subproblems come from.
    pub scenario: String,
    /// Relative gap to which everybody solves, -.
    pub tolerance: f64,
    /// Most repetitions of a solve; the best counts.
    pub repetitions: usize,
    /// One row per subproblem and backend.
    pub rows: Vec<Row>,
}

/// One backend on one subproblem.
#[derive(Clone, Debug, Serialize)]
pub struct Row {
    /// The subproblem.
    pub shape: String,
    /// Who solved it: a backend of ours, `block x4` (four subproblems in one pass, times per subproblem), or `clarabel`.
    #[serde(rename = "backend")]
    pub solver: &'static str,
    /// Number K of intervals.
    pub intervals: usize,
    /// The planner's iteration that the subproblem comes from, from 1.
    pub scp_iteration: usize,
    /// Number of avoidance rows.
    pub planes: usize,
    /// Sizes of the paper's form.
    #[serde(flatten)]
    pub sizes: Sizes,
    /// What the paper's Table 1 counts for one iteration by this method, floating-point operations; only the leading
    /// term for method II.
    pub paper_flops: Option<f64>,
    /// What was measured; nothing where `not_run` says why.
    #[serde(flatten)]
    pub measured: Option<Measured>,
    /// Time of Clarabel over the time of this row, -.
    pub speedup_vs_clarabel: Option<f64>,
    /// Why this was not run.
    pub not_run: Option<String>,
}

/// Measures everything in `plan`; `progress` is told what comes next.
pub fn run(scenario: &Scenario, plan: &Plan, progress: &mut dyn FnMut(&str)) -> Results {
    let mut rows = Vec::new();
    let mut stopwatch = Stopwatch::new(plan.repetitions, plan.patience_s);
    for &intervals in &plan.intervals {
        progress(&format!("planning with {intervals} intervals"));
        for subproblem in subproblems::of_a_run(scenario, intervals) {
            progress(&format!("measuring {}", subproblem.name));
            rows.extend(rows_of(&subproblem, &mut stopwatch));
        }
    }
    let (scenario, repetitions) = (scenario.name.clone(), plan.repetitions);
    Results { schema: 1, scenario, tolerance: TOLERANCE, repetitions, rows }
}

fn rows_of(subproblem: &Subproblem, stopwatch: &mut Stopwatch) -> Vec<Row> {
    let program = &subproblem.program;
    let clarabel = stopwatch.clarabel(program);
    let baseline_us = clarabel.time_us;
    let together = stopwatch.together(&subproblem.together);
    let mut rows = vec![
        row(subproblem, "clarabel", None, Ok(clarabel), baseline_us),
        row(subproblem, "block x4", None, Ok(together), baseline_us),
    ];
    for backend in Backend::ALL {
        let paper_flops = Sizes::of(program).paper_flops(backend);
        rows.push(row(subproblem, backend.name(), paper_flops, stopwatch.backend(program, backend), baseline_us));
    }
    rows
}

fn row(
    subproblem: &Subproblem,
    solver: &'static str,
    paper_flops: Option<f64>,
    measured: Result<Measured, String>,
    baseline_us: f64,
) -> Row {
    let program: &Program = &subproblem.program;
    let speedup = measured.as_ref().ok().map(|measured| baseline_us / measured.time_us);
    Row {
        shape: subproblem.name.clone(),
        solver,
        intervals: program.intervals(),
        scp_iteration: subproblem.iteration,
        planes: program.halfspaces.len(),
        sizes: Sizes::of(program),
        paper_flops,
        not_run: measured.as_ref().err().cloned(),
        measured: measured.ok(),
        speedup_vs_clarabel: speedup,
    }
}
