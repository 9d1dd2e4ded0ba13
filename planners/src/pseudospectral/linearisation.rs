use super::layout::{Layout, PhaseLayout};

/// Derivatives of the nonlinear program at the last point of linearisation, all row-major.
///
/// Arrays are concatenated over the nodes of all phases; n is the number of states, w the width of a node vector.
#[derive(Clone, Debug)]
pub struct Linearisation {
    /// Hessians of the Lagrangian, w x w per node.
    pub hessians: Vec<f64>,
    /// The same with the barrier's diagonal and `Σ_j v_j/s_j ∇d_j ∇d_j^T` added.
    pub barrier_hessians: Vec<f64>,
    /// [A^q A^v B], the Jacobians of the accelerations, coordinates x w per node.
    pub jacobians: Vec<f64>,
    /// Accelerations, one per coordinate and node.
    pub accelerations: Vec<f64>,
    /// Jacobians of the path constraints, 1 x w per constraint, by the layout's offsets.
    pub path_constraints: Vec<f64>,
    /// Mixed second derivatives of the Lagrangian with respect to half-length η and node vector, length w per node.
    pub cross: Vec<f64>,
    /// The point itself.
    pub variables: Vec<f64>,
    /// Ends of the phases.
    pub ends: Vec<TerminalLinearisation>,
    /// The barrier's diagonal of the parameters.
    pub parameter_diagonal: Vec<f64>,
}

/// Derivatives at the end of a phase, row-major.
#[derive(Clone, Debug)]
pub struct TerminalLinearisation {
    /// Jacobian of the equalities, equalities x n.
    pub equalities: Vec<f64>,
    /// Jacobian of the inequalities, inequalities x n.
    pub inequalities: Vec<f64>,
    /// Jacobian of the next phase's initial state, n x n; empty in the last phase.
    pub next_state: Vec<f64>,
    /// Hessian of the Lagrangian, n x n.
    pub hessian: Vec<f64>,
    /// The same with the barrier's terms added.
    pub barrier_hessian: Vec<f64>,
}

impl Linearisation {
    /// All zero.
    pub fn zero(layout: &Layout) -> Self {
        let (nodes, n, width) = (layout.nodes(), layout.states(), layout.width());
        let last = layout.phases.len() - 1;
        let end = |(index, phase): (usize, &PhaseLayout)| TerminalLinearisation {
            equalities: vec![0.0; phase.terminal_equalities * n],
            inequalities: vec![0.0; phase.terminal_inequalities * n],
            next_state: if index < last { vec![0.0; n * n] } else { Vec::new() },
            hessian: vec![0.0; n * n],
            barrier_hessian: vec![0.0; n * n],
        };
        Self {
            hessians: vec![0.0; nodes * width * width],
            barrier_hessians: vec![0.0; nodes * width * width],
            jacobians: vec![0.0; nodes * layout.coordinates * width],
            accelerations: vec![0.0; nodes * layout.coordinates],
            path_constraints: vec![0.0; layout.inequalities * width],
            cross: vec![0.0; nodes * width],
            variables: vec![0.0; layout.variables()],
            ends: layout.phases.iter().enumerate().map(end).collect(),
            parameter_diagonal: vec![0.0; layout.parameters],
        }
    }
}
