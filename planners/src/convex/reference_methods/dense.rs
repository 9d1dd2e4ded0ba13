//! Methods II and III of the paper: the reduced matrix and the KKT matrix as dense matrices.
//!
//! The paper inverts them (2.67 n^3). Here they are factored (n^3/3 and 2 n^3/3): the explicit inverse of the reduced
//! matrix loses so much accuracy near the solution that most subproblems end short of a tolerance of 1e-8.

use faer::linalg::solvers::{Ldlt, PartialPivLu, Solve};
use faer::{ColMut, Mat, Side};

use super::inequality_form::InequalityForm;
use super::kkt_vectors::{Direction, Residuals, RowIterate};

/// Method II: dense LDL^T of A^T (S^-1 Λ) A, n_X x n_X.
#[derive(Clone, Debug)]
pub struct DenseReduced {
    /// `None` before the first factorisation and after one that failed.
    factors: Option<Ldlt<f64>>,
}

impl DenseReduced {
    /// A solver without factors.
    pub fn new() -> Self {
        Self { factors: None }
    }

    /// Factors A^T diag(weights) A.
    pub fn factor(&mut self, form: &InequalityForm, weights: &[f64]) {
        let mut matrix = Mat::<f64>::zeros(form.n_x(), form.n_x());
        for (row, weight) in weights.iter().enumerate() {
            for (j, right) in form.row(row) {
                for (i, left) in form.row(row) {
                    matrix[(i, j)] += weight * left * right;
                }
            }
        }
        self.factors = matrix.ldlt(Side::Lower).ok();
    }

    /// `x <- matrix^-1 x`; NaN without factors, so that the loop ends as stalled.
    pub fn solve(&self, x: &mut [f64]) {
        match &self.factors {
            Some(factors) => factors.solve_in_place(ColMut::from_slice_mut(x)),
            None => x.fill(f64::NAN),
        }
    }
}

/// Method III: dense LU of the KKT matrix, (n_X + 2 n_A) x (n_X + 2 n_A), in the unknowns (dX, dλ, ds):
///
/// ```text
/// [ 0  A^T  0 ]
/// [ A   0   I ]
/// [ 0   S   Λ ]        each row of this block divided by s + λ
/// ```
#[derive(Clone, Debug)]
pub struct DenseKkt {
    /// `None` before the first factorisation.
    factors: Option<PartialPivLu<f64>>,
    solution: Vec<f64>,
}

impl DenseKkt {
    /// A solver without factors.
    pub fn new() -> Self {
        Self { factors: None, solution: Vec::new() }
    }

    /// Factors the matrix at `at`.
    pub fn factor(&mut self, form: &InequalityForm, at: &RowIterate) {
        let (n_x, n_a) = (form.n_x(), form.n_a());
        let mut matrix = Mat::<f64>::zeros(n_x + 2 * n_a, n_x + 2 * n_a);
        for row in 0..n_a {
            let (λ, s) = (n_x + row, n_x + n_a + row);
            for (column, value) in form.row(row) {
                matrix[(column, λ)] = value;
                matrix[(n_x + row, column)] = value;
            }
            matrix[(n_x + row, s)] = 1.0;
            let scale = 1.0 / (at.slack[row] + at.multiplier[row]);
            matrix[(n_x + n_a + row, λ)] = scale * at.slack[row];
            matrix[(n_x + n_a + row, s)] = scale * at.multiplier[row];
        }
        self.factors = Some(matrix.partial_piv_lu());
    }

    /// Computes the direction for `residuals`; NaN before the first factorisation.
    pub fn solve(&mut self, at: &RowIterate, residuals: &Residuals, direction: &mut Direction) {
        let scaled = residuals.product.iter().zip(at.slack.iter().zip(&at.multiplier)).map(|(r, (s, λ))| r / (s + λ));
        let all = residuals.dual.iter().chain(&residuals.primal).copied().chain(scaled);
        self.solution.clear();
        self.solution.extend(all.map(|residual| -residual));
        match &self.factors {
            Some(factors) => factors.solve_in_place(ColMut::from_slice_mut(&mut self.solution)),
            None => self.solution.fill(f64::NAN),
        }
        let (x, rest) = self.solution.split_at(direction.x.len());
        let (multiplier, slack) = rest.split_at(direction.multiplier.len());
        direction.x.copy_from_slice(x);
        direction.multiplier.copy_from_slice(multiplier);
        direction.slack.copy_from_slice(slack);
    }
}
