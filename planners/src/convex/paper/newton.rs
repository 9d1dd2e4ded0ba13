//! Newton directions of P4 (eq. 24 to 29, 38, 39).
//!
//! ```text
//! A^T dλ           = -r_d
//! A dX + ds        = -r_p
//! S dλ + Λ ds      = -r_sl
//! ```
//!
//! Eliminating ds and then dλ leaves the reduced system:
//!
//! ```text
//! [A^T (S^-1 Λ) A] dX = -r_d - A^T S^-1 (Λ r_p - r_sl)
//! dλ = (S^-1 Λ)(A dX + r_p - Λ^-1 r_sl)
//! ds = -Λ^-1 (r_sl + S dλ)
//! ```

use super::dense::{DenseKkt, DenseReduced};
use super::form::PaperForm;
use super::sparse_ldl::SparseLdl;

/// Divided by the mean product and added to every s/λ in the reduced systems: it bounds the weights, so that rows that hold
/// exactly do not swallow the soft directions, which grow softer as the products fall. Refinement makes up for it.
const REGULARISATION: f64 = 1e-13;

/// Least and most that is added.
const REGULARISATION_RANGE: [f64; 2] = [1e-12, 1e-4];

/// Most refinements of one direction; they end before, as soon as one does not help.
const REFINEMENTS: usize = 15;

/// Remainder of the linear equations below which a refinement has to help much: by half.
const REFINED: f64 = 1e-14;

/// How the linear system is solved: the three methods of the paper's Table 1.
#[derive(Clone, Debug)]
pub enum Elimination {
    /// Method I.
    SparseLdl(SparseLdl),
    /// Method II.
    DenseReduced(DenseReduced),
    /// Method III.
    DenseKkt(DenseKkt),
}

/// Slacks s and multipliers λ of the rows of P4 at an iterate, all > 0.
#[derive(Clone, Debug)]
pub struct Iterate {
    /// s.
    pub slack: Vec<f64>,
    /// λ.
    pub multiplier: Vec<f64>,
}

/// r_d (length n_X), r_p and r_sl (length n_A).
#[derive(Clone, Debug)]
pub struct Residuals {
    /// g + A^T λ.
    pub dual: Vec<f64>,
    /// s + A X - b.
    pub primal: Vec<f64>,
    /// S Λ e, less what the corrector aims at.
    pub product: Vec<f64>,
}

/// dX (length n_X), dλ and ds (length n_A).
#[derive(Clone, Debug)]
pub struct Direction {
    /// dX.
    pub x: Vec<f64>,
    /// dλ.
    pub multiplier: Vec<f64>,
    /// ds.
    pub slack: Vec<f64>,
}

/// The Newton system of P4 at one iterate.
#[derive(Clone, Debug)]
pub struct PaperNewton {
    form: PaperForm,
    elimination: Elimination,
    /// Where the matrix was factored.
    pub at: Iterate,
    /// Right-hand sides, negative.
    pub residuals: Residuals,
    /// The direction that was found last.
    pub direction: Direction,
    /// 1/(s/λ + δ): the weights S^-1 Λ of the rows.
    weights: Vec<f64>,
    remainder: Residuals,
    correction: Direction,
}

impl PaperNewton {
    /// Room for `form`.
    pub fn new(form: PaperForm, elimination: Elimination) -> Self {
        let (n_x, n_a) = (form.n_x(), form.n_a());
        let residuals = Residuals { dual: vec![0.0; n_x], primal: vec![0.0; n_a], product: vec![0.0; n_a] };
        let direction = Direction { x: vec![0.0; n_x], multiplier: vec![0.0; n_a], slack: vec![0.0; n_a] };
        Self {
            form,
            elimination,
            at: Iterate { slack: vec![0.0; n_a], multiplier: vec![0.0; n_a] },
            residuals: residuals.clone(),
            direction: direction.clone(),
            weights: vec![0.0; n_a],
            remainder: residuals,
            correction: direction,
        }
    }

    /// Another programme, of whatever shape; what depends on the shape alone is kept if that is the same.
    pub fn set_form(&mut self, form: PaperForm) {
        if form.n_x() == self.form.n_x() && form.n_a() == self.form.n_a() {
            self.elimination.prepare(&form);
            self.form = form;
        } else {
            let mut elimination = self.elimination.clone();
            elimination.prepare(&form);
            *self = Self::new(form, elimination);
        }
    }

