//! Transfer of a solution to another mesh, for a warm start.
//!
//! The multipliers of defects, over their quadrature weights, are values of the costate; those of path constraints and
//! bounds, over weight and half-length, are densities in time (Garg et al. 2010). Costates and densities are
//! interpolated, not the multipliers themselves.

use super::layout::PhaseLayout;
use super::transcription::Transcription;
use crate::nlp::WarmStart;

/// Quadrature weight of a node: w_k, and w_k times the segment's fraction of the phase.
#[derive(Clone, Copy)]
struct NodeWeight {
    costate: f64,
    density: f64,
}

/// A node of the old mesh and its part in linear interpolation, with the factors of its multipliers.
struct Neighbour {
    node: usize,
    costate: f64,
    density: f64,
}

impl Transcription<'_> {
    /// The solution of this program as a warm start of `to`, a transcription of the same system on another mesh.
    pub fn transfer(&self, solution: &WarmStart, to: &Transcription) -> WarmStart {
        let WarmStart { x, y, z, .. } = solution;
        let zero = || vec![0.0; to.layout.variables()];
        let mut transferred = WarmStart {
            x: zero(),
            y: vec![0.0; to.layout.equalities],
            v: vec![0.0; to.layout.inequalities],
            z: [zero(), zero()],
        };
        let states = self.layout.states();
        transferred.y[..states].copy_from_slice(&y[..states]);
        transferred.x[to.layout.parameters_at..].copy_from_slice(&x[self.layout.parameters_at..]);
        for (transferred, z) in transferred.z.iter_mut().zip(z) {
            transferred[to.layout.parameters_at..].copy_from_slice(&z[self.layout.parameters_at..]);
        }
        for phase in 0..self.layout.phases.len() {
            self.transfer_nodes(phase, solution, to, &mut transferred);
            self.transfer_end(phase, solution, to, &mut transferred);
        }
        transferred
    }

    /// Interpolates variables and multipliers at the nodes of a phase.
    fn transfer_nodes(&self, index: usize, solution: &WarmStart, to: &Transcription, transferred: &mut WarmStart) {
        let (states, width) = (self.layout.states(), self.layout.width());
        let (from, into) = (&self.layout.phases[index], &to.layout.phases[index]);
        let (old_weights, new_weights) = (self.quadrature(from), to.quadrature(into));
        let old_fractions = self.node_fractions(from);
        let mut node = vec![0.0; width];
        for (k, &fraction) in to.node_fractions(into).iter().enumerate() {
            self.node(&solution.x, self.mesh_point(index, fraction), &mut node);
            let at = to.layout.node_at(into, k);
            let count = if k < into.nodes { width } else { states };
            transferred.x[at..at + count].copy_from_slice(&node[..count]);
            if k == into.nodes {
                break;
            }
            let after = old_fractions[..from.nodes].partition_point(|&s| s <= fraction).min(from.nodes - 1);
            let before = after.saturating_sub(1);
            let gap = old_fractions[after] - old_fractions[before];
            let part = if gap > 0.0 { ((fraction - old_fractions[before]) / gap).clamp(0.0, 1.0) } else { 0.0 };
            for (node, part) in [(before, 1.0 - part), (after, part)] {
                let costate = part * new_weights[k].costate / old_weights[node].costate;
                let density = part * new_weights[k].density / old_weights[node].density;
                self.add_multipliers(index, (Neighbour { node, costate, density }, k), solution, to, transferred);
            }
        }
    }

    /// Adds the multipliers of a node of the old mesh to those of node `k` of the new one.
    fn add_multipliers(
        &self,
        index: usize,
        (Neighbour { node, costate, density }, k): (Neighbour, usize),
        WarmStart { y, v, z, .. }: &WarmStart,
        to: &Transcription,
        transferred: &mut WarmStart,
    ) {
        let (from, into) = (&self.layout.phases[index], &to.layout.phases[index]);
        let (old, new) = (self.layout.defect_at(from, node), to.layout.defect_at(into, k));
        for r in 0..self.layout.states() {
            transferred.y[new + r] += costate * y[old + r];
        }
        let count = from.path_constraints;
        let (old, new) = (from.path_constraints_at + node * count, into.path_constraints_at + k * count);
        for r in 0..count {
            transferred.v[new + r] += density * v[old + r];
        }
        let (old, new) = (self.layout.node_at(from, node), to.layout.node_at(into, k));
        for (transferred, z) in transferred.z.iter_mut().zip(z) {
            for r in 0..self.layout.width() {
                transferred[new + r] += density * z[old + r];
            }
        }
    }

    /// Copies the multipliers of the terminal constraints and of the linkage of a phase.
    fn transfer_end(
        &self,
        index: usize,
        WarmStart { y, v, .. }: &WarmStart,
        to: &Transcription,
        transferred: &mut WarmStart,
    ) {
        let (from, into) = (&self.layout.phases[index], &to.layout.phases[index]);
        transferred.y[into.terminal_equalities_at..][..into.terminal_equalities]
            .copy_from_slice(&y[from.terminal_equalities_at..][..from.terminal_equalities]);
        transferred.v[into.terminal_inequalities_at..][..into.terminal_inequalities]
            .copy_from_slice(&v[from.terminal_inequalities_at..][..from.terminal_inequalities]);
        if index + 1 < self.layout.phases.len() {
            let states = self.layout.states();
            transferred.y[into.linkage_at..][..states].copy_from_slice(&y[from.linkage_at..][..states]);
        }
    }

    /// Quadrature weights of all nodes of a phase.
    fn quadrature(&self, phase: &PhaseLayout) -> Vec<NodeWeight> {
        let segment_weights = |segment: &super::layout::SegmentLayout| {
            let fraction = segment.fraction;
            let weights = self.rules[segment.order].weights.iter();
            weights.map(move |&weight| NodeWeight { costate: weight, density: weight * fraction }).collect::<Vec<_>>()
        };
        phase.segments.iter().flat_map(segment_weights).collect()
    }
}
