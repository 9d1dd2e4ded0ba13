//! The Newton direction. Slacks and duals are eliminated first, and recovered from dx:
//!
//! ```text
//! [ W + Σ_t + δ + J_d^T Σ_s J_d   J_c^T ] [ dx ]     [ ∇f + J_c^T y - Σ_j ±μ/t_j - J_d^T (μ/s - Σ_s (d - s)) ]
//! [ J_c                             0   ] [ dy ] = - [ c                                                     ]
//!
//! ds = J_d dx + d - s,      dv = μ/s - v - Σ_s ds,      Σ_s = v/s, and likewise Σ_t for the slacks t of the bounds
//! ```

use super::iterate::{Bounds, Iterate};
use super::program::{Program, Sizes};

/// Iterative refinement ends at this residual, relative to the right-hand side, or after this many rounds.
const REFINEMENT_TOLERANCE: f64 = 1e-11;
const MAX_REFINEMENTS: usize = 4;

/// Values at a point.
#[derive(Clone, Debug)]
pub struct Values {
    pub objective: f64,
    pub c: Vec<f64>,
    pub d: Vec<f64>,
    pub gradient: Vec<f64>,
}

impl Values {
    /// All zero.
    pub fn zero(sizes: Sizes) -> Self {
        Self {
            objective: 0.0,
            c: vec![0.0; sizes.equalities],
            d: vec![0.0; sizes.inequalities],
            gradient: vec![0.0; sizes.variables],
        }
    }
}

/// Residuals of the constraints that a direction is to remove: those of a point, or those of a second-order correction.
#[derive(Clone, Debug)]
pub struct Residuals {
    /// c.
    pub c: Vec<f64>,
    /// d - s.
    pub slack: Vec<f64>,
}

impl Residuals {
    /// All zero.
    pub fn zero(sizes: Sizes) -> Self {
        Self { c: vec![0.0; sizes.equalities], slack: vec![0.0; sizes.inequalities] }
    }
}

/// Work vectors of the Newton system.
#[derive(Clone, Debug)]
pub struct Newton {
    rhs_x: Vec<f64>,
    rhs_y: Vec<f64>,
    residual_x: Vec<f64>,
    residual_y: Vec<f64>,
    /// J_d dx, which the refinement does not use.
    unused: Vec<f64>,
    /// μ/s - Σ_s (d - s).
    inequality_duals: Vec<f64>,
    /// δ + Σ_t, and Σ_s.
    diagonal: Vec<f64>,
    weights: Vec<f64>,
}

impl Newton {
    /// Work vectors for programs of that size.
    pub fn new(sizes: Sizes) -> Self {
        Self {
            rhs_x: vec![0.0; sizes.variables],
            rhs_y: vec![0.0; sizes.equalities],
            residual_x: vec![0.0; sizes.variables],
            residual_y: vec![0.0; sizes.equalities],
            unused: vec![0.0; sizes.inequalities],
            inequality_duals: vec![0.0; sizes.inequalities],
            diagonal: vec![0.0; sizes.variables],
            weights: vec![0.0; sizes.inequalities],
        }
    }

    /// Factors at `point` with δ on the diagonal; false if the inertia is wrong.
    pub fn factor(&mut self, program: &mut impl Program, bounds: &Bounds, point: &Iterate, δ: f64) -> bool {
        self.diagonal.fill(δ);
        for ((bound, slack), dual) in bounds.0.iter().zip(&point.slack).zip(&point.dual) {
            self.diagonal[bound.index] += dual / slack;
        }
        let bound_count = bounds.0.len();
        let pairs = point.dual[bound_count..].iter().zip(&point.slack[bound_count..]);
        for (weight, (dual, slack)) in self.weights.iter_mut().zip(pairs) {
            *weight = dual / slack;
        }
        program.factor(&self.diagonal, &self.weights)
    }

    /// Writes the direction from `point` to the point of the central path at μ that removes `residuals` to first order.
    pub fn direction(
        &mut self,
        program: &mut impl Program,
        bounds: &Bounds,
        (point, gradient): (&Iterate, &[f64]),
        residuals: &Residuals,
        μ: f64,
        step: &mut Iterate,
    ) {
        let bound_count = bounds.0.len();
        for (i, dual) in self.inequality_duals.iter_mut().enumerate() {
            *dual = μ / point.slack[bound_count + i] - self.weights[i] * residuals.slack[i];
        }
        self.rhs_x.copy_from_slice(gradient);
        program.add_jacobian_transposed(&point.y, &self.inequality_duals, &mut self.rhs_x);
        for (bound, slack) in bounds.0.iter().zip(&point.slack) {
            self.rhs_x[bound.index] -= bound.sign * μ / slack;
        }
        negate(&mut self.rhs_x);
        self.rhs_y.copy_from_slice(&residuals.c);
        negate(&mut self.rhs_y);
        self.solve(program, step);

        bounds.steps(&step.x, &mut step.slack);
        program.jacobian_times(&step.x, &mut self.residual_y, &mut step.slack[bound_count..]);
        for (ds, residual) in step.slack[bound_count..].iter_mut().zip(&residuals.slack) {
            *ds += residual;
        }
        for (j, dual) in step.dual.iter_mut().enumerate() {
            let (s, v) = (point.slack[j], point.dual[j]);
            *dual = (μ - v * step.slack[j]) / s - v;
        }
    }

    /// Solves for `step.x` and `step.y`, with iterative refinement.
    fn solve(&mut self, program: &mut impl Program, step: &mut Iterate) {
        step.x.copy_from_slice(&self.rhs_x);
        step.y.copy_from_slice(&self.rhs_y);
        program.solve(&mut step.x, &mut step.y);
        let scale = max_norm(&self.rhs_x).max(max_norm(&self.rhs_y)).max(f64::MIN_POSITIVE);
        let mut last = f64::INFINITY;
        for _ in 0..MAX_REFINEMENTS {
            program.hessian_times(&step.x, &mut self.residual_x);
            program.add_jacobian_transposed(&step.y, &[], &mut self.residual_x);
            program.jacobian_times(&step.x, &mut self.residual_y, &mut self.unused);
            subtract_from(&self.rhs_x, &mut self.residual_x);
            subtract_from(&self.rhs_y, &mut self.residual_y);
            let residual = max_norm(&self.residual_x).max(max_norm(&self.residual_y)) / scale;
            if residual <= REFINEMENT_TOLERANCE || residual > 0.5 * last {
                break;
            }
            last = residual;
            program.solve(&mut self.residual_x, &mut self.residual_y);
            add(&mut step.x, &self.residual_x);
            add(&mut step.y, &self.residual_y);
        }
    }
}

/// Max norm; infinite if any entry is not finite.
pub fn max_norm(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |max, value| if value.is_finite() { value.abs().max(max) } else { f64::INFINITY })
}

/// `a <- a + b`.
fn add(a: &mut [f64], b: &[f64]) {
    for (a, b) in a.iter_mut().zip(b) {
        *a += b;
    }
}

/// `b <- a - b`.
fn subtract_from(a: &[f64], b: &mut [f64]) {
    for (b, a) in b.iter_mut().zip(a) {
        *b = a - *b;
    }
}

fn negate(values: &mut [f64]) {
    for value in values {
        *value = -*value;
    }
}
