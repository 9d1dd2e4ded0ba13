/// Settings of the method.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// Convergence tolerance of the scaled optimality error, dimensionless.
    pub tolerance: f64,
    /// Initial barrier parameter μ.
    pub initial_barrier: f64,
    /// Minimum distance of a cold start from its bounds, relative to max(1, |bound|) and to the width of the box;
    /// minimum slack of the inequalities.
    pub bound_push: f64,
    /// Iteration limit.
    pub max_iterations: usize,
}

impl Default for Settings {
    fn default() -> Self {
        Self { tolerance: 1e-7, initial_barrier: 0.1, bound_push: 1e-2, max_iterations: 200 }
    }
}

/// Why the method terminated.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Status {
    /// The optimality conditions hold to the tolerance: a local minimum.
    Solved,
    /// The iteration limit was reached first.
    IterationLimit,
    /// The line search found no acceptable step, which most often means local infeasibility.
    Stalled,
    /// A value or a derivative is not finite.
    NotFinite,
}

/// One iteration.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct IterationRecord {
    /// f(x).
    pub objective: f64,
    /// Largest constraint violation, max norm.
    pub violation: f64,
    /// Scaled optimality error at μ = 0.
    pub error: f64,
    /// Barrier parameter μ.
    pub barrier: f64,
    /// Regularisation δ of the Hessian's diagonal.
    pub regularisation: f64,
    /// Primal length of the step to this iterate, in [0, 1].
    pub step: f64,
}

/// Result of a run. The point itself remains in the method, see [`InteriorPoint::x`](super::InteriorPoint::x).
#[derive(Clone, Debug, PartialEq)]
pub struct Solution {
    /// Why the method terminated.
    pub status: Status,
    /// f(x).
    pub objective: f64,
    /// Largest constraint violation, max norm.
    pub violation: f64,
    /// Scaled optimality error.
    pub error: f64,
    /// Number of Newton steps.
    pub iterations: usize,
    /// One record per iterate, the initial one included.
    pub history: Vec<IterationRecord>,
}
