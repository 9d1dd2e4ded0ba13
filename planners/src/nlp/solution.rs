/// When to stop, and how to go.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// Largest scaled error of the optimality conditions at the end, -.
    pub tolerance: f64,
    /// Barrier parameter of the start.
    pub start: f64,
    /// Least distance of a cold start to the bounds and rows, relative to the bound or the width of its box.
    pub push: f64,
    /// Most iterations.
    pub max_iterations: usize,
}

impl Default for Settings {
    fn default() -> Self {
        Self { tolerance: 1e-7, start: 0.1, push: 1e-2, max_iterations: 200 }
    }
}

/// How it ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Status {
    /// The optimality conditions hold to the tolerance: a local minimum.
    Solved,
    /// They did not within the allowed number of iterations.
    IterationLimit,
    /// No step was found that makes progress: most often the rows cannot be met near the point where it stopped.
    Stalled,
    /// A value or a derivative is not a number.
    NotFinite,
}

/// One iteration.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Record {
    /// f(x).
    pub objective: f64,
    /// Largest violation of a row.
    pub violation: f64,
    /// Scaled error of the optimality conditions with products measured against zero.
    pub error: f64,
    /// Barrier parameter.
    pub barrier: f64,
    /// Added to the diagonal of the Hessian to make the step one of descent.
    pub regularisation: f64,
    /// Length of the step that led here, primal.
    pub step: f64,
}

/// The end of a run. The point itself stays in the method's iterate.
#[derive(Clone, Debug, PartialEq)]
pub struct Solution {
    /// How it ended.
    pub status: Status,
    /// f(x).
    pub objective: f64,
    /// Largest violation of a row.
    pub violation: f64,
    /// Scaled error of the optimality conditions.
    pub error: f64,
    /// Number of Newton steps.
    pub iterations: usize,
    /// One entry per iteration, the start included.
    pub history: Vec<Record>,
}
