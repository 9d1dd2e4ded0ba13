//! A solution as functions of time: the states' polynomials through all points of a segment, the controls' through its
//! nodes.

use super::layout::PhaseLayout;
use super::transcription::Transcription;
use crate::nlp::Warm;

/// A place on the mesh.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Place {
    /// Phase.
    pub phase: usize,
    /// Segment of the phase.
    pub segment: usize,
    /// Where on the segment, in [-1, 1].
    pub τ: f64,
}

impl Transcription<'_> {
    /// Node vector (q, q', u) at a place of the solution `x`.
    pub fn node(&self, x: &[f64], place: Place, node: &mut [f64]) {
        let (states, width) = (self.layout.states(), self.layout.width());
        let phase = &self.layout.phases[place.phase];
        let segment = &phase.segments[place.segment];
        let rule = &self.rules[segment.order];
        let x = &x[self.layout.node_at(phase, segment.first)..];
        node.fill(0.0);
        for (i, basis) in rule.state_basis(place.τ).into_iter().enumerate() {
            for r in 0..states {
                node[r] += basis * x[i * width + r];
            }
        }
        for (i, basis) in rule.control_basis(place.τ).into_iter().enumerate() {
            for r in states..width {
                node[r] += basis * x[i * width + r];
            }
        }
    }

    /// The place at a share of a phase's duration.
    pub fn place(&self, phase: usize, share: f64) -> Place {
        let segments = &self.layout.phases[phase].segments;
        let mut begin = 0.0;
        for (segment, layout) in segments.iter().enumerate() {
            if share <= begin + layout.share || segment + 1 == segments.len() {
                let τ = (2.0 * (share - begin) / layout.share - 1.0).clamp(-1.0, 1.0);
                return Place { phase, segment, τ };
            }
            begin += layout.share;
        }
        unreachable!("a phase has segments")
    }

    /// Times of all nodes and of the ends of the phases, s from the start, with their places.
    pub fn times_s(&self, x: &[f64]) -> Vec<(f64, Place)> {
        let mut times = Vec::new();
        let mut begin_s = 0.0;
        for (index, phase) in self.layout.phases.iter().enumerate() {
            let duration_s = self.duration_s(index, x);
            let mut share = 0.0;
            for (k, segment) in phase.segments.iter().enumerate() {
                let points = &self.rules[segment.order].points;
                let count = if k + 1 == phase.segments.len() { segment.order + 1 } else { segment.order };
                times.extend(points[..count].iter().map(|&τ| {
                    let place = Place { phase: index, segment: k, τ };
                    (begin_s + duration_s * (share + 0.5 * (τ + 1.0) * segment.share), place)
                }));
                share += segment.share;
            }
            // to the last bit: what begins a phase comes at no later time than what ends the one before
            begin_s = times.last().map_or(begin_s, |&(end_s, _)| end_s);
        }
        times
    }

    /// A solution of this programme as the start of another one of the same motion, on another mesh.
    ///
    /// Multipliers of defects over their quadrature weight are values of a costate, those of rows and bounds over weight
    /// and half-length are densities (Garg et al. 2010): these are carried over, not the multipliers themselves.
    pub fn carry_over(&self, solution: &Warm, to: &Transcription) -> Warm {
        let Warm { x, y, z, .. } = solution;
        let mut carried = Warm {
            x: vec![0.0; to.layout.variables()],
            y: vec![0.0; to.layout.equalities],
            v: vec![0.0; to.layout.inequalities],
            z: [vec![0.0; to.layout.variables()], vec![0.0; to.layout.variables()]],
        };
        let states = self.layout.states();
        carried.y[..states].copy_from_slice(&y[..states]);
        carried.x[to.layout.parameters_at..].copy_from_slice(&x[self.layout.parameters_at..]);
        for (carried, z) in carried.z.iter_mut().zip(z) {
            carried[to.layout.parameters_at..].copy_from_slice(&z[self.layout.parameters_at..]);
        }
        for phase in 0..self.layout.phases.len() {
            self.carry_phase(phase, solution, to, &mut carried);
        }
        carried
    }

    fn carry_phase(&self, index: usize, Warm { x, y, v, z }: &Warm, to: &Transcription, carried: &mut Warm) {
        let (states, width) = (self.layout.states(), self.layout.width());
        let (from, into) = (&self.layout.phases[index], &to.layout.phases[index]);
        let mut node = vec![0.0; width];
        let shares = to.shares(into);
        let (weights_from, weights_into) = (self.quadrature(from), to.quadrature(into));
        let nodes_from = self.shares(from);
        for (k, &share) in shares.iter().enumerate() {
            let place = self.place(index, share);
            self.node(x, place, &mut node);
            let at = to.layout.node_at(into, k);
            let count = if k < into.nodes { width } else { states };
            carried.x[at..at + count].copy_from_slice(&node[..count]);
            if k == into.nodes {
                break;
            }
            // linear between the nodes before and after
            let after = nodes_from[..from.nodes].partition_point(|&s| s <= share).min(from.nodes - 1);
            let before = after.saturating_sub(1);
            let gap = nodes_from[after] - nodes_from[before];
            let lean = if gap > 0.0 { ((share - nodes_from[before]) / gap).clamp(0.0, 1.0) } else { 0.0 };
            for (node, part) in [(before, 1.0 - lean), (after, lean)] {
                let defect = part * weights_into[k].0 / weights_from[node].0;
                let density = part * weights_into[k].1 / weights_from[node].1;
                let (d_from, d_into) = (self.layout.defect_at(from, node), to.layout.defect_at(into, k));
                for r in 0..states {
                    carried.y[d_into + r] += defect * y[d_from + r];
                }
                for r in 0..from.rows {
                    carried.v[into.rows_at + k * into.rows + r] += density * v[from.rows_at + node * from.rows + r];
                }
                let n_from = self.layout.node_at(from, node);
                for (carried, z) in carried.z.iter_mut().zip(z) {
                    for r in 0..width {
                        carried[at + r] += density * z[n_from + r];
                    }
                }
            }
        }
        carried.y[into.events_at..into.events_at + into.events]
            .copy_from_slice(&y[from.events_at..from.events_at + from.events]);
        carried.v[into.end_rows_at..into.end_rows_at + into.end_rows]
            .copy_from_slice(&v[from.end_rows_at..from.end_rows_at + from.end_rows]);
        if index + 1 < self.layout.phases.len() {
            carried.y[into.link_at..into.link_at + states].copy_from_slice(&y[from.link_at..from.link_at + states]);
        }
    }

    /// Quadrature weight of every node of a phase, without and with the segment's share.
    fn quadrature(&self, phase: &PhaseLayout) -> Vec<(f64, f64)> {
        let of = |segment: &super::layout::SegmentLayout| {
            let share = segment.share;
            self.rules[segment.order].weights.iter().map(move |&weight| (weight, weight * share)).collect::<Vec<_>>()
        };
        phase.segments.iter().flat_map(of).collect()
    }
}
