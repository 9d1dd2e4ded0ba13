//! One segment as a stage of a linear-quadratic problem, with its nodes condensed. Its columns are the controls U of
//! all nodes, the first state x_1, and the parameters p.
//!
//! ```text
//! cost-to-go(x_1, p) = min_U  1/2 [U x_1 p] Q [U x_1 p]^T + cost-to-go of the next segment(x_{N+1}, p)
//! ```

use super::condensing::{Dimensions, Stages};
use super::dense_kernels::{add_scaled, add_transposed_product, dot, eliminate, padded, product};
use super::radau::Radau;

/// Pivots must exceed this for a strict minimum over the controls.
const MIN_PIVOT: f64 = 1e-14;

/// A quadratic function `1/2 z^T matrix z + vector^T z` of a state and the parameters, z = (x, p).
#[derive(Clone, Debug)]
pub struct CostToGo {
    /// Symmetric, full, row-major.
    pub matrix: Vec<f64>,
    pub vector: Vec<f64>,
}

impl CostToGo {
    /// Zero, for `size` states and parameters.
    pub fn zero(size: usize) -> Self {
        Self { matrix: vec![0.0; size * size], vector: vec![0.0; size] }
    }
}

/// The part of a linearisation that belongs to a segment, node by node.
#[derive(Clone, Copy, Debug)]
pub struct Nodes<'a> {
    /// Half-length η, s, and its gradient with respect to the parameters.
    pub half_length: f64,
    pub half_length_gradient: &'a [f64],
    /// Hessians with the barrier's terms.
    pub hessians: &'a [f64],
    /// Jacobians [A^q A^v B] of the accelerations.
    pub jacobians: &'a [f64],
    /// Accelerations, and node vectors.
    pub accelerations: &'a [f64],
    pub variables: &'a [f64],
    /// Mixed second derivatives with respect to η and the node vector.
    pub cross: &'a [f64],
}

/// The condensed segment and its factors.
#[derive(Clone, Debug)]
pub struct CondensedSegment {
    pub(super) stages: Stages,
    pub(super) dimensions: Dimensions,
    /// Number of columns, padded.
    pub(super) width: usize,
    /// q and v at the points 2..N+1 as linear functions of the columns, a row per coordinate.
    pub(super) q: Vec<f64>,
    pub(super) v: Vec<f64>,
    /// Q, and after the factorisation the Cholesky factor of the controls' block.
    pub(super) quadratic: Vec<f64>,
    left: Vec<f64>,
    right: Vec<f64>,
    compact: Vec<f64>,
    /// States of a node with nonzero second derivatives.
    active: Vec<usize>,
    /// Cost-to-go at the segment's end.
    pub next: CostToGo,
    /// Particular solution at the points 2..N+1 for the last right-hand side.
    pub(super) offset_q: Vec<f64>,
    pub(super) offset_v: Vec<f64>,
    pub(super) vector: Vec<f64>,
    pub(super) gradient: Vec<f64>,
    /// The solution by columns, and the multiplier of the last state.
    pub(super) columns: Vec<f64>,
    pub(super) last: Vec<f64>,
}

impl CondensedSegment {
    /// Work arrays for a segment.
    pub fn new(dimensions: Dimensions, rule: &Radau) -> Self {
        let (n, nq) = (dimensions.order, dimensions.coordinates);
        let size = dimensions.all_controls() + dimensions.states() + dimensions.parameters;
        let width = padded(size);
        let tall = dimensions.width().max(dimensions.states());
        Self {
            stages: Stages::new(dimensions, rule, width),
            dimensions,
            width,
            q: vec![0.0; n * nq * width],
            v: vec![0.0; n * nq * width],
            quadratic: vec![0.0; width * width],
            left: vec![0.0; tall * width],
            right: vec![0.0; tall * width],
            compact: vec![0.0; dimensions.width() * dimensions.width()],
            active: Vec::with_capacity(dimensions.width()),
            next: CostToGo::zero(dimensions.states() + dimensions.parameters),
            offset_q: vec![0.0; n * nq],
            offset_v: vec![0.0; n * nq],
            vector: vec![0.0; width],
            gradient: vec![0.0; n * dimensions.states()],
            columns: vec![0.0; width],
            last: vec![0.0; dimensions.states()],
        }
    }

