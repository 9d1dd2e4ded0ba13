//! The solution as a function of time: states interpolate all points of a segment, controls its collocation points
//! (Kang, Huang, Wen 2020, eq. 23 and 24).

use super::transcription::Transcription;

/// A point on the mesh.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MeshPoint {
    /// Index of the phase.
    pub phase: usize,
    /// Index of the segment in its phase.
    pub segment: usize,
    /// Time on the segment, in [-1, 1].
    pub τ: f64,
}

impl Transcription<'_> {
    /// Writes the node vector (q, q', u) of the solution `x` at a mesh point.
    pub fn node(&self, x: &[f64], at: MeshPoint, node: &mut [f64]) {
        let (states, width) = (self.layout.states(), self.layout.width());
        let phase = &self.layout.phases[at.phase];
        let segment = &phase.segments[at.segment];
        let rule = &self.rules[segment.order];
        let x = &x[self.layout.node_at(phase, segment.first_node)..];
        node.fill(0.0);
        for (i, basis) in rule.state_basis(at.τ).into_iter().enumerate() {
            for r in 0..states {
                node[r] += basis * x[i * width + r];
            }
        }
        for (i, basis) in rule.control_basis(at.τ).into_iter().enumerate() {
            for r in states..width {
                node[r] += basis * x[i * width + r];
            }
        }
    }

    /// The mesh point at a fraction of a phase's duration.
    pub fn mesh_point(&self, phase: usize, fraction: f64) -> MeshPoint {
        let segments = &self.layout.phases[phase].segments;
        let mut begin = 0.0;
        for (segment, layout) in segments.iter().enumerate() {
            if fraction <= begin + layout.fraction || segment + 1 == segments.len() {
                let τ = (2.0 * (fraction - begin) / layout.fraction - 1.0).clamp(-1.0, 1.0);
                return MeshPoint { phase, segment, τ };
            }
            begin += layout.fraction;
        }
        unreachable!("a phase has segments")
    }

    /// Times, s from the start, and mesh points of all nodes and of the ends of all phases, in the order of time.
    pub fn node_times_s(&self, x: &[f64]) -> Vec<(f64, MeshPoint)> {
        let mut times = Vec::new();
        let mut begin_s = 0.0;
        for (index, phase) in self.layout.phases.iter().enumerate() {
            let duration_s = self.duration_s(index, x);
            let mut begin = 0.0;
            for (k, segment) in phase.segments.iter().enumerate() {
                let points = &self.rules[segment.order].points;
                let count = if k + 1 == phase.segments.len() { segment.order + 1 } else { segment.order };
                times.extend(points[..count].iter().map(|&τ| {
                    let point = MeshPoint { phase: index, segment: k, τ };
                    (begin_s + duration_s * (begin + 0.5 * (τ + 1.0) * segment.fraction), point)
                }));
                begin += segment.fraction;
            }
            // the end of a phase and the start of the next one are equal to the bit
            begin_s = times.last().map_or(begin_s, |&(end_s, _)| end_s);
        }
        times
    }
}
