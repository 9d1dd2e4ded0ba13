//! The Newton system of P4 (eq. 24 to 29) and its reduction (eq. 38, 39).
//!
//! ```text
//! A^T dλ           = -r_d
//! A dX + ds        = -r_p
//! S dλ + Λ ds      = -r_sl
//! ```
//!
//! Elimination of ds and then of dλ leaves the reduced system:
//!
//! ```text
//! [A^T (S^-1 Λ) A] dX = -r_d - A^T S^-1 (Λ r_p - r_sl)
//! dλ = (S^-1 Λ)(A dX + r_p - Λ^-1 r_sl)
//! ds = -Λ^-1 (r_sl + S dλ)
//! ```

use super::dense::{DenseKkt, DenseReduced};
use super::inequality_form::InequalityForm;
use super::kkt_vectors::{Direction, Residuals, RowIterate};
use super::sparse_ldl::SparseLdl;

/// Divided by the mean product and added to every s/λ of the reduced systems, it bounds the weights: rows that hold
/// exactly then do not dominate the soft directions, whose curvature falls with the products. Refinement removes its
/// effect.
const REGULARISATION: f64 = 1e-13;

/// Bounds of the regularisation that is added.
const REGULARISATION_RANGE: [f64; 2] = [1e-12, 1e-4];

/// Maximum number of refinements of one direction.
const MAX_REFINEMENTS: usize = 15;

/// Residual of the linear equations below which refinement ends unless it halves the residual.
const REFINED_RESIDUAL: f64 = 1e-14;

/// The linear solver: one of the three methods of the paper's Table 1.
#[derive(Clone, Debug)]
pub enum Elimination {
    /// Method I.
    SparseLdl(SparseLdl),
    /// Method II.
    DenseReduced(DenseReduced),
    /// Method III.
    DenseKkt(DenseKkt),
}

/// The Newton system of P4 at one iterate.
#[derive(Clone, Debug)]
pub struct KktSystem {
    form: InequalityForm,
    elimination: Elimination,
    /// Iterate at which the matrix is factored.
    pub at: RowIterate,
    /// Residuals: the negative right-hand sides.
    pub residuals: Residuals,
    /// The last direction.
    pub direction: Direction,
    /// 1/(s/λ + δ): the weights S^-1 Λ of the rows.
    weights: Vec<f64>,
    /// Residuals of the direction.
    remaining: Residuals,
    correction: Direction,
}

impl KktSystem {
    /// Workspace for `form`.
    pub fn new(form: InequalityForm, elimination: Elimination) -> Self {
        let (n_x, n_a) = (form.n_x(), form.n_a());
        let residuals = Residuals { dual: vec![0.0; n_x], primal: vec![0.0; n_a], product: vec![0.0; n_a] };
        let direction = Direction { x: vec![0.0; n_x], multiplier: vec![0.0; n_a], slack: vec![0.0; n_a] };
        Self {
            form,
            elimination,
            at: RowIterate { slack: vec![0.0; n_a], multiplier: vec![0.0; n_a] },
            residuals: residuals.clone(),
            direction: direction.clone(),
            weights: vec![0.0; n_a],
            remaining: residuals,
            correction: direction,
        }
    }

    /// Replaces the program. Results of the symbolic analysis are kept if the sparsity pattern is the same.
    pub fn set_form(&mut self, form: InequalityForm) {
        if form.n_x() == self.form.n_x() && form.n_a() == self.form.n_a() {
            self.elimination.prepare(&form);
            self.form = form;
        } else {
            let mut elimination = self.elimination.clone();
            elimination.prepare(&form);
            *self = Self::new(form, elimination);
        }
    }

    /// The program.
    pub fn form(&self) -> &InequalityForm {
        &self.form
    }

    /// Sets the residuals at `x` and [`KktSystem::at`]: g + A^T λ, s + A X - b, and S Λ e.
    pub fn set_residuals(&mut self, x: &[f64]) {
        let Self { form, at, residuals, .. } = self;
        residuals.dual.copy_from_slice(&form.cost);
        form.add_transposed_product(&at.multiplier, &mut residuals.dual);
        for (i, primal) in residuals.primal.iter_mut().enumerate() {
            *primal = at.slack[i] - form.rhs[i];
            residuals.product[i] = at.slack[i] * at.multiplier[i];
        }
        form.add_product(x, &mut residuals.primal);
    }

