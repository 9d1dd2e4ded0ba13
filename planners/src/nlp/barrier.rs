//! What the barrier parameter decides: merit, errors of the optimality conditions, and how it falls.

use super::iterate::{Iterate, Sides};
use super::newton::{Values, largest};
use super::program::Program;
use super::solution::Settings;

/// Multipliers above this mean scale the errors down (Wächter and Biegler 2006, eq. 5).
const S_MAX: f64 = 100.0;

/// μ falls when the error of the barrier problem is below this multiple of it (ibid., eq. 7 and 8).
const Κ_ERROR: f64 = 10.0;
const Κ_FALL: f64 = 0.2;
const Θ_FALL: f64 = 1.5;

/// Errors of the optimality conditions.
#[derive(Clone, Copy, Debug)]
pub struct Errors {
    /// Dual residual over its scale.
    pub dual: f64,
    /// Largest violation of a row.
    pub violation: f64,
    /// Scale of the products.
    pub product_scale: f64,
    /// Smallest and largest product of slack and dual.
    pub products: (f64, f64),
}

impl Errors {
    /// At `point`, where `program` has been linearised; `work` is as long as x.
    pub fn at(program: &impl Program, sides: &Sides, point: &Iterate, values: &Values, work: &mut [f64]) -> Self {
        let bounds = sides.0.len();
        work.copy_from_slice(&values.gradient);
        program.add_transposed(&point.y, &point.dual[bounds..], work);
        for (side, dual) in sides.0.iter().zip(&point.dual) {
            work[side.index] -= side.sign * dual;
        }
        let sum_dual: f64 = point.dual.iter().sum();
        let sum_y: f64 = point.y.iter().map(|y| y.abs()).sum();
        let mean = |sum: f64, count: usize| (sum / count.max(1) as f64).max(S_MAX) / S_MAX;
        let products = point.slack.iter().zip(&point.dual).map(|(s, v)| s * v);
        Self {
            dual: largest(work) / mean(sum_y + sum_dual, point.y.len() + point.dual.len()),
            violation: excess(point, bounds, values).fold(largest(&values.c), |max, e| if e <= max { max } else { e }),
            product_scale: mean(sum_dual, point.dual.len()),
            products: products.fold((f64::INFINITY, 0.0), |(min, max), p| (min.min(p), max.max(p))),
        }
    }

    /// Error of the optimality conditions with products measured against μ.
    pub fn total(&self, μ: f64) -> f64 {
        let off_path = (self.products.1 - μ).max(μ - self.products.0.min(μ)) / self.product_scale;
        self.dual.max(self.violation).max(off_path)
    }
}

fn excess<'a>(point: &'a Iterate, bounds: usize, values: &'a Values) -> impl Iterator<Item = f64> + 'a {
    values.d.iter().zip(&point.slack[bounds..]).map(|(d, s)| (d - s).abs())
}

/// θ: the sum of all violations.
pub fn violation(point: &Iterate, bounds: usize, values: &Values) -> f64 {
    values.c.iter().map(|c| c.abs()).sum::<f64>() + excess(point, bounds, values).sum::<f64>()
}

/// φ = f - μ Σ ln s.
pub fn merit(objective: f64, slack: &[f64], μ: f64) -> f64 {
    // the logarithm of a product of eight costs one logarithm; slacks are far from the ends of the exponent's range
    let logarithms: f64 = slack.chunks(8).map(|chunk| chunk.iter().product::<f64>().ln()).sum();
    objective - μ * logarithms
}

/// The next barrier parameter, which is `μ` itself while the point is far from the central path.
pub fn next(μ: f64, errors: &Errors, settings: &Settings) -> f64 {
    let mut μ = μ;
    let least = settings.tolerance / (Κ_ERROR + 1.0);
    while μ > least && errors.total(μ) <= Κ_ERROR * μ {
        μ = (Κ_FALL * μ).min(μ.powf(Θ_FALL)).max(least);
    }
    μ
}
