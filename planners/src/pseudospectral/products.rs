//! Products with the Jacobians of defects, path rows and ends, as they were linearised last.

use super::layout::PhaseLayout;
use super::small::{add_scaled, dot};
use super::transcription::Transcription;

impl Transcription<'_> {
    /// `out += J^T y` for the defects of a segment.
    pub(super) fn add_defects_transposed(&self, index: usize, k: usize, y: &[f64], out: &mut [f64]) {
        let (nq, n, width) = (self.layout.coordinates, self.layout.states(), self.layout.width());
        let phase = &self.layout.phases[index];
        let (first, order) = (phase.segments[k].first, phase.segments[k].order);
        let η = self.half_length(phase, k, &self.point.variables);
        let from = self.layout.node_at(phase, first);
        let y = &y[self.layout.defect_at(phase, first)..][..order * n];
        let mut length = 0.0;
        for (j, y) in y.chunks_exact(n).enumerate() {
            for i in 0..=order {
                add_scaled(&mut out[from + i * width..][..n], self.rules[order].differentiation[(j, i)], y);
            }
            let node = phase.first_node + first + j;
            let out = &mut out[from + j * width..][..width];
            add_scaled(&mut out[nq..n], -η, &y[..nq]);
            for (jacobian, y) in self.point.jacobians[node * nq * width..].chunks_exact(width).zip(&y[nq..]) {
                add_scaled(out, -η * y, jacobian);
            }
            let velocities = &self.point.variables[from + j * width + nq..][..nq];
            length -= dot(&y[..nq], velocities) + dot(&y[nq..], &self.point.accelerations[node * nq..][..nq]);
        }
        let share = phase.segments[k].share;
        for (out, gain) in out[self.layout.parameters_at..].iter_mut().zip(&phase.duration.gains) {
            *out += 0.5 * share * gain * length;
        }
    }

    /// `out -= J^T v` for the path rows of a phase.
    pub(super) fn add_rows_transposed(&self, phase: &PhaseLayout, v: &[f64], out: &mut [f64]) {
        let width = self.layout.width();
        for row in 0..phase.nodes * phase.rows {
            let at = self.layout.node_at(phase, row / phase.rows);
            let jacobian = &self.point.rows[(phase.rows_at + row) * width..][..width];
            add_scaled(&mut out[at..at + width], -v[phase.rows_at + row], jacobian);
        }
    }

    /// `out += J^T y - J^T v` for what stands at the end of a phase.
    pub(super) fn add_end_transposed(&self, index: usize, y: &[f64], v: &[f64], out: &mut [f64]) {
        let n = self.layout.states();
        let (phase, end) = (&self.layout.phases[index], &self.point.ends[index]);
        let at = self.layout.node_at(phase, phase.nodes);
        for (row, y) in end.events.chunks_exact(n).zip(&y[phase.events_at..]) {
            add_scaled(&mut out[at..at + n], *y, row);
        }
        if !v.is_empty() {
            for (row, v) in end.rows.chunks_exact(n).zip(&v[phase.end_rows_at..]) {
                add_scaled(&mut out[at..at + n], -v, row);
            }
        }
        if !end.next.is_empty() {
            let y = &y[phase.link_at..][..n];
            for (row, y) in end.next.chunks_exact(n).zip(y) {
                add_scaled(&mut out[at..at + n], -y, row);
            }
            let next = self.layout.phases[index + 1].variables_at;
            add_scaled(&mut out[next..next + n], 1.0, y);
        }
    }

    /// `J dx` for the defects of a segment.
    pub(super) fn defects_times(&self, index: usize, k: usize, dx: &[f64], c: &mut [f64]) {
        let (nq, n, width) = (self.layout.coordinates, self.layout.states(), self.layout.width());
        let phase = &self.layout.phases[index];
        let (first, order, share) = (phase.segments[k].first, phase.segments[k].order, phase.segments[k].share);
        let η = self.half_length(phase, k, &self.point.variables);
        let dη = 0.5 * share * dot(&phase.duration.gains, &dx[self.layout.parameters_at..]);
        let from = self.layout.node_at(phase, first);
        let c = &mut c[self.layout.defect_at(phase, first)..][..order * n];
        for (j, c) in c.chunks_exact_mut(n).enumerate() {
            c.fill(0.0);
            for i in 0..=order {
                add_scaled(c, self.rules[order].differentiation[(j, i)], &dx[from + i * width..][..n]);
            }
            let node = phase.first_node + first + j;
            let z = &dx[from + j * width..][..width];
            add_scaled(&mut c[..nq], -η, &z[nq..n]);
            add_scaled(&mut c[..nq], -dη, &self.point.variables[from + j * width + nq..][..nq]);
            let jacobians = self.point.jacobians[node * nq * width..].chunks_exact(width);
            let accelerations = &self.point.accelerations[node * nq..];
            for (c, (jacobian, acceleration)) in c[nq..].iter_mut().zip(jacobians.zip(accelerations)) {
                *c -= η * dot(jacobian, z) + dη * acceleration;
            }
        }
    }

    /// `J dx` for what stands at the end of a phase.
    pub(super) fn end_times(&self, index: usize, dx: &[f64], c: &mut [f64], d: &mut [f64]) {
        let n = self.layout.states();
        let (phase, end) = (&self.layout.phases[index], &self.point.ends[index]);
        let state = &dx[self.layout.node_at(phase, phase.nodes)..][..n];
        for (c, row) in c[phase.events_at..].iter_mut().zip(end.events.chunks_exact(n)) {
            *c = dot(row, state);
        }
        for (d, row) in d[phase.end_rows_at..].iter_mut().zip(end.rows.chunks_exact(n)) {
            *d = dot(row, state);
        }
        if !end.next.is_empty() {
            let next = &dx[self.layout.phases[index + 1].variables_at..][..n];
            for ((c, row), next) in c[phase.link_at..].iter_mut().zip(end.next.chunks_exact(n)).zip(next) {
                *c = next - dot(row, state);
            }
        }
    }
}
