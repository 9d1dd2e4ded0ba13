//! One Newton direction: what is left after slacks and duals have been eliminated, and what follows from it.
//!
//! ```text
//! [ W + Σ_x + δ + J_d^T Σ_s J_d   J_c^T ] [ dx ]     [ ∇f + J_c^T y - Σ_j μ/t_j - J_d^T (μ/s - Σ_s (d - s)) ]
//! [ J_c                             0   ] [ dy ] = - [ c                                                    ]
//!
//! ds = J_d dx + d - s,      dv = μ/s - v - Σ_s ds,      Σ_s = v/s, and so for the bounds' slacks t
//! ```

use super::iterate::{Iterate, Sides};
use super::program::{Program, Sizes};

/// Refinement stops at this residual relative to the right-hand side, or after so many rounds.
const RESIDUAL: f64 = 1e-11;
const ROUNDS: usize = 4;

/// Values at a point.
#[derive(Clone, Debug)]
pub struct Values {
    pub objective: f64,
    pub c: Vec<f64>,
    pub d: Vec<f64>,
    pub gradient: Vec<f64>,
}

impl Values {
    /// Room for values.
    pub fn zero(sizes: Sizes) -> Self {
        Self {
            objective: 0.0,
            c: vec![0.0; sizes.equalities],
            d: vec![0.0; sizes.inequalities],
            gradient: vec![0.0; sizes.variables],
        }
    }
}

/// Work vectors of the Newton system.
#[derive(Clone, Debug)]
pub struct Newton {
    rhs_x: Vec<f64>,
    rhs_y: Vec<f64>,
    residual_x: Vec<f64>,
    residual_y: Vec<f64>,
    rows: Vec<f64>,
    row_duals: Vec<f64>,
    diagonal: Vec<f64>,
    weights: Vec<f64>,
}

impl Newton {
    /// Room for programmes of that size.
    pub fn new(sizes: Sizes) -> Self {
        Self {
            rhs_x: vec![0.0; sizes.variables],
            rhs_y: vec![0.0; sizes.equalities],
            residual_x: vec![0.0; sizes.variables],
            residual_y: vec![0.0; sizes.equalities],
            rows: vec![0.0; sizes.inequalities],
            row_duals: vec![0.0; sizes.inequalities],
            diagonal: vec![0.0; sizes.variables],
            weights: vec![0.0; sizes.inequalities],
        }
    }

    /// Factors at `point` with δ on the diagonal; false if the curvature is wrong.
    pub fn factor(&mut self, program: &mut impl Program, sides: &Sides, point: &Iterate, δ: f64) -> bool {
        self.diagonal.fill(δ);
        for ((side, slack), dual) in sides.0.iter().zip(&point.slack).zip(&point.dual) {
            self.diagonal[side.index] += dual / slack;
        }
        let bounds = sides.0.len();
        for (weight, (dual, slack)) in
            self.weights.iter_mut().zip(point.dual[bounds..].iter().zip(&point.slack[bounds..]))
        {
            *weight = dual / slack;
        }
        program.factor(&self.diagonal, &self.weights)
    }

    /// The direction from `point` towards the central path of μ, with `c` and `excess = d - s` as the rows' residuals
    /// (those of the point, or those of a second-order correction).
    pub fn direction(
        &mut self,
        program: &mut impl Program,
        sides: &Sides,
        (point, gradient): (&Iterate, &[f64]),
        (c, excess): (&[f64], &[f64]),
        μ: f64,
        step: &mut Iterate,
    ) {
        let bounds = sides.0.len();
        for (i, dual) in self.row_duals.iter_mut().enumerate() {
            *dual = μ / point.slack[bounds + i] - self.weights[i] * excess[i];
        }
        self.rhs_x.copy_from_slice(gradient);
        program.add_transposed(&point.y, &self.row_duals, &mut self.rhs_x);
        for (side, slack) in sides.0.iter().zip(&point.slack) {
            self.rhs_x[side.index] -= side.sign * μ / slack;
        }
        negate(&mut self.rhs_x);
        self.rhs_y.copy_from_slice(c);
        negate(&mut self.rhs_y);
        self.solve(program, step);

        sides.steps(&step.x, &mut step.slack);
        program.rows_times(&step.x, &mut self.residual_y, &mut step.slack[bounds..]);
        for (ds, excess) in step.slack[bounds..].iter_mut().zip(excess) {
            *ds += excess;
        }
        for (j, dual) in step.dual.iter_mut().enumerate() {
            let (s, v) = (point.slack[j], point.dual[j]);
            *dual = (μ - v * step.slack[j]) / s - v;
        }
    }

    /// Solves for `step.x` and `step.y`, with refinement.
    fn solve(&mut self, program: &mut impl Program, step: &mut Iterate) {
        step.x.copy_from_slice(&self.rhs_x);
        step.y.copy_from_slice(&self.rhs_y);
        program.solve(&mut step.x, &mut step.y);
        let scale = largest(&self.rhs_x).max(largest(&self.rhs_y)).max(f64::MIN_POSITIVE);
        let mut last = f64::INFINITY;
        for _ in 0..ROUNDS {
            program.hessian_times(&step.x, &mut self.residual_x);
            program.add_transposed(&step.y, &[], &mut self.residual_x);
            program.rows_times(&step.x, &mut self.residual_y, &mut self.rows);
            subtract_from(&self.rhs_x, &mut self.residual_x);
            subtract_from(&self.rhs_y, &mut self.residual_y);
            let residual = largest(&self.residual_x).max(largest(&self.residual_y)) / scale;
            if residual <= RESIDUAL || residual > 0.5 * last {
                break;
            }
            last = residual;
            program.solve(&mut self.residual_x, &mut self.residual_y);
            add(&mut step.x, &self.residual_x);
            add(&mut step.y, &self.residual_y);
        }
    }
}

/// Largest absolute value; infinite as soon as one of them is not finite.
pub fn largest(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |max, value| if value.is_finite() { value.abs().max(max) } else { f64::INFINITY })
}

fn add(to: &mut [f64], what: &[f64]) {
    for (to, what) in to.iter_mut().zip(what) {
        *to += what;
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
