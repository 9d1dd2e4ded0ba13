//! Where everything stands in the vectors of the nonlinear programme.
//!
//! Variables: phase by phase the node vectors (q, q', u) and the last state; then the free durations. Equalities: the
//! start; then phase by phase the defects node by node (those of q, then those of q'), the events, and the link to the
//! next phase. Inequalities: phase by phase the path rows node by node, then the rows of the end.

use super::mesh::Mesh;
use super::motion::{Duration, Motion};

/// Sizes and offsets.
#[derive(Clone, Debug)]
pub struct Layout {
    pub coordinates: usize,
    pub controls: usize,
    pub phases: Vec<PhaseLayout>,
    /// Offset and number of the free durations.
    pub parameters_at: usize,
    pub parameters: usize,
    pub equalities: usize,
    pub inequalities: usize,
}

/// Offsets of a phase.
#[derive(Clone, Debug)]
pub struct PhaseLayout {
    /// Number of nodes.
    pub nodes: usize,
    /// Index of the first of them among all nodes.
    pub first_node: usize,
    /// Variables of the first node; the others follow, and then the last state.
    pub variables_at: usize,
    pub defects_at: usize,
    pub events_at: usize,
    pub events: usize,
    pub link_at: usize,
    pub rows_at: usize,
    /// Path rows of a node.
    pub rows: usize,
    pub end_rows_at: usize,
    pub end_rows: usize,
    pub duration: Affine,
    /// First node, share and order of the segments.
    pub segments: Vec<SegmentLayout>,
}

/// Offsets of a segment in its phase.
#[derive(Clone, Copy, Debug)]
pub struct SegmentLayout {
    pub first: usize,
    pub order: usize,
    pub share: f64,
}

/// A duration as a function of the free ones: `constant + Σ gains_j p_j`, s.
#[derive(Clone, Debug)]
pub struct Affine {
    pub constant: f64,
    pub gains: Vec<f64>,
}

impl Affine {
    /// Value for the free durations `p`.
    pub fn at(&self, p: &[f64]) -> f64 {
        self.constant + self.gains.iter().zip(p).map(|(gain, p)| gain * p).sum::<f64>()
    }
}

impl Layout {
    /// For `motion` on `mesh`, which has as many phases as the motion has durations.
    pub fn new(motion: &dyn Motion, mesh: &Mesh) -> Self {
        let durations = durations(motion.durations());
        assert_eq!(durations.len(), mesh.phases.len(), "one list of segments per phase");
        let states = 2 * motion.coordinates();
        let width = states + motion.controls();
        let (mut variables, mut equalities, mut inequalities, mut first_node) = (0, states, 0, 0);
        let last = durations.len() - 1;
        let mut phases = Vec::with_capacity(durations.len());
        for (index, duration) in durations.into_iter().enumerate() {
            let segments = segments(mesh, index);
            let nodes = segments.iter().map(|segment| segment.order).sum();
            let rows = motion.rows(index);
            let (events, end_rows) = motion.end_rows(index);
            let phase = PhaseLayout {
                nodes,
                first_node,
                variables_at: variables,
                defects_at: equalities,
                events_at: equalities + nodes * states,
                events,
                link_at: equalities + nodes * states + events,
                rows_at: inequalities,
                rows,
                end_rows_at: inequalities + nodes * rows,
                end_rows,
                duration,
                segments,
            };
            first_node += nodes;
            variables += nodes * width + states;
            equalities = phase.link_at + if index < last { states } else { 0 };
            inequalities = phase.end_rows_at + end_rows;
            phases.push(phase);
        }
        Self {
            coordinates: motion.coordinates(),
            controls: motion.controls(),
            parameters: phases[0].duration.gains.len(),
            phases,
            parameters_at: variables,
            equalities,
            inequalities,
        }
    }

    /// Number of states, 2 per coordinate.
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

    /// Offset of a node's variables; the node after the last one has a state only.
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
        let first = *next;
        *next += segment.order;
        Some(SegmentLayout { first, order: segment.order, share: segment.share })
    });
    starts.collect()
}

fn durations(durations: &[Duration]) -> Vec<Affine> {
    let free = durations.iter().filter(|duration| matches!(duration, Duration::Free { .. })).count();
    let mut so_far = Affine { constant: 0.0, gains: vec![0.0; free] };
    let mut next_parameter = 0;
    let affine = durations.iter().map(|duration| {
        let mut affine = Affine { constant: 0.0, gains: vec![0.0; free] };
        match *duration {
            Duration::Fixed(seconds) => affine.constant = seconds,
            Duration::Free { .. } => {
                affine.gains[next_parameter] = 1.0;
                next_parameter += 1;
            }
            Duration::RestOf(total) => {
                affine.constant = total - so_far.constant;
                affine.gains = so_far.gains.iter().map(|gain| -gain).collect();
            }
        }
        so_far.constant += affine.constant;
        for (sum, gain) in so_far.gains.iter_mut().zip(&affine.gains) {
            *sum += gain;
        }
        affine
    });
    affine.collect()
}
