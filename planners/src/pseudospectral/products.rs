//! Products with the Jacobians and Hessians of the last point of linearisation.

use super::dense_kernels::{add_scaled, dot};
use super::layout::PhaseLayout;
use super::transcription::Transcription;

impl Transcription<'_> {
    /// `out += J^T y` for the defects of a segment.
    pub(super) fn add_defects_transposed(&self, index: usize, k: usize, y: &[f64], out: &mut [f64]) {
        let (nq, n, width) = (self.layout.coordinates, self.layout.states(), self.layout.width());
        let phase = &self.layout.phases[index];
        let (first, order) = (phase.segments[k].first_node, phase.segments[k].order);
        let η = self.half_length(phase, k, &self.point.variables);
        let from = self.layout.node_at(phase, first);
        let y = &y[self.layout.defect_at(phase, first)..][..order * n];
        let mut η_derivative = 0.0;
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
            η_derivative -= dot(&y[..nq], velocities) + dot(&y[nq..], &self.point.accelerations[node * nq..][..nq]);
        }
        let fraction = phase.segments[k].fraction;
        for (out, coefficient) in out[self.layout.parameters_at..].iter_mut().zip(&phase.duration.coefficients) {
            *out += 0.5 * fraction * coefficient * η_derivative;
        }
    }

    /// `out -= J^T v` for the path constraints of a phase.
    pub(super) fn add_path_constraints_transposed(&self, phase: &PhaseLayout, v: &[f64], out: &mut [f64]) {
        let width = self.layout.width();
        for row in 0..phase.nodes * phase.path_constraints {
            let at = self.layout.node_at(phase, row / phase.path_constraints);
            let jacobian = &self.point.path_constraints[(phase.path_constraints_at + row) * width..][..width];
            add_scaled(&mut out[at..at + width], -v[phase.path_constraints_at + row], jacobian);
        }
    }

    /// `out += J_c^T y - J_d^T v` for the terminal constraints and the linkage of a phase.
    pub(super) fn add_end_transposed(&self, index: usize, y: &[f64], v: &[f64], out: &mut [f64]) {
        let n = self.layout.states();
        let (phase, end) = (&self.layout.phases[index], &self.point.ends[index]);
        let at = self.layout.node_at(phase, phase.nodes);
        for (row, y) in end.equalities.chunks_exact(n).zip(&y[phase.terminal_equalities_at..]) {
            add_scaled(&mut out[at..at + n], *y, row);
        }
        if !v.is_empty() {
            for (row, v) in end.inequalities.chunks_exact(n).zip(&v[phase.terminal_inequalities_at..]) {
                add_scaled(&mut out[at..at + n], -v, row);
            }
        }
        if !end.next_state.is_empty() {
            let y = &y[phase.linkage_at..][..n];
            for (row, y) in end.next_state.chunks_exact(n).zip(y) {
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
        let (first, order, fraction) =
            (phase.segments[k].first_node, phase.segments[k].order, phase.segments[k].fraction);
        let η = self.half_length(phase, k, &self.point.variables);
        let dη = 0.5 * fraction * dot(&phase.duration.coefficients, &dx[self.layout.parameters_at..]);
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

    /// `J dx` for the path constraints of a phase.
    pub(super) fn path_constraints_times(&self, phase: &PhaseLayout, dx: &[f64], d: &mut [f64]) {
        let width = self.layout.width();
        for row in 0..phase.nodes * phase.path_constraints {
            let at = self.layout.node_at(phase, row / phase.path_constraints);
            let jacobian = &self.point.path_constraints[(phase.path_constraints_at + row) * width..][..width];
            d[phase.path_constraints_at + row] = dot(jacobian, &dx[at..at + width]);
        }
    }

    /// `J dx` for the terminal constraints and the linkage of a phase.
    pub(super) fn end_times(&self, index: usize, dx: &[f64], c: &mut [f64], d: &mut [f64]) {
        let n = self.layout.states();
        let (phase, end) = (&self.layout.phases[index], &self.point.ends[index]);
        let state = &dx[self.layout.node_at(phase, phase.nodes)..][..n];
        for (c, row) in c[phase.terminal_equalities_at..].iter_mut().zip(end.equalities.chunks_exact(n)) {
            *c = dot(row, state);
        }
        for (d, row) in d[phase.terminal_inequalities_at..].iter_mut().zip(end.inequalities.chunks_exact(n)) {
            *d = dot(row, state);
        }
        if !end.next_state.is_empty() {
            let next = &dx[self.layout.phases[index + 1].variables_at..][..n];
            for ((c, row), next) in c[phase.linkage_at..].iter_mut().zip(end.next_state.chunks_exact(n)).zip(next) {
                *c = next - dot(row, state);
            }
        }
    }
    /// `H dx` for the nodes of a phase: writes their entries, and adds to those of the parameters.
    pub(super) fn node_hessians_times(&self, phase: &PhaseLayout, dx: &[f64], out: &mut [f64]) {
        let (width, at) = (self.layout.width(), self.layout.parameters_at);
        let parameters = &dx[at..];
        for segment in &phase.segments {
            let half_length_gradient = |coefficient: &f64| 0.5 * segment.fraction * coefficient;
            for node in segment.first_node..segment.first_node + segment.order {
                let from = self.layout.node_at(phase, node);
                let k = phase.first_node + node;
                let z = &dx[from..from + width];
                let cross = &self.point.cross[k * width..][..width];
                let coefficients = phase.duration.coefficients.iter();
                let dη: f64 = coefficients.zip(parameters).map(|(c, p)| half_length_gradient(c) * p).sum();
                let hessians = self.point.barrier_hessians[k * width * width..].chunks_exact(width).take(width);
                for (a, hessian) in hessians.enumerate() {
                    out[from + a] = dot(hessian, z) + dη * cross[a];
                }
                for (out, coefficient) in out[at..].iter_mut().zip(&phase.duration.coefficients) {
                    *out += half_length_gradient(coefficient) * dot(cross, z);
                }
            }
        }
    }
}
