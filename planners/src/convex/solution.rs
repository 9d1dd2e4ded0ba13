//! What goes into a solve, and what comes out of it.

use super::program::Program;

/// When to stop, and how boldly to step.
#[derive(Clone, Debug)]
pub struct Settings {
    /// Relative duality gap at the end, -.
    pub tolerance: f64,
    /// Most iterations.
    pub max_iterations: usize,
    /// Share of the distance to the boundary that a step may use, in (0, 1).
    pub boundary_share: f64,
    /// Parameter τ of the central path at the start, relative to penalty times the largest initial violation.
    pub start: f64,
}

impl Default for Settings {
    fn default() -> Self {
        Self { tolerance: 1e-8, max_iterations: 60, boundary_share: 0.995, start: 1.0 }
    }
}

/// How a solve ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Status {
    /// The gap is below the tolerance.
    Solved,
    /// The iteration limit came first; the best iterate is returned.
    IterationLimit,
    /// Rounding stopped the progress short of the tolerance; the best iterate is returned.
    Stalled,
    /// The programme holds a number that is not finite, or an empty box: nothing was solved.
    Refused,
}

/// Result of a solve.
#[derive(Clone, Debug)]
pub struct Solution {
    /// How it ended.
    pub status: Status,
    /// Variables z, inside their box.
    pub z: Vec<f64>,
    /// `q θ + μ (violations)` at z, plus the programme's offset.
    pub objective: f64,
    /// How much of the objective could be gained at most, relative to it or to 1 where that is larger, -. Proven by
    /// multipliers; of a general solver the larger of its own gap and residuals.
    pub gap: f64,
    /// Iterations taken.
    pub iterations: usize,
}

impl Solution {
    /// Nothing was solved.
    pub(super) fn refused(program: &Program) -> Self {
        Self { status: Status::Refused, z: vec![0.0; program.len()], objective: f64::NAN, gap: f64::NAN, iterations: 0 }
    }
}
