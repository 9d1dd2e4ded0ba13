//! Settings, status and result of a solve.

use super::program::Program;

/// Settings of the interior-point method.
#[derive(Clone, Debug)]
pub struct Settings {
    /// Relative duality gap at which a program counts as solved, -.
    pub tolerance: f64,
    /// Maximum number of iterations.
    pub max_iterations: usize,
    /// Fraction of the distance to the boundary that a step may use, in (0, 1).
    pub boundary_fraction: f64,
    /// Central-path parameter τ of the start, relative to the penalty times the largest initial residual of an
    /// equality, -.
    pub initial_barrier: f64,
    /// Where the iteration starts.
    pub start: Start,
}

/// Where the iteration starts.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Start {
    /// At a strictly feasible point: every iterate satisfies the linear equations.
    #[default]
    Feasible,
    /// At Mehrotra's start in the paper's form P4: the residuals vanish with the gap. For the paper's methods only.
    Infeasible,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            tolerance: 1e-8,
            max_iterations: 60,
            boundary_fraction: 0.995,
            initial_barrier: 1.0,
            start: Start::Feasible,
        }
    }
}

/// Outcome of a solve.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Status {
    /// The gap is below the tolerance.
    Solved,
    /// The iteration limit was reached; the best iterate is returned.
    IterationLimit,
    /// Progress ended short of the tolerance; the best iterate is returned.
    Stalled,
    /// The program is not [well posed](super::Program::is_well_posed); nothing was solved.
    Refused,
}

/// Result of a solve.
#[derive(Clone, Debug)]
pub struct Solution {
    /// Outcome.
    pub status: Status,
    /// Variables z, within their hard bounds.
    pub z: Vec<f64>,
    /// `q θ + μ (violations)` at z, plus the program's offset.
    pub objective: f64,
    /// Upper bound of the distance to the optimal objective, relative to the objective or to 1 where that is larger, -.
    /// Certified by multipliers; for Clarabel the larger of its own gap and residuals.
    pub gap: f64,
    /// Number of iterations.
    pub iterations: usize,
}

impl Solution {
    /// The result for a program that is not well posed.
    pub(super) fn refused(program: &Program) -> Self {
        Self { status: Status::Refused, z: vec![0.0; program.len()], objective: f64::NAN, gap: f64::NAN, iterations: 0 }
    }
}
