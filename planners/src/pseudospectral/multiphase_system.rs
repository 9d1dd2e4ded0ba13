//! The interface between a vehicle's optimal control problem and the transcription.
//!
//! A node vector is `w = (q, q', u)`. Jacobians with respect to it are row-major; Hessians are full and symmetric.

/// Duration of a phase.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Duration {
    /// Fixed, s.
    Fixed(f64),
    /// A variable of the nonlinear program.
    Free {
        /// Lower bound, s, > 0.
        min_s: f64,
        /// Initial guess, s.
        guess_s: f64,
        /// Upper bound, s.
        max_s: f64,
    },
    /// This total, s, less the durations of all earlier phases.
    Remainder(f64),
}

/// Weights of the second derivatives at a node: the Hessian is that of
/// `cost l + Σ_i acceleration_i a_i + Σ_j path_constraints_j d_j`.
#[derive(Clone, Copy, Debug)]
pub struct NodeWeights<'a> {
    /// Weight of the running cost.
    pub cost: f64,
    /// Weights of the accelerations, one per coordinate.
    pub acceleration: &'a [f64],
    /// Weights of the path constraints.
    pub path_constraints: &'a [f64],
}

/// Derivatives at a node with respect to the node vector. All entries are zero before the call.
#[derive(Debug)]
pub struct NodeDerivatives<'a> {
    /// Jacobian of the accelerations, coordinates x width.
    pub acceleration: &'a mut [f64],
    /// Gradient of the running cost, length width.
    pub cost: &'a mut [f64],
    /// Jacobian of the path constraints, constraints x width.
    pub path_constraints: &'a mut [f64],
    /// Hessian of the weighted sum, width x width.
    pub hessian: &'a mut [f64],
}

/// Functions of the final state of a phase.
#[derive(Clone, Debug, Default)]
pub struct TerminalValues {
    /// Terminal constraints that must be zero: the goal, the condition of a mode switch.
    pub equalities: Vec<f64>,
    /// Terminal constraints that must be >= 0.
    pub inequalities: Vec<f64>,
    /// Initial state of the next phase, which the linkage constraint imposes; empty in the last phase.
    pub next_state: Vec<f64>,
}

/// Weights of the second derivatives at the end of a phase.
#[derive(Clone, Copy, Debug)]
pub struct TerminalWeights<'a> {
    /// Weights of the equalities.
    pub equalities: &'a [f64],
    /// Weights of the inequalities.
    pub inequalities: &'a [f64],
    /// Weights of the next phase's initial state.
    pub next_state: &'a [f64],
}

/// Derivatives at the end of a phase with respect to its final state. All entries are zero before the call.
#[derive(Debug)]
pub struct TerminalDerivatives<'a> {
    /// Jacobian of the equalities, equalities x states.
    pub equalities: &'a mut [f64],
    /// Jacobian of the inequalities, inequalities x states.
    pub inequalities: &'a mut [f64],
    /// Jacobian of the next phase's initial state, states x states; empty in the last phase.
    pub next_state: &'a mut [f64],
    /// Hessian of the weighted sum of all three, states x states.
    pub hessian: &'a mut [f64],
}

/// A second-order system `q'' = a(q, q', u)` in phases, with a running cost, path constraints and terminal constraints.
pub trait MultiphaseSystem: Sync {
    /// Number of coordinates q.
    fn coordinates(&self) -> usize;

    /// Number of leading coordinates that are ignorable: they do not enter the accelerations, as a position in a
    /// uniform gravity field.
    fn ignorable(&self) -> usize;

    /// Number of controls u.
    fn controls(&self) -> usize;

    /// Durations, one per phase.
    fn durations(&self) -> &[Duration];

    /// Cost per second of flight, in addition to the running cost.
    fn time_cost(&self) -> f64 {
        0.0
    }

    /// Initial state (q, q') of the first phase.
    fn initial_state(&self) -> &[f64];

    /// Lower and upper bounds of the node vector in a phase; infinite where there is none.
    fn bounds(&self, phase: usize) -> (&[f64], &[f64]);

    /// Number of path constraints in a phase.
    fn path_constraint_count(&self, phase: usize) -> usize;

    /// Numbers of equalities and of inequalities at the end of a phase.
    fn terminal_constraint_counts(&self, phase: usize) -> (usize, usize);

    /// Writes accelerations and path constraints at a node; returns the running cost.
    fn evaluate(&self, phase: usize, node: &[f64], acceleration: &mut [f64], path_constraints: &mut [f64]) -> f64;

    /// Writes the first derivatives at a node, and the weighted second derivatives.
    fn differentiate(&self, phase: usize, node: &[f64], weights: NodeWeights, derivatives: NodeDerivatives);

    /// Writes the functions of the final state of a phase.
    fn evaluate_terminal(&self, phase: usize, state: &[f64], values: &mut TerminalValues);

    /// Writes their first derivatives, and the weighted second derivatives.
    fn differentiate_terminal(
        &self,
        phase: usize,
        state: &[f64],
        weights: TerminalWeights,
        derivatives: TerminalDerivatives,
    );
}