    /// First column of the controls of a stage.
    fn control(&self, stage: usize) -> usize {
        stage * self.dimensions.controls
    }

    /// First column of the first state.
    pub(super) fn state(&self) -> usize {
        self.dimensions.all_controls()
    }

    /// First column of the parameters.
    pub(super) fn parameter(&self) -> usize {
        self.state() + self.dimensions.states()
    }

    /// Condenses the nodes, adds `next`, eliminates the controls, and writes the cost-to-go at the segment's first
    /// state.
    ///
    /// Returns false if the problem has no strict minimum over the controls.
    #[inline(always)]
    pub fn factor(&mut self, nodes: &Nodes, before: &mut [f64]) -> bool {
        if !self.stages.factor(nodes.half_length, nodes.jacobians) {
            return false;
        }
        self.sensitivities(nodes);
        self.quadratic.fill(0.0);
        self.first_stage(nodes);
        for stage in 1..self.dimensions.order {
            self.inner_stage(nodes, stage);
        }
        self.add_next();
        let (pivots, columns) = (self.state(), self.parameter() + self.dimensions.parameters);
        if !eliminate(&mut self.quadratic, pivots, columns, self.width, MIN_PIVOT) {
            return false;
        }
        let size = self.dimensions.states() + self.dimensions.parameters;
        for i in 0..size {
            for j in i..size {
                let value = self.quadratic[(pivots + i) * self.width + pivots + j];
                before[i * size + j] = value;
                before[j * size + i] = value;
            }
        }
        true
    }

    /// q and v at the points 2..N+1 as linear functions of the columns.
    #[inline(always)]
    fn sensitivities(&mut self, nodes: &Nodes) {
        let d = self.dimensions;
        let (n, nq, w, node_width) = (d.order, d.coordinates, self.width, d.width());
        let (u, x, p) = (self.control(0), self.state(), self.parameter());
        self.q.fill(0.0);
        self.v.fill(0.0);
        for i in 0..n {
            let first = self.stages.weight(i, 0);
            for r in 0..nq {
                let (q, v) = (&mut self.q[(i * nq + r) * w..][..w], &mut self.v[(i * nq + r) * w..][..w]);
                q[x + r] += 1.0;
                q[x + nq + r] += first;
                v[x + nq + r] += 1.0;
                let jacobian = &nodes.jacobians[r * node_width..][..node_width];
                add_scaled(&mut v[x..x + 2 * nq], first, &jacobian[..2 * nq]);
                add_scaled(&mut v[u..u + d.controls], first, &jacobian[2 * nq..]);
                for (k, slope) in nodes.half_length_gradient.iter().enumerate() {
                    for j in 0..n {
                        let weight = slope * self.stages.unit_weight(i, j);
                        q[p + k] += weight * nodes.variables[j * node_width + nq + r];
                        v[p + k] += weight * nodes.accelerations[j * nq + r];
                    }
                }
            }
        }
        let controls = d.controls;
        self.stages.close(nodes.jacobians, &mut self.q, &mut self.v, w, |stage, b, row| {
            add_scaled(&mut row[stage * controls..(stage + 1) * controls], 1.0, b);
        });
    }

    /// Adds the Hessian of stage 1, whose state is the first state.
    #[inline(always)]
    fn first_stage(&mut self, nodes: &Nodes) {
        let d = self.dimensions;
        let (w, states, node_width) = (self.width, d.states(), d.width());
        let (x, p) = (self.state(), self.parameter());
        let column = |a: usize| if a < states { x + a } else { a - states };
        for a in 0..node_width {
            let hessian = &nodes.hessians[a * node_width..][..node_width];
            let row = &mut self.quadratic[column(a) * w..][..w];
            for (b, h) in hessian.iter().enumerate() {
                row[column(b)] += h;
            }
            for (k, slope) in nodes.half_length_gradient.iter().enumerate() {
                row[p + k] += slope * nodes.cross[a];
            }
        }
    }

