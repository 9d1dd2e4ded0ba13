//! Time per solve: the fastest of several after a warm-up.

use std::time::Instant;

use planners::convex::{self, Backend, BatchSolver, InteriorPoint, Program, Settings, Solution, Start, Status};
use serde::Serialize;

use super::TOLERANCE;
use super::cost::Sizes;

/// Total time of the repetitions after which a solve is not repeated, s.
const MAX_TOTAL_S: f64 = 2.0;

/// Expected number of iterations of a solve.
const TYPICAL_ITERATIONS: f64 = 12.0;

/// Time per n^3 of a dense factorisation before the first measurement, s.
const INITIAL_CUBIC_S: f64 = 1e-10;

/// One backend on one subproblem.
#[derive(Clone, Debug, Serialize)]
pub struct Measured {
    /// `solved`, `stalled` or `iteration-limit`.
    pub status: &'static str,
    /// Number of iterations.
    pub iterations: usize,
    /// Time of the first solve, with allocation and symbolic analysis, µs.
    pub first_us: f64,
    /// Shortest time of a solve, µs.
    pub time_us: f64,
    /// The same per iteration, µs.
    pub time_per_iteration_us: f64,
    /// Final objective.
    pub objective: f64,
    /// Final relative gap; for Clarabel the larger of gap and residuals.
    pub gap: f64,
}

/// Measures solve times, and estimates from earlier measurements which solves would take too long.
#[derive(Debug)]
pub struct Stopwatch {
    repetitions: usize,
    max_solve_s: f64,
    /// Time per iteration and n^3 of every dense backend.
    cubic_s: [f64; Backend::ALL.len()],
}

impl Stopwatch {
    /// Without measurements; `repetitions` >= 1, `max_solve_s` per solve.
    pub fn new(repetitions: usize, max_solve_s: f64) -> Self {
        Self { repetitions, max_solve_s, cubic_s: [INITIAL_CUBIC_S; Backend::ALL.len()] }
    }

    /// Clarabel on `program`.
    pub fn clarabel(&self, program: &Program) -> Measured {
        self.fastest(1, || convex::solve_with_clarabel(program, TOLERANCE))
    }

    /// The block method on several programs in one pass, on one thread: times per program, other figures of the first.
    pub fn together(&self, programs: &[Program]) -> Measured {
        let solvers = BatchSolver::new(Settings { tolerance: TOLERANCE, ..Settings::default() });
        self.fastest(programs.len(), || solvers.solve_all(programs).swap_remove(0))
    }

    /// A backend on `program`, from `start`.
    ///
    /// # Errors
    ///
    /// If a solve is expected to take longer than `max_solve_s`.
    pub fn backend(&mut self, program: &Program, backend: Backend, start: Start) -> Result<Measured, String> {
        let cube = Sizes::of(program).dense_order(backend).map(|n| (n as f64).powi(3));
        let expected_s = cube.map_or(0.0, |cube| cube * self.cubic_s[backend as usize] * TYPICAL_ITERATIONS);
        if expected_s > self.max_solve_s {
            return Err(format!("not run: about {expected_s:.0} s"));
        }
        let settings = Settings { tolerance: TOLERANCE, start, ..Settings::default() };
        let mut solver = InteriorPoint::with_backend(settings, backend);
        let measured = self.fastest(1, || solver.solve(program));
        if let Some(cube) = cube {
            self.cubic_s[backend as usize] = 1e-6 * measured.time_per_iteration_us / cube;
        }
        Ok(measured)
    }

    fn fastest(&self, programs: usize, mut solve: impl FnMut() -> Solution) -> Measured {
        let began = Instant::now();
        let mut solution = solve(); // warm-up
        let first_s = began.elapsed().as_secs_f64();
        let (begin, mut shortest_s) = (Instant::now(), f64::INFINITY);
        for _ in 0..self.repetitions {
            let started = Instant::now();
            solution = solve();
            shortest_s = shortest_s.min(started.elapsed().as_secs_f64());
            if begin.elapsed().as_secs_f64() > MAX_TOTAL_S {
                break;
            }
        }
        let time_us = 1e6 * shortest_s / programs as f64;
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
