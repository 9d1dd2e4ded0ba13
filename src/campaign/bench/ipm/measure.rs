//! Time per solve: the best of several, after one to warm up.

use std::time::Instant;

use planners::convex::{self, Backend, BatchSolver, InteriorPoint, Program, Settings, Solution, Status};
use serde::Serialize;

use super::TOLERANCE;
use super::cost::Sizes;

/// A solve is not repeated any more once its repetitions have taken this long together, s.
const ENOUGH_S: f64 = 2.0;

/// Iterations that a solve is expected to take.
const USUAL_ITERATIONS: f64 = 12.0;

/// Time per n^3 of a dense factorisation until one has been measured, s.
const FIRST_GUESS_S: f64 = 1e-10;

/// One backend on one subproblem.
#[derive(Clone, Debug, Serialize)]
pub struct Measured {
    /// `solved`, `stalled` or `iteration-limit`.
    pub status: &'static str,
    /// Iterations to the end.
    pub iterations: usize,
    /// Time of the first solve, which makes work memory and symbolic analysis, µs.
    pub first_us: f64,
    /// Best time of a solve, µs.
    pub time_us: f64,
    /// The same by iteration, µs.
    pub time_per_iteration_us: f64,
    /// Objective at the end.
    pub objective: f64,
    /// Relative gap at the end, of Clarabel the larger of gap and residuals, -.
    pub gap: f64,
}

/// Measures, and knows from what it has measured what will take too long.
#[derive(Debug)]
pub struct Stopwatch {
    repetitions: usize,
    patience_s: f64,
    /// Time per iteration and n^3 of every backend, where it is dense.
    cubic_s: [f64; Backend::ALL.len()],
}

impl Stopwatch {
    /// Nothing measured yet; `repetitions` >= 1, `patience_s` for one solve.
    pub fn new(repetitions: usize, patience_s: f64) -> Self {
        Self { repetitions, patience_s, cubic_s: [FIRST_GUESS_S; Backend::ALL.len()] }
    }

    /// Clarabel on `program`.
    pub fn clarabel(&self, program: &Program) -> Measured {
        self.best(1, || convex::solve_with_clarabel(program, TOLERANCE))
    }

    /// Ours on several programmes in one pass, on one thread: time per programme, of the rest the first one's.
    pub fn together(&self, programs: &[Program]) -> Measured {
        let solvers = BatchSolver::new(Settings { tolerance: TOLERANCE, ..Settings::default() });
        self.best(programs.len(), || solvers.solve_all(programs).swap_remove(0))
    }

    /// A backend of ours on `program`; refused if a solve would take longer than there is patience for.
    pub fn backend(&mut self, program: &Program, backend: Backend) -> Result<Measured, String> {
        let cube = Sizes::of(program).dense_order(backend).map(|n| (n as f64).powi(3));
        let expected_s = cube.map_or(0.0, |cube| cube * self.cubic_s[backend as usize] * USUAL_ITERATIONS);
        if expected_s > self.patience_s {
            return Err(format!("not run: about {expected_s:.0} s"));
        }
        let settings = Settings { tolerance: TOLERANCE, ..Settings::default() };
        let mut solver = InteriorPoint::with_backend(settings, backend);
        let measured = self.best(1, || solver.solve(program));
        if let Some(cube) = cube {
            self.cubic_s[backend as usize] = 1e-6 * measured.time_per_iteration_us / cube;
        }
        Ok(measured)
    }

    fn best(&self, programs: usize, mut solve: impl FnMut() -> Solution) -> Measured {
        let began = Instant::now();
        let mut solution = solve(); // to warm up
        let first_s = began.elapsed().as_secs_f64();
        let (begin, mut best_s) = (Instant::now(), f64::INFINITY);
        for _ in 0..self.repetitions {
            let started = Instant::now();
            solution = solve();
            best_s = best_s.min(started.elapsed().as_secs_f64());
            if begin.elapsed().as_secs_f64() > ENOUGH_S {
                break;
            }
        }
        let time_us = 1e6 * best_s / programs as f64;
        Measured {
            status: status(solution.status),
            iterations: solution.iterations,
            first_us: 1e6 * first_s / programs as f64,
            time_us,
            time_per_iteration_us: time_us / solution.iterations.max(1) as f64,
            objective: solution.objective,
            gap: solution.gap,
        }
    }
}

fn status(status: Status) -> &'static str {
    match status {
        Status::Solved => "solved",
        Status::IterationLimit => "iteration-limit",
        Status::Stalled => "stalled",
        Status::Refused => "refused",
    }
}
