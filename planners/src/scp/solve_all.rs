//! All subproblems of one iteration.

use rayon::prelude::*;
use scenarios::Solver;

use crate::convex::{self, Program, Settings, Solution};

/// Solves every programme to the relative gap and residuals `tolerance`, in parallel.
pub fn solve_all_by(solver: Solver, programs: &[Program], tolerance: f64) -> Vec<Solution> {
    match solver {
        Solver::Block => convex::solve_all(programs, &Settings { tolerance, ..Settings::default() }),
        Solver::Clarabel => {
            programs.par_iter().map(|program| convex::solve_with_clarabel(program, tolerance)).collect()
        }
    }
}
