//! The linearised dynamics over one segment, with the inner stages eliminated.
//!
//! With the integration matrix Ã the linearised defects are (stage 1 is the segment's first state, stage N + 1 its
//! last)
//!
//! ```text
//! v_i = v_1 + η Σ_j Ã_ij a_j        q_i = q_1 + η Σ_j Ã_ij v_j         i = 2..N+1
//! a_j = A^q_j q_j + A^v_j v_j + B_j u_j                                 j = 1..N
//! ```
//!
//! Only the accelerations of the stages 2..N are implicit, and of these only those of coordinates that are not
//! ignorable.

use super::dense_kernels::{Lu, add_scaled};
use super::radau::Radau;

/// Dimensions of a segment.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Dimensions {
    pub coordinates: usize,
    pub ignorable: usize,
    pub controls: usize,
    pub parameters: usize,
    pub order: usize,
}

impl Dimensions {
    /// Number of states.
    pub fn states(&self) -> usize {
        2 * self.coordinates
    }

    /// Length of a node vector.
    pub fn width(&self) -> usize {
        self.states() + self.controls
    }

    /// Number of controls of all stages.
    pub fn all_controls(&self) -> usize {
        self.order * self.controls
    }

    /// Number of coordinates that enter the accelerations.
    fn essential(&self) -> usize {
        self.coordinates - self.ignorable
    }
}

/// The linear system of the stages.
#[derive(Clone, Debug)]
pub struct Stages {
    dimensions: Dimensions,
    /// η Ã, N x N: row i is that of stage i + 2, column j that of stage j + 1.
    integration: Vec<f64>,
    /// Ã, and the square of its block of the implicit stages.
    unit: Vec<f64>,
    unit_square: Vec<f64>,
    lu: Lu,
    accelerations: Vec<f64>,
    velocities: Vec<f64>,
    adjoint: Adjoint,
}

/// Work arrays of the adjoint: multipliers of the accelerations at the stages 2..N, the implicit ones among them, and
/// the gradients at these stages.
#[derive(Clone, Debug, Default)]
struct Adjoint {
    accelerations: Vec<f64>,
    implicit: Vec<f64>,
    stages: Vec<f64>,
}

impl Stages {
    /// Work arrays for a segment; `columns` is the maximum width in [`close`](Self::close).
    pub fn new(dimensions: Dimensions, rule: &Radau, columns: usize) -> Self {
        let n = dimensions.order;
        let unit: Vec<f64> = (0..n * n).map(|k| rule.integration[(k / n, k % n)]).collect();
        let inner = n - 1;
        let square = |k: usize| {
            let (i, j) = (k / inner, k % inner);
            (0..inner).map(|l| unit[i * n + l + 1] * unit[l * n + j + 1]).sum()
        };
        Self {
            dimensions,
            integration: unit.clone(),
            unit_square: (0..inner * inner).map(square).collect(),
            unit,
            lu: Lu::new(inner * dimensions.essential()),
            accelerations: vec![0.0; inner * dimensions.coordinates * columns],
            velocities: vec![0.0; inner * dimensions.coordinates * columns],
            adjoint: Adjoint {
                accelerations: vec![0.0; inner * dimensions.coordinates],
                implicit: vec![0.0; inner * dimensions.essential()],
                stages: vec![0.0; inner * dimensions.states()],
            },
        }
    }

    /// η Ã_ij: row i is that of stage i + 2, column j that of stage j + 1.
    pub fn weight(&self, i: usize, j: usize) -> f64 {
        self.integration[i * self.dimensions.order + j]
    }

    /// Ã_ij.
    pub fn unit_weight(&self, i: usize, j: usize) -> f64 {
        self.unit[i * self.dimensions.order + j]
    }

