//! The barrier problem: its objective, its optimality error, and the update of the barrier parameter μ.

use super::iterate::{Bounds, Iterate};
use super::newton::{Values, max_norm};
use super::program::Program;
use super::solution::Settings;

/// Mean multiplier from which the errors are scaled down (Wächter and Biegler 2006, after eq. 6).
const S_MAX: f64 = 100.0;

/// Constants of the update of μ (ibid., eq. 7 and step A-3): κ_ε, κ_μ and θ_μ.
const Κ_EPSILON: f64 = 10.0;
const Κ_MU: f64 = 0.2;
const Θ_MU: f64 = 1.5;

/// Errors of the optimality conditions.
#[derive(Clone, Copy, Debug)]
pub struct OptimalityErrors {
    /// Dual infeasibility over its scale s_d, max norm.
    pub dual: f64,
    /// Constraint violation, max norm.
    pub violation: f64,
    /// Scale s_c of the complementarity products.
    pub product_scale: f64,
    /// Smallest and largest complementarity product.
    pub products: (f64, f64),
}

impl OptimalityErrors {
    /// Errors at `point`, where `program` has been linearised; `work` has the length of x.
    pub fn at(program: &impl Program, bounds: &Bounds, point: &Iterate, values: &Values, work: &mut [f64]) -> Self {
        let bound_count = bounds.0.len();
        work.copy_from_slice(&values.gradient);
        program.add_jacobian_transposed(&point.y, &point.dual[bound_count..], work);
        for (bound, dual) in bounds.0.iter().zip(&point.dual) {
            work[bound.index] -= bound.sign * dual;
        }
        let sum_dual: f64 = point.dual.iter().sum();
        let sum_y: f64 = point.y.iter().map(|y| y.abs()).sum();
        let scale = |sum: f64, count: usize| (sum / count.max(1) as f64).max(S_MAX) / S_MAX;
        let products = point.slack.iter().zip(&point.dual).map(|(s, v)| s * v);
        let d_violation = slack_residuals(point, bound_count, values);
        Self {
            dual: max_norm(work) / scale(sum_y + sum_dual, point.y.len() + point.dual.len()),
            violation: d_violation.fold(max_norm(&values.c), |max, e| if e <= max { max } else { e }),
            product_scale: scale(sum_dual, point.dual.len()),
            products: products.fold((f64::INFINITY, 0.0), |(min, max), p| (min.min(p), max.max(p))),
        }
    }

    /// Scaled error of the barrier problem (Wächter and Biegler 2006, eq. 5):
    ///
    /// ```text
    /// E_μ = max( ||∇L||/s_d, ||(c, d - s)||, ||S v - μ e||/s_c )
    /// ```
    pub fn total(&self, μ: f64) -> f64 {
        let complementarity = (self.products.1 - μ).max(μ - self.products.0.min(μ)) / self.product_scale;
        self.dual.max(self.violation).max(complementarity)
    }
}

/// `|d - s|`, one per inequality.
fn slack_residuals<'a>(point: &'a Iterate, bound_count: usize, values: &'a Values) -> impl Iterator<Item = f64> + 'a {
    values.d.iter().zip(&point.slack[bound_count..]).map(|(d, s)| (d - s).abs())
}

/// `θ = ||c||_1 + ||d - s||_1`.
pub fn constraint_violation(point: &Iterate, bound_count: usize, values: &Values) -> f64 {
    values.c.iter().map(|c| c.abs()).sum::<f64>() + slack_residuals(point, bound_count, values).sum::<f64>()
}

/// `φ = f - μ Σ ln s`.
pub fn barrier_objective(objective: f64, slack: &[f64], μ: f64) -> f64 {
    // one logarithm per product of eight slacks; slacks are far from the ends of the exponent's range
    let logarithms: f64 = slack.chunks(8).map(|chunk| chunk.iter().product::<f64>().ln()).sum();
    objective - μ * logarithms
}

/// The next barrier parameter: `μ` itself as long as `E_μ > κ_ε μ`, then
///
/// ```text
/// μ <- max( μ_min, min(κ_μ μ, μ^θ_μ) )                                       [Wächter and Biegler 2006, eq. 7]
/// ```
pub fn next_barrier(μ: f64, errors: &OptimalityErrors, settings: &Settings) -> f64 {
    let mut μ = μ;
    let μ_min = settings.tolerance / (Κ_EPSILON + 1.0);
    while μ > μ_min && errors.total(μ) <= Κ_EPSILON * μ {
        μ = (Κ_MU * μ).min(μ.powf(Θ_MU)).max(μ_min);
    }
    μ
}
