//! All subproblems of one iteration.

use rayon::prelude::*;
use scenarios::Solver;

use crate::convex::{self, BatchSolver, Program, Settings, Solution};

/// What solves every subproblem of an iteration, in parallel.
pub enum AllSolver {
    /// By the customised interior-point method, whose work vectors are kept from iteration to iteration.
    Block(BatchSolver),
    /// By Clarabel, to the relative gap and residuals that are given.
    Clarabel(f64),
}

impl AllSolver {
    /// To the relative gap and residuals `tolerance`.
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