    /// Factors the system of the implicit stages, with blocks
    ///
    /// ```text
    /// δ_ij I - η Ã_ij A^v_i - η^2 (Ã^2)_ij A^q_i
    /// ```
    ///
    /// - `jacobians`: [A^q A^v B] of all stages, coordinates x width each
    #[inline(always)]
    pub fn factor(&mut self, η: f64, jacobians: &[f64]) -> bool {
        let d = self.dimensions;
        let (n, nq, nn, width) = (d.order, d.coordinates, d.essential(), d.width());
        for (scaled, unit) in self.integration.iter_mut().zip(&self.unit) {
            *scaled = η * unit;
        }
        let inner = n - 1;
        let size = inner * nn;
        let matrix = self.lu.matrix_mut();
        for i in 0..inner {
            for r in 0..nn {
                let jacobian = &jacobians[((i + 1) * nq + d.ignorable + r) * width..][..width];
                let (a_q, a_v) = (&jacobian[d.ignorable..nq], &jacobian[nq + d.ignorable..2 * nq]);
                let row = &mut matrix[(i * nn + r) * size..][..size];
                for j in 0..inner {
                    let (first, second) = (η * self.unit[i * n + j + 1], η * η * self.unit_square[i * inner + j]);
                    for c in 0..nn {
                        row[j * nn + c] = -first * a_v[c] - second * a_q[c];
                    }
                }
                row[i * nn + r] += 1.0;
            }
        }
        self.lu.factor()
    }

    /// Solves the linearised dynamics in place.
    ///
    /// - `q`, `v`: N x coordinates rows of `width` columns for the stages 2..N+1: on entry the parts due to the first
    ///   state, the acceleration of stage 1 and the residuals, on return the solution
    /// - `controls`: adds B_j u_j to a row of the accelerations of stage j + 1, `(j, B_j, row)`
    #[inline(always)]
    pub fn close(
        &mut self,
        jacobians: &[f64],
        q: &mut [f64],
        v: &mut [f64],
        width: usize,
        controls: impl Fn(usize, &[f64], &mut [f64]),
    ) {
        let d = self.dimensions;
        let (inner, nq, ignorable) = (d.order - 1, d.coordinates, d.ignorable);
        self.integrate(q, v, width, 0..nq);
        self.linear_accelerations(jacobians, q, v, width, ignorable..nq, &controls);
        let nn = d.essential();
        self.lu.solve(&mut self.accelerations[..inner * nn * width], width);
        self.update(q, v, width, ignorable..nq);
        self.linear_accelerations(jacobians, q, v, width, 0..ignorable, &controls);
        self.update(q, v, width, 0..ignorable);
    }

    /// `q_i += η Σ_{j>=2} Ã_ij v_j` for all points.
    #[inline(always)]
    fn integrate(&self, q: &mut [f64], v: &[f64], width: usize, coordinates: std::ops::Range<usize>) {
        let (n, nq) = (self.dimensions.order, self.dimensions.coordinates);
        for i in 0..n {
            for j in 1..n {
                let weight = self.weight(i, j);
                for r in coordinates.clone() {
                    let from = &v[((j - 1) * nq + r) * width..][..width];
                    add_scaled(&mut q[(i * nq + r) * width..][..width], weight, from);
                }
            }
        }
    }

    /// Computes the accelerations of some coordinates at the stages 2..N from the states there, packed stage by stage.
    #[inline(always)]
    fn linear_accelerations(
        &mut self,
        jacobians: &[f64],
        q: &[f64],
        v: &[f64],
        width: usize,
        coordinates: std::ops::Range<usize>,
        controls: &impl Fn(usize, &[f64], &mut [f64]),
    ) {
        let d = self.dimensions;
        let (nq, count) = (d.coordinates, coordinates.len());
        for j in 1..d.order {
            for (k, r) in coordinates.clone().enumerate() {
                let jacobian = &jacobians[(j * nq + r) * d.width()..][..d.width()];
                let row = &mut self.accelerations[((j - 1) * count + k) * width..][..width];
                row.fill(0.0);
                for c in d.ignorable..nq {
                    let at = ((j - 1) * nq + c) * width;
                    if jacobian[c] != 0.0 {
                        add_scaled(row, jacobian[c], &q[at..at + width]);
                    }
                    if jacobian[nq + c] != 0.0 {
                        add_scaled(row, jacobian[nq + c], &v[at..at + width]);
                    }
                }
                controls(j, &jacobian[2 * nq..], row);
            }
        }
    }