    /// Factors the matrix at [`KktSystem::at`].
    pub fn factor(&mut self) {
        let [min, max] = REGULARISATION_RANGE;
        let δ = (REGULARISATION / self.at.mean_product()).clamp(min, max);
        for ((weight, s), λ) in self.weights.iter_mut().zip(&self.at.slack).zip(&self.at.multiplier) {
            *weight = 1.0 / (s / λ + δ);
        }
        match &mut self.elimination {
            Elimination::SparseLdl(sparse) => sparse.factor(&self.form, &self.weights),
            Elimination::DenseReduced(dense) => dense.factor(&self.form, &self.weights),
            Elimination::DenseKkt(dense) => dense.factor(&self.form, &self.at),
        }
    }

    /// Computes the direction for the current residuals.
    pub fn solve(&mut self) {
        let Self { form, elimination, at, residuals, direction, weights, .. } = self;
        elimination.solve(form, at, weights, residuals, direction);
    }

    /// The direction for the residuals r_d and r_p, with products on target.
    pub fn direction_for(&mut self, dual: &[f64], primal: &[f64]) -> Direction {
        self.residuals.dual.copy_from_slice(dual);
        self.residuals.primal.copy_from_slice(primal);
        self.residuals.product.fill(0.0);
        self.solve();
        self.refine();
        self.direction.clone()
    }

    /// Refines the direction iteratively while the residuals fall.
    pub fn refine(&mut self) {
        let mut last = self.set_remaining();
        for _ in 0..MAX_REFINEMENTS {
            let Self { form, elimination, at, remaining, correction, weights, .. } = self;
            elimination.solve(form, at, weights, remaining, correction);
            self.direction.add(1.0, &self.correction);
            let now = self.set_remaining();
            if now.is_nan() || now > last {
                self.direction.add(-1.0, &self.correction);
                return;
            }
            if now < REFINED_RESIDUAL && now > 0.5 * last {
                return;
            }
            last = now;
        }
    }

    /// Sets the residuals that the direction leaves; returns the largest of the two linear equations.
    fn set_remaining(&mut self) -> f64 {
        let Self { form, at, residuals, direction, remaining, .. } = self;
        remaining.dual.copy_from_slice(&residuals.dual);
        form.add_transposed_product(&direction.multiplier, &mut remaining.dual);
        for (i, primal) in remaining.primal.iter_mut().enumerate() {
            *primal = residuals.primal[i] + direction.slack[i];
        }
        form.add_product(&direction.x, &mut remaining.primal);
        for (i, product) in remaining.product.iter_mut().enumerate() {
            let (s, λ) = (at.slack[i], at.multiplier[i]);
            *product = residuals.product[i] + s * direction.multiplier[i] + λ * direction.slack[i];
        }
        remaining.max_linear()
    }
}

impl Elimination {
    fn prepare(&mut self, form: &InequalityForm) {
        if let Self::SparseLdl(sparse) = self {
            sparse.prepare(form);
        }
    }

    fn solve(
        &mut self,
        form: &InequalityForm,
        at: &RowIterate,
        weights: &[f64],
        residuals: &Residuals,
        direction: &mut Direction,
    ) {
        match self {
            Self::SparseLdl(sparse) => reduced(form, at, weights, residuals, direction, |dx| sparse.solve(dx)),
            Self::DenseReduced(dense) => reduced(form, at, weights, residuals, direction, |dx| dense.solve(dx)),
            Self::DenseKkt(dense) => dense.solve(at, residuals, direction),
        }
    }
}

/// Solves eq. 38 and 39, with `solve` for the reduced matrix.
fn reduced(
    form: &InequalityForm,
    at: &RowIterate,
    weights: &[f64],
    residuals: &Residuals,
    direction: &mut Direction,
    solve: impl FnOnce(&mut [f64]),
) {
    let Direction { x, multiplier, slack } = direction;
    // slack <- r_p - Λ^-1 r_sl
    for (i, shifted) in slack.iter_mut().enumerate() {
        *shifted = residuals.primal[i] - residuals.product[i] / at.multiplier[i];
        multiplier[i] = -weights[i] * *shifted;
    }
    for (x, r_d) in x.iter_mut().zip(&residuals.dual) {
        *x = -r_d;
    }
    form.add_transposed_product(multiplier, x);
    solve(x);
    form.add_product(x, slack);
    for (i, slack) in slack.iter_mut().enumerate() {
        multiplier[i] = weights[i] * *slack;
        *slack = -(residuals.product[i] + at.slack[i] * multiplier[i]) / at.multiplier[i];
    }
}
