//! Solves all subproblems of one iteration.

use std::time::Instant;

use rayon::prelude::*;
use scenarios::Solver;

use crate::convex::{self, Backend, BatchSolver, Program, Settings, Solution, Start};

/// The solver of all subproblems of an iteration, in parallel.
pub enum SubproblemSolver {
    /// The customised interior-point method, whose workspace is kept from iteration to iteration.
    InteriorPoint(BatchSolver),
    /// Clarabel, with this relative gap and feasibility.
    Clarabel(f64),
}

impl SubproblemSolver {
    /// The solver, for the relative gap and feasibility `tolerance`.
    pub fn new(solver: Solver, start: Start, tolerance: f64) -> Self {
        let interior_point = |backend| {
            Self::InteriorPoint(BatchSolver::with_backend(
                Settings { tolerance, start, ..Settings::default() },
                backend,
            ))
        };
        match solver {
            Solver::Block => interior_point(Backend::Block),
            Solver::SparseLdl => interior_point(Backend::SparseLdl),
            Solver::DenseReduced => interior_point(Backend::DenseReduced),
            Solver::Clarabel => Self::Clarabel(tolerance),
        }
    }

    /// The solutions, in the order of the programs, each with the wall time of its pass, s. A pass takes as long for
    /// one program as for the four that it can hold, so this is the time of each program on a computer of its own.
    pub fn solve_timed(&self, programs: &[Program]) -> Vec<(Solution, f64)> {
        let pass = |programs: &[Program]| {
            let started = Instant::now();
            let solutions = self.solve(programs);
            let wall_s = started.elapsed().as_secs_f64();
            solutions.into_iter().map(|solution| (solution, wall_s)).collect::<Vec<_>>()
        };
        programs.par_chunks(self.programs_per_pass()).flat_map(pass).collect()
    }

    /// Number of programs that are solved in one pass.
    fn programs_per_pass(&self) -> usize {
        match self {
            Self::InteriorPoint(solvers) => solvers.programs_per_pass(),
            Self::Clarabel(_) => 1,
        }
    }

    /// The solutions, in the order of the programs.
    pub fn solve(&self, programs: &[Program]) -> Vec<Solution> {
        match self {
            Self::InteriorPoint(solvers) => solvers.solve_all(programs),
            Self::Clarabel(tolerance) => {
                programs.par_iter().map(|program| convex::solve_with_clarabel(program, *tolerance)).collect()
            }
        }
    }
}
