//! What the transcription has to be told about a motion.
//!
//! A node vector is `w = (q, q', u)`. Derivatives with respect to it come row by row; Hessians are full and symmetric.

/// How long a phase lasts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Duration {
    /// So long, s.
    Fixed(f64),
    /// The optimiser decides.
    Free {
        /// At least, s, > 0.
        least_s: f64,
        /// To begin with, s.
        guess_s: f64,
        /// At most, s.
        most_s: f64,
    },
    /// Whatever the phases before it leave of a total, s.
    RestOf(f64),
}

/// Multipliers with which the second derivatives at a node are summed:
/// `cost l + Σ acceleration_i a_i + Σ rows_j d_j`.
#[derive(Clone, Copy, Debug)]
pub struct NodeWeights<'a> {
    /// Of the running cost.
    pub cost: f64,
    /// Of the accelerations.
    pub acceleration: &'a [f64],
    /// Of the path rows.
    pub rows: &'a [f64],
}

/// Derivatives at a node; row-major. Everything is zero when the motion gets to write it.
#[derive(Debug)]
pub struct NodeDerivatives<'a> {
    /// Of the accelerations, coordinates x width.
    pub acceleration: &'a mut [f64],
    /// Of the running cost, width.
    pub cost: &'a mut [f64],
    /// Of the path rows, rows x width.
    pub rows: &'a mut [f64],
    /// Of the weighted sum, width x width.
    pub hessian: &'a mut [f64],
}

/// Values at the end of a phase, which depend on its last state.
#[derive(Clone, Debug, Default)]
pub struct EndValues {
    /// Rows that must be zero: the goal, the condition of the switch.
    pub events: Vec<f64>,
    /// Rows that must be >= 0.
    pub rows: Vec<f64>,
    /// State with which the next phase begins; empty after the last phase.
    pub next: Vec<f64>,
}

/// Multipliers of the three.
#[derive(Clone, Copy, Debug)]
pub struct EndWeights<'a> {
    /// Of the events.
    pub events: &'a [f64],
    /// Of the inequality rows.
    pub rows: &'a [f64],
    /// Of the next phase's state.
    pub next: &'a [f64],
}

/// Derivatives at the end of a phase with respect to its last state, row-major; zero when the motion gets to write them.
#[derive(Debug)]
pub struct EndDerivatives<'a> {
    /// Of the events, events x states.
    pub events: &'a mut [f64],
    /// Of the inequality rows, rows x states.
    pub rows: &'a mut [f64],
    /// Of the next state, states x states; empty after the last phase.
    pub next: &'a mut [f64],
    /// Of the weighted sum of all, states x states.
    pub hessian: &'a mut [f64],
}

/// A controlled second-order motion in phases, with a running cost and rows that hold along the path.
pub trait Motion: Sync {
    /// Number of coordinates q.
    fn coordinates(&self) -> usize;

    /// So many leading coordinates do not enter the accelerations (they are ignorable, as a position in a uniform field).
    fn ignorable(&self) -> usize;

    /// Number of controls u.
    fn controls(&self) -> usize;

    /// Durations, one per phase.
    fn durations(&self) -> &[Duration];

    /// Cost of a second of flight, on top of the running cost.
    fn time_cost(&self) -> f64 {
        0.0
    }

    /// The first state (q, q').
    fn start(&self) -> &[f64];

    /// Bounds of the node vector in a phase, lower and upper; infinite where there is none.
    fn bounds(&self, phase: usize) -> (&[f64], &[f64]);

    /// Number of path rows.
    fn rows(&self, phase: usize) -> usize;

    /// Number of events and of inequality rows at the end of a phase.
    fn end_rows(&self, phase: usize) -> (usize, usize);

    /// Accelerations and path rows at a node; returns the running cost.
    fn values(&self, phase: usize, node: &[f64], acceleration: &mut [f64], rows: &mut [f64]) -> f64;

    /// First derivatives at a node and the weighted second ones.
    fn differentiate(&self, phase: usize, node: &[f64], weights: NodeWeights, derivatives: NodeDerivatives);

    /// Values at the end of a phase.
    fn end_values(&self, phase: usize, state: &[f64], values: &mut EndValues);

    /// First derivatives at the end of a phase and the weighted second ones.
    fn end_differentiate(&self, phase: usize, state: &[f64], weights: EndWeights, derivatives: EndDerivatives);
}
