//! Restores the linear equations after a step, so that every iterate is feasible.

use super::batch::{Batch, RowScale};
use super::complementarity::ComplementarityPair;
use super::iterate::{Iterate, Variable, dynamics_residuals};
use crate::simd::{Lanes, Simd4};

/// Duality gap and objective of an iterate.
#[derive(Clone, Copy, Debug)]
pub struct Measures<S: Simd4> {
    /// Sum of all complementarity products: the duality gap.
    pub products: Lanes<S>,
    /// q θ + μ (u · violations).
    pub objective: Lanes<S>,
}

/// Restores the difference c - d of every pair at `at`: elastic slacks match z, trust-region duals match the
/// multipliers. Returns the measures of the feasible iterate.
#[inline(always)]
pub fn restore_feasibility<S: Simd4>(batch: &Batch<S>, at: &mut Iterate<S>) -> Measures<S> {
    let mut products = Lanes::splat(batch.simd, 0.0);
    let mut violations = products;
    at.set_dual(batch);
    for k in 0..batch.intervals() {
        let values = dynamics_residuals(batch, &at.z, k);
        for ((pair, value), scale) in at.dynamics[k].iter_mut().zip(values).zip(&batch.row_scales) {
            let row = settle(pair, value, scale);
            products += row.products;
            violations += (row.dual_upper + row.dual_lower) * scale.unit;
        }
    }
    for (pair, (index, value)) in at.fixed_variables.iter_mut().zip(&batch.fixed_variables) {
        let scale = &batch.bounds[*index].row_scale;
        let row = settle(pair, at.z[*index] - *value, scale);
        products += row.products;
        violations += (row.dual_upper + row.dual_lower) * scale.unit;
    }
    for (pair, halfspace) in at.halfspaces.iter_mut().zip(&batch.halfspaces) {
        let scale = &batch.row_scales[0];
        let row = settle(pair, halfspace.value(&at.z) - halfspace.bound, scale);
        products += row.products * halfspace.present;
        violations += row.dual_upper * halfspace.present * scale.unit;
    }
    let values = at.z.iter().zip(&at.dual).zip(&batch.bounds);
    for (variable, ((&z, &dual), bounds)) in at.variables.iter_mut().zip(values) {
        let Variable { trust_region, upper, lower } = variable;
        trust_region.restore_dual_difference(-dual);
        let scale = &bounds.row_scale;
        let upper = settle(upper, z - bounds.soft_upper, scale);
        let lower = settle(lower, bounds.soft_lower - z, scale);
        products += trust_region.products() + (upper.products + lower.products);
        violations += (upper.dual_upper + lower.dual_upper) * scale.unit;
    }
    Measures { products, objective: batch.theta_cost * at.z[at.z.len() - 1] + batch.penalty * violations }
}

/// A settled row, without the rounding of its value.
struct SettledRow<S: Simd4> {
    /// a c + b d.
    products: Lanes<S>,
    /// c: the violation from above.
    dual_upper: Lanes<S>,
    /// d: the violation of an equality from below.
    dual_lower: Lanes<S>,
}

/// Restores c - d = `value` of an elastic row. The pair holds the whole value, so that the next step corrects it; what
/// is only rounding counts neither as gap nor as violation.
#[inline(always)]
fn settle<S: Simd4>(pair: &mut ComplementarityPair<S>, value: Lanes<S>, scale: &RowScale<S>) -> SettledRow<S> {
    pair.restore_dual_difference(value);
    let (c, d) = (pair.dual_upper, pair.dual_lower);
    let is_rounding = scale.resolution.is_above(value.abs());
    let smaller = c.min(d);
    let (dual_upper, dual_lower) = (is_rounding.select(smaller, c), is_rounding.select(smaller, d));
    SettledRow { products: pair.slack_upper * dual_upper + pair.slack_lower * dual_lower, dual_upper, dual_lower }
}
