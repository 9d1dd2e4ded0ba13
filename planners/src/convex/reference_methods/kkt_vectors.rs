//! Iterates, residuals and directions of P4.

/// Slacks s and multipliers λ of the rows of P4, length n_A.
#[derive(Clone, Debug)]
pub struct RowIterate {
    /// s, > 0.
    pub slack: Vec<f64>,
    /// λ, > 0.
    pub multiplier: Vec<f64>,
}

/// Residuals: r_d, length n_X; r_p and r_sl, length n_A.
#[derive(Clone, Debug)]
pub struct Residuals {
    /// g + A^T λ.
    pub dual: Vec<f64>,
    /// s + A X - b.
    pub primal: Vec<f64>,
    /// S Λ e minus the targets of the products.
    pub product: Vec<f64>,
}

/// A direction: dX, length n_X; dλ and ds, length n_A.
#[derive(Clone, Debug)]
pub struct Direction {
    /// dX.
    pub x: Vec<f64>,
    /// dλ.
    pub multiplier: Vec<f64>,
    /// ds.
    pub slack: Vec<f64>,
}

impl RowIterate {
    /// μ = λ^T s / n_A.
    pub fn mean_product(&self) -> f64 {
        let products = self.slack.iter().zip(&self.multiplier).map(|(s, λ)| s * λ);
        products.sum::<f64>() / self.slack.len() as f64
    }
}

impl Residuals {
    /// Largest absolute residual of the two linear equations; NaN if any is NaN.
    pub fn max_linear(&self) -> f64 {
        let all = self.dual.iter().chain(&self.primal);
        all.fold(0.0, |max, value| if value.is_nan() || value.abs() > max { value.abs() } else { max })
    }
}

impl Direction {
    /// `self += factor other`.
    pub fn add(&mut self, factor: f64, other: &Self) {
        let pairs =
            [(&mut self.x, &other.x), (&mut self.multiplier, &other.multiplier), (&mut self.slack, &other.slack)];
        for (values, increments) in pairs {
            for (value, increment) in values.iter_mut().zip(increments) {
                *value += factor * increment;
            }
        }
    }
}
