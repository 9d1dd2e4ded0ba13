//! `harness bench ipm`: the block factorisation, the paper's three methods for the Newton direction (Wang, Xu, Long 2020,
//! Table 1), and a general interior-point solver, on the same subproblems to the same tolerance.

mod cost;
mod figure;
mod measure;
mod show;

use planners::convex::{Backend, Program, Start};
use scenarios::Scenario;
use serde::Serialize;

use super::subproblems::{self, Subproblem};
pub use cost::Sizes;
pub use figure::svg;
pub use measure::Measured;
use measure::Stopwatch;
pub use show::{markdown, text};

/// Relative gap of all solvers.
pub const TOLERANCE: f64 = 1e-8;

/// Name of the paper's own loop, from an infeasible start, with its method I.
const PAPER_LOOP: &str = "sparse-ldl infeasible";

/// What to measure.
#[derive(Clone, Debug)]
pub struct Plan {
    /// Numbers K of intervals.
    pub intervals: Vec<usize>,
    /// Largest number of repetitions of a solve after a warm-up; the fastest counts.
    pub repetitions: usize,
    /// Backends whose solve is expected to take longer than this are not run, s.
    pub max_solve_s: f64,
}

impl Plan {
    /// The whole table.
    pub fn full() -> Self {
        Self { intervals: vec![4, 8, 20, 40, 80], repetitions: 9, max_solve_s: 4.0 }
    }

    /// The smallest size only, as a smoke test. There every backend takes a fraction of a second; on a busy machine, too, all of
    /// them are run.
    pub fn quick() -> Self {
        Self { intervals: vec![4], repetitions: 2, max_solve_s: 60.0 }
    }
}

/// The results.
#[derive(Clone, Debug, Serialize)]
pub struct Results {
    /// Version of this format.
    pub schema: u32,
    /// Scenario that the subproblems come from.
    pub scenario: String,
    /// Relative gap of all solvers.
    pub tolerance: f64,
    /// Largest number of repetitions of a solve; the fastest counts.
    pub repetitions: usize,
    /// One row per subproblem and backend.
    pub rows: Vec<Row>,
}

/// One backend on one subproblem.
#[derive(Clone, Debug, Serialize)]
pub struct Row {
    /// The subproblem.
    pub shape: String,
    /// The solver: a backend of the interior-point method, `sparse-ldl infeasible` (the paper's loop), `block x4` (four subproblems in one pass, times per subproblem), or `clarabel`.
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
    /// Floating-point operations of one iteration by Table 1 of the paper.
    pub paper_flops: Option<f64>,
    /// The figures; `None` if it was not run.
    #[serde(flatten)]
    pub measured: Option<Measured>,
    /// Ratio of the time of Clarabel to the time of this row.
    pub speedup_vs_clarabel: Option<f64>,
    /// Why it was not run.
    pub not_run: Option<String>,
}

/// Runs the benchmark.
///
/// - `progress`: receives a description of each entry
pub fn run(scenario: &Scenario, plan: &Plan, progress: &mut dyn FnMut(&str)) -> Results {
    let mut rows = Vec::new();
    let mut stopwatch = Stopwatch::new(plan.repetitions, plan.max_solve_s);
    for &intervals in &plan.intervals {
        progress(&format!("planning with {intervals} intervals"));
        for subproblem in subproblems::from_run(scenario, intervals) {
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
    let batch = stopwatch.together(&subproblem.batch);
    let mut rows = vec![
        row(subproblem, "clarabel", None, Ok(clarabel), baseline_us),
        row(subproblem, "block x4", None, Ok(batch), baseline_us),
    ];
    for backend in Backend::ALL {
        let paper_flops = Sizes::of(program).paper_flops(backend);
        let measured = stopwatch.backend(program, backend, Start::Feasible);
        rows.push(row(subproblem, backend.name(), paper_flops, measured, baseline_us));
        if backend == Backend::SparseLdl {
            let measured = stopwatch.backend(program, backend, Start::Infeasible);
            rows.push(row(subproblem, PAPER_LOOP, paper_flops, measured, baseline_us));
        }
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