    /// Adds the integrals of the accelerations of the stages 2..N to the states.
    #[inline(always)]
    fn update(&mut self, q: &mut [f64], v: &mut [f64], width: usize, coordinates: std::ops::Range<usize>) {
        let (n, nq, count) = (self.dimensions.order, self.dimensions.coordinates, coordinates.len());
        for j in 1..n {
            for (k, _) in coordinates.clone().enumerate() {
                let row = &mut self.velocities[((j - 1) * count + k) * width..][..width];
                row.fill(0.0);
                for l in 1..n {
                    let from = &self.accelerations[((l - 1) * count + k) * width..][..width];
                    add_scaled(row, self.integration[(j - 1) * n + l], from);
                }
            }
        }
        for i in 0..n {
            for (k, r) in coordinates.clone().enumerate() {
                let at = (i * nq + r) * width;
                for j in 1..n {
                    let weight = self.integration[i * n + j];
                    let from = ((j - 1) * count + k) * width;
                    add_scaled(&mut v[at..at + width], weight, &self.accelerations[from..from + width]);
                    add_scaled(&mut q[at..at + width], weight, &self.velocities[from..from + width]);
                }
            }
        }
    }

    /// Multipliers of the defects, from the stationarity of the stages.
    ///
    /// - `g`: negative gradient at the stages 2..N, N - 1 times (q, v)
    /// - `last`: multiplier of the segment's last state, which takes the place of g_{N+1}
    /// - `y`: receives the multipliers, N times (q, v)
    ///
    /// ```text
    /// Σ_k D_ki y_k - η G_i^T y_i = g_i,     G = [0 1; A^q A^v]       <=>       y_k = Σ_i Ã_ik (g_i + η G_i^T y_i)
    /// ```
    #[inline(always)]
    pub fn adjoint(&mut self, η: f64, jacobians: &[f64], g: &[f64], last: &[f64], y: &mut [f64]) {
        let d = self.dimensions;
        let (n, nq, nn) = (d.order, d.coordinates, d.essential());
        let mut work = std::mem::take(&mut self.adjoint);
        work.accelerations.fill(0.0);
        self.adjoint_pass(η, jacobians, g, last, &mut work, y);
        for (j, r) in (0..n - 1).flat_map(|j| (0..d.ignorable).map(move |r| (j, r))) {
            work.accelerations[j * nq + r] = y[(j + 1) * 2 * nq + nq + r];
        }
        self.adjoint_pass(η, jacobians, g, last, &mut work, y);
        for (k, implicit) in work.implicit.iter_mut().enumerate() {
            *implicit = y[(k / nn + 1) * 2 * nq + nq + d.ignorable + k % nn];
        }
        self.lu.solve_transposed(&mut work.implicit);
        for (k, value) in work.implicit.iter().enumerate() {
            work.accelerations[k / nn * nq + d.ignorable + k % nn] = *value;
        }
        self.adjoint_pass(η, jacobians, g, last, &mut work, y);
        self.adjoint = work;
    }

    /// Evaluates the right-hand sides for the multipliers of the accelerations in `work`.
    #[inline(always)]
    fn adjoint_pass(&self, η: f64, jacobians: &[f64], g: &[f64], last: &[f64], work: &mut Adjoint, y: &mut [f64]) {
        let d = self.dimensions;
        let (n, nq, width) = (d.order, d.coordinates, d.width());
        let Adjoint { accelerations: a, stages: stage, .. } = work;
        stage.copy_from_slice(g);
        for j in 0..n - 1 {
            for r in 0..nq {
                let jacobian = &jacobians[((j + 1) * nq + r) * width..][..2 * nq];
                add_scaled(&mut stage[j * 2 * nq..][..2 * nq], η * a[j * nq + r], jacobian);
            }
        }
        for half in [0, nq] {
            for i in 0..n {
                for r in half..half + nq {
                    let inner: f64 = (0..n - 1).map(|j| self.unit_weight(j, i) * stage[j * 2 * nq + r]).sum();
                    y[i * 2 * nq + r] = inner + self.unit_weight(n - 1, i) * last[r];
                }
            }
            if half == 0 {
                for (j, r) in (0..n - 1).flat_map(|j| (0..nq).map(move |r| (j, r))) {
                    stage[j * 2 * nq + nq + r] += η * y[(j + 1) * 2 * nq + r];
                }
            }
        }
    }

    /// `Σ_k Ã_ik r_k` for one component of the defects' right-hand sides r: their integral at stage i + 2.
    #[inline(always)]
    pub fn forced(&self, i: usize, component: usize, residuals: &[f64]) -> f64 {
        let states = self.dimensions.states();
        (0..self.dimensions.order).map(|k| self.unit_weight(i, k) * residuals[k * states + component]).sum()
    }
}
