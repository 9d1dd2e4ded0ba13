//! Solution of a condensed segment: the backward pass computes the gradient of the cost-to-go, the forward pass the
//! variables and the multipliers of the defects.

use super::condensed_segment::{CondensedSegment, Nodes, costate};
use super::dense_kernels::{add_scaled, dot};

impl CondensedSegment {
    /// Backward pass: writes the vector of the cost-to-go at the segment's first state to `before`. `next.vector` must
    /// be set.
    ///
    /// - `gradient`: negative right-hand side of the node vectors
    /// - `residuals`: right-hand side of the defects
    #[inline(always)]
    pub fn backward(&mut self, nodes: &Nodes, gradient: &[f64], residuals: &[f64], before: &mut [f64]) {
        let d = self.dimensions;
        let (n, nq, states, node_width, w) = (d.order, d.coordinates, d.states(), d.width(), self.width);
        let (x, p) = (self.state(), self.parameter());
        for i in 0..n {
            for r in 0..nq {
                self.offset_q[i * nq + r] = self.stages.forced(i, r, residuals);
                self.offset_v[i * nq + r] = self.stages.forced(i, nq + r, residuals);
            }
        }
        self.stages.close(nodes.jacobians, &mut self.offset_q, &mut self.offset_v, 1, |_, _, _| {});

        self.vector.fill(0.0);
        self.vector[x..x + states].copy_from_slice(&gradient[..states]);
        self.vector[..d.controls].copy_from_slice(&gradient[states..node_width]);
        for stage in 1..n {
            let hessian = &nodes.hessians[stage * node_width * node_width..][..node_width * node_width];
            let gradient = &gradient[stage * node_width..][..node_width];
            let (q, v) = (&self.offset_q[(stage - 1) * nq..][..nq], &self.offset_v[(stage - 1) * nq..][..nq]);
            let at = |a: usize| {
                let row = &hessian[a * node_width..][..states];
                gradient[a] + dot(&row[..nq], q) + dot(&row[nq..], v)
            };
            for r in 0..states {
                let rows = if r < nq { &self.q } else { &self.v };
                let from = ((stage - 1) * nq + r % nq) * w;
                let g = at(r);
                if g != 0.0 {
                    add_scaled(&mut self.vector, g, &rows[from..from + w]);
                }
            }
            let u = stage * d.controls;
            for k in 0..d.controls {
                self.vector[u + k] += at(states + k);
            }
            let cross = &nodes.cross[stage * node_width..][..states];
            for (k, slope) in nodes.half_length_gradient.iter().enumerate() {
                self.vector[p + k] += slope * (dot(&cross[..nq], q) + dot(&cross[nq..], v));
            }
        }
        self.add_next_vector();
        for k in 0..x {
            let row = &self.quadratic[k * w..(k + 1) * w];
            let value = self.vector[k] / row[k];
            self.vector[k] = value;
            add_scaled(&mut self.vector[k + 1..], -value, &row[k + 1..]);
        }
        before.copy_from_slice(&self.vector[x..x + states + d.parameters]);
    }

    /// Adds the gradient of the cost-to-go at the segment's end.
    #[inline(always)]
    fn add_next_vector(&mut self) {
        let d = self.dimensions;
        let (w, nq, states, p) = (self.width, d.coordinates, d.states(), self.parameter());
        let size = states + d.parameters;
        let last = (d.order - 1) * nq;
        for r in 0..size {
            let row = &self.next.matrix[r * size..][..states];
            let offset = dot(&row[..nq], &self.offset_q[last..]) + dot(&row[nq..], &self.offset_v[last..]);
            let value = self.next.vector[r] + offset;
            if r < states {
                let rows = if r < nq { &self.q } else { &self.v };
                add_scaled(&mut self.vector, value, &rows[(last + r % nq) * w..][..w]);
            } else {
                self.vector[p + r - states] += value;
            }
        }
    }

    /// Forward pass: writes the node vectors and the last state to `solution`, whose first state is given, and the
    /// multipliers of the defects.
    #[inline(always)]
    pub fn forward(
        &mut self,
        nodes: &Nodes,
        gradient: &[f64],
        parameters: &[f64],
        solution: &mut [f64],
        multipliers: &mut [f64],
    ) {
        let d = self.dimensions;
        let (n, nq, states, node_width, w) = (d.order, d.coordinates, d.states(), d.width(), self.width);
        let (x, p) = (self.state(), self.parameter());
        let mut columns = std::mem::take(&mut self.columns);
        columns.fill(0.0);
        columns[x..x + states].copy_from_slice(&solution[..states]);
        columns[p..p + d.parameters].copy_from_slice(parameters);
        for k in (0..x).rev() {
            let row = &self.quadratic[k * w..(k + 1) * w];
            columns[k] = -(self.vector[k] + dot(&row[k + 1..], &columns[k + 1..])) / row[k];
        }
        for i in 0..n {
            for r in 0..nq {
                let at = (i * nq + r) * w;
                let point = &mut solution[(i + 1) * node_width..];
                point[r] = self.offset_q[i * nq + r] + dot(&self.q[at..at + w], &columns);
                point[nq + r] = self.offset_v[i * nq + r] + dot(&self.v[at..at + w], &columns);
            }
            solution[i * node_width + states..(i + 1) * node_width]
                .copy_from_slice(&columns[i * d.controls..(i + 1) * d.controls]);
        }
        self.columns = columns;
        self.multipliers(nodes, gradient, parameters, solution, multipliers);
    }

    /// Writes the multipliers of the defects, from the stationarity of the stages 2..N.
    #[inline(always)]
    fn multipliers(
        &mut self,
        nodes: &Nodes,
        gradient: &[f64],
        parameters: &[f64],
        solution: &[f64],
        multipliers: &mut [f64],
    ) {
        let d = self.dimensions;
        let (n, states, node_width) = (d.order, d.states(), d.width());
        let half_length: f64 = dot(nodes.half_length_gradient, parameters);
        for stage in 1..n {
            let z = &solution[stage * node_width..][..node_width];
            for a in 0..states {
                let hessian = &nodes.hessians[(stage * node_width + a) * node_width..][..node_width];
                let at = stage * node_width + a;
                self.gradient[(stage - 1) * states + a] =
                    -gradient[at] - dot(hessian, z) - half_length * nodes.cross[at];
            }
        }
        costate(&self.next, &solution[n * node_width..][..states], parameters, &mut self.last);
        let g = &self.gradient[..(n - 1) * states];
        self.stages.adjoint(nodes.half_length, nodes.jacobians, g, &self.last, multipliers);
    }
}
