//! Layout of the vectors of the nonlinear program.
//!
//! - Variables: phase by phase the node vectors (q, q', u) and the final state; then the parameters, which are the free
//!   durations.
//! - Equalities: the initial state; then phase by phase the defects node by node (those of q, then those of q'), the
//!   terminal equalities, and the linkage to the next phase.
//! - Inequalities: phase by phase the path constraints node by node, then the terminal inequalities.

use super::mesh::Mesh;
use super::multiphase_system::{Duration, MultiphaseSystem};

/// Sizes and offsets: a field `x_at` is the offset of x, a field `x` the number of x.
#[derive(Clone, Debug)]
pub struct Layout {
    pub coordinates: usize,
    pub controls: usize,
    pub phases: Vec<PhaseLayout>,
    /// The free durations.
    pub parameters_at: usize,
    pub parameters: usize,
    pub equalities: usize,
    pub inequalities: usize,
}

/// Offsets of a phase.
#[derive(Clone, Debug)]
pub struct PhaseLayout {
    /// Collocation points.
    pub nodes: usize,
    /// Index of the first node among the nodes of all phases.
    pub first_node: usize,
    pub variables_at: usize,
    pub defects_at: usize,
    pub terminal_equalities_at: usize,
    pub terminal_equalities: usize,
    pub linkage_at: usize,
    pub path_constraints_at: usize,
    /// Path constraints per node.
    pub path_constraints: usize,
    pub terminal_inequalities_at: usize,
    pub terminal_inequalities: usize,
    pub duration: AffineDuration,
    pub segments: Vec<SegmentLayout>,
}

/// A segment of a phase.
#[derive(Clone, Copy, Debug)]
pub struct SegmentLayout {
    /// Index of its first node among the nodes of the phase.
    pub first_node: usize,
    pub order: usize,
    /// Fraction of the phase's duration.
    pub fraction: f64,
}

/// A duration as a function of the free ones, s: `constant + Σ_j coefficients_j p_j`.
#[derive(Clone, Debug)]
pub struct AffineDuration {
    pub constant: f64,
    pub coefficients: Vec<f64>,
}

impl AffineDuration {
    /// Its value at the free durations `p`, s.
    pub fn at(&self, p: &[f64]) -> f64 {
        self.constant + self.coefficients.iter().zip(p).map(|(coefficient, p)| coefficient * p).sum::<f64>()
    }
}

impl Layout {
    /// The layout of `system` on `mesh`.
    ///
    /// # Panics
    ///
    /// Panics unless mesh and system have the same number of phases.
    pub fn new(system: &dyn MultiphaseSystem, mesh: &Mesh) -> Self {
        let durations = durations(system.durations());
        assert_eq!(durations.len(), mesh.phases.len(), "one list of segments per phase");
        let states = 2 * system.coordinates();
        let width = states + system.controls();
        let (mut variables, mut equalities, mut inequalities, mut first_node) = (0, states, 0, 0);
        let last = durations.len() - 1;
        let mut phases = Vec::with_capacity(durations.len());
        for (index, duration) in durations.into_iter().enumerate() {
            let segments = segments(mesh, index);
            let nodes = segments.iter().map(|segment| segment.order).sum();
            let path_constraints = system.path_constraint_count(index);
            let (terminal_equalities, terminal_inequalities) = system.terminal_constraint_counts(index);
            let phase = PhaseLayout {
                nodes,
                first_node,
                variables_at: variables,
                defects_at: equalities,
                terminal_equalities_at: equalities + nodes * states,
                terminal_equalities,
                linkage_at: equalities + nodes * states + terminal_equalities,
                path_constraints_at: inequalities,
                path_constraints,
                terminal_inequalities_at: inequalities + nodes * path_constraints,
                terminal_inequalities,
                duration,
                segments,
            };
            first_node += nodes;
            variables += nodes * width + states;
            equalities = phase.linkage_at + if index < last { states } else { 0 };
            inequalities = phase.terminal_inequalities_at + terminal_inequalities;
            phases.push(phase);
        }
        Self {
            coordinates: system.coordinates(),
            controls: system.controls(),
            parameters: phases[0].duration.coefficients.len(),
            phases,
            parameters_at: variables,
            equalities,
            inequalities,
        }
    }

    /// Number of states: 2 per coordinate.
    pub fn states(&self) -> usize {
        2 * self.coordinates
    }

    /// Length of a node vector.
    pub fn width(&self) -> usize {
        self.states() + self.controls
    }

    /// Number of variables.
    pub fn variables(&self) -> usize {
        self.parameters_at + self.parameters
    }

    /// Number of nodes of all phases.
    pub fn nodes(&self) -> usize {
        self.phases.iter().map(|phase| phase.nodes).sum()
    }

    /// Offset of a node's variables; node number `phase.nodes` is the final state, without controls.
    pub fn node_at(&self, phase: &PhaseLayout, node: usize) -> usize {
        phase.variables_at + node * self.width()
    }

    /// Offset of a node's defects.
    pub fn defect_at(&self, phase: &PhaseLayout, node: usize) -> usize {
        phase.defects_at + node * self.states()
    }
}

fn segments(mesh: &Mesh, phase: usize) -> Vec<SegmentLayout> {
    let starts = mesh.phases[phase].iter().scan(0, |next, segment| {
        let first_node = *next;
        *next += segment.order;
        Some(SegmentLayout { first_node, order: segment.order, fraction: segment.fraction })
    });
    starts.collect()
}

fn durations(durations: &[Duration]) -> Vec<AffineDuration> {
    let free = durations.iter().filter(|duration| matches!(duration, Duration::Free { .. })).count();
    let mut elapsed = AffineDuration { constant: 0.0, coefficients: vec![0.0; free] };
    let mut next_parameter = 0;
    let affine = durations.iter().map(|duration| {
        let mut affine = AffineDuration { constant: 0.0, coefficients: vec![0.0; free] };
        match *duration {
            Duration::Fixed(seconds) => affine.constant = seconds,
            Duration::Free { .. } => {
                affine.coefficients[next_parameter] = 1.0;
                next_parameter += 1;
            }
            Duration::Remainder(total) => {
                affine.constant = total - elapsed.constant;
                affine.coefficients = elapsed.coefficients.iter().map(|coefficient| -coefficient).collect();
            }
        }
        elapsed.constant += affine.constant;
        for (sum, coefficient) in elapsed.coefficients.iter_mut().zip(&affine.coefficients) {
            *sum += coefficient;
        }
        affine
    });
    affine.collect()
}
