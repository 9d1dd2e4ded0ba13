//! Solves all subproblems of one iteration.

use rayon::prelude::*;
use scenarios::Solver;

use crate::convex::{self, BatchSolver, Program, Settings, Solution};

/// The solver of all subproblems of an iteration, in parallel.
pub enum SubproblemSolver {
    /// The customised interior-point method, whose workspace is kept from iteration to iteration.
    Block(BatchSolver),
    /// Clarabel, with this relative gap and feasibility.
    Clarabel(f64),
}

impl SubproblemSolver {
    /// The solver, for the relative gap and feasibility `tolerance`.
    pub fn new(solver: Solver, tolerance: f64) -> Self {
        match solver {
            Solver::Block => Self::Block(BatchSolver::new(Settings { tolerance, ..Settings::default() })),
            Solver::Clarabel => Self::Clarabel(tolerance),
        }
    }

    /// The solutions, in the order of the programs.
    pub fn solve(&self, programs: &[Program]) -> Vec<Solution> {
        match self {
            Self::Block(solvers) => solvers.solve_all(programs),
            Self::Clarabel(tolerance) => {
                programs.par_iter().map(|program| convex::solve_with_clarabel(program, *tolerance)).collect()
            }
        }
    }
}