    /// Factors the matrix at [`PaperNewton::at`].
    pub fn factor(&mut self) {
        let [least, most] = REGULARISATION_RANGE;
        let δ = (REGULARISATION / self.at.mean_product()).clamp(least, most);
        for ((weight, s), λ) in self.weights.iter_mut().zip(&self.at.slack).zip(&self.at.multiplier) {
            *weight = 1.0 / (s / λ + δ);
        }
        match &mut self.elimination {
            Elimination::SparseLdl(sparse) => sparse.factor(&self.form, &self.weights),
            Elimination::DenseReduced(dense) => dense.factor(&self.form, &self.weights),
            Elimination::DenseKkt(dense) => dense.factor(&self.form, &self.at),
        }
    }

    /// The direction for the present residuals.
    pub fn solve(&mut self) {
        let Self { form, elimination, at, residuals, direction, weights, .. } = self;
        elimination.solve(form, at, weights, residuals, direction);
    }

    /// Solves for what the direction leaves of the three equations, again and again while that helps.
    pub fn refine(&mut self) {
        let mut last = self.set_remainder();
        for _ in 0..REFINEMENTS {
            let Self { form, elimination, at, remainder, correction, weights, .. } = self;
            elimination.solve(form, at, weights, remainder, correction);
            self.direction.add(1.0, &self.correction);
            let now = self.set_remainder();
            if now.is_nan() || now > last {
                self.direction.add(-1.0, &self.correction);
                return;
            }
            if now < REFINED && now > 0.5 * last {
                return;
            }
            last = now;
        }
    }

    /// What the direction leaves of the three equations; returns the largest of the two linear ones.
    fn set_remainder(&mut self) -> f64 {
        let Self { form, at, residuals, direction, remainder, .. } = self;
        remainder.dual.copy_from_slice(&residuals.dual);
        form.add_transposed_product(&direction.multiplier, &mut remainder.dual);
        for (i, primal) in remainder.primal.iter_mut().enumerate() {
            *primal = residuals.primal[i] + direction.slack[i];
        }
        form.add_product(&direction.x, &mut remainder.primal);
        for (i, product) in remainder.product.iter_mut().enumerate() {
            let (s, λ) = (at.slack[i], at.multiplier[i]);
            *product = residuals.product[i] + s * direction.multiplier[i] + λ * direction.slack[i];
        }
        remainder.largest()
    }
}

impl Elimination {
    fn prepare(&mut self, form: &PaperForm) {
        if let Self::SparseLdl(sparse) = self {
            sparse.prepare(form);
        }
    }

    fn solve(
        &mut self,
        form: &PaperForm,
        at: &Iterate,
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

/// Eq. 38 and 39, with `solve` for the reduced matrix.
fn reduced(
    form: &PaperForm,
    at: &Iterate,
    weights: &[f64],
    residuals: &Residuals,
    direction: &mut Direction,
    solve: impl FnOnce(&mut [f64]),
) {
    let Direction { x, multiplier, slack } = direction;
    // r_p - Λ^-1 r_sl, in the place of ds
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

impl Iterate {
    /// μ = λ^T s / n_A.
    fn mean_product(&self) -> f64 {
        let products = self.slack.iter().zip(&self.multiplier).map(|(s, λ)| s * λ);
        products.sum::<f64>() / self.slack.len() as f64
    }
}

impl Residuals {
    /// Largest absolute value of the two linear equations; NaN if one is.
    fn largest(&self) -> f64 {
        let all = self.dual.iter().chain(&self.primal);
        all.fold(0.0, |max, value| if value.is_nan() || value.abs() > max { value.abs() } else { max })
    }
}

impl Direction {
    fn add(&mut self, factor: f64, other: &Self) {
        let pairs =
            [(&mut self.x, &other.x), (&mut self.multiplier, &other.multiplier), (&mut self.slack, &other.slack)];
        for (values, increments) in pairs {
            for (value, increment) in values.iter_mut().zip(increments) {
                *value += factor * increment;
            }
        }
    }
}