    /// `Q += Z^T H Z` for the node vector Z of a later stage, with the mixed terms of the parameters.
    #[inline(always)]
    fn inner_stage(&mut self, nodes: &Nodes, stage: usize) {
        let d = self.dimensions;
        let (w, nq, states, node_width) = (self.width, d.coordinates, d.states(), d.width());
        let (u, p) = (self.control(stage), self.parameter());
        let hessian = &nodes.hessians[stage * node_width * node_width..][..node_width * node_width];
        let cross = &nodes.cross[stage * node_width..][..node_width];
        let has_parameters = d.parameters > 0;
        self.active.clear();
        for a in 0..states {
            let row = &hessian[a * node_width..][..node_width];
            if row.iter().any(|&h| h != 0.0) || (has_parameters && cross[a] != 0.0) {
                self.active.push(a);
            }
        }
        let count = self.active.len();
        let total = count + d.controls;
        for (k, &a) in self.active.iter().enumerate() {
            let from =
                if a < nq { &self.q[((stage - 1) * nq + a) * w..] } else { &self.v[((stage - 1) * nq + a - nq) * w..] };
            self.left[k * w..(k + 1) * w].copy_from_slice(&from[..w]);
        }
        for (k, a) in self.active.iter().copied().chain(states..node_width).enumerate() {
            for (l, &b) in self.active.iter().enumerate() {
                self.compact[k * count + l] = hessian[a * node_width + b];
            }
        }
        product(&mut self.right, &self.compact, count, &self.left, total, count, w);
        for (k, a) in self.active.iter().copied().chain(states..node_width).enumerate() {
            let row = &mut self.right[k * w..(k + 1) * w];
            add_scaled(&mut row[u..u + d.controls], 1.0, &hessian[a * node_width + states..][..d.controls]);
            for (l, slope) in nodes.half_length_gradient.iter().enumerate() {
                row[p + l] += slope * cross[a];
            }
        }
        add_transposed_product(&mut self.quadratic, w, w, &self.left, &self.right, count);
        for k in 0..d.controls {
            add_scaled(&mut self.quadratic[(u + k) * w..][..w], 1.0, &self.right[(count + k) * w..][..w]);
        }
        for (l, slope) in nodes.half_length_gradient.iter().enumerate() {
            let row = &mut self.quadratic[(p + l) * w..][..w];
            for (k, &a) in self.active.iter().enumerate() {
                add_scaled(&mut row[p..p + d.parameters], slope * cross[a], &self.left[k * w + p..][..d.parameters]);
            }
        }
    }

    /// `Q += F^T P F` for the cost-to-go P at the last state and the parameters.
    #[inline(always)]
    fn add_next(&mut self) {
        let d = self.dimensions;
        let (w, nq, states, p) = (self.width, d.coordinates, d.states(), self.parameter());
        let size = states + d.parameters;
        let last = (d.order - 1) * nq * w;
        self.left[..nq * w].copy_from_slice(&self.q[last..last + nq * w]);
        self.left[nq * w..states * w].copy_from_slice(&self.v[last..last + nq * w]);
        product(&mut self.right, &self.next.matrix, size, &self.left, states, states, w);
        for r in 0..states {
            let next = &self.next.matrix[r * size + states..][..d.parameters];
            add_scaled(&mut self.right[r * w + p..][..d.parameters], 1.0, next);
        }
        add_transposed_product(&mut self.quadratic, w, w, &self.left, &self.right, states);
        for k in 0..d.parameters {
            let next = &self.next.matrix[(states + k) * size..][..size];
            let row = &mut self.quadratic[(p + k) * w + p..][..d.parameters];
            add_scaled(row, 1.0, &next[states..]);
            for (r, &next) in next[..states].iter().enumerate() {
                add_scaled(row, next, &self.left[r * w + p..][..d.parameters]);
            }
        }
    }
}

/// Writes the costate: the negative gradient of a cost-to-go with respect to the state.
#[inline(always)]
pub fn costate(next: &CostToGo, state: &[f64], parameters: &[f64], to: &mut [f64]) {
    let (states, size) = (state.len(), next.vector.len());
    for (r, to) in to.iter_mut().enumerate() {
        let row = &next.matrix[r * size..][..size];
        *to = -(next.vector[r] + dot(&row[..states], state) + dot(&row[states..], parameters));
    }
}
