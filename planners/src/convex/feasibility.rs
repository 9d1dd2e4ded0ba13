//! Restores the linear equations after a step, so that every iterate is feasible.

use super::batch::Batch;
use super::iterate::{Iterate, Variable, dynamics_residuals};
use crate::simd::{Lanes, Simd4};

/// Duality gap and objective of an iterate.
#[derive(Clone, Copy, Debug)]
pub struct Measures<S: Simd4> {
    /// Sum of all complementarity products: the duality gap.
    pub products: Lanes<S>,
    /// q θ + μ (violations).
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
        for (pair, value) in at.dynamics[k].iter_mut().zip(values) {
            pair.restore_dual_difference(value);
            products += pair.products();
            violations += pair.dual_upper + pair.dual_lower;
        }
    }
    for (pair, (index, value)) in at.fixed_variables.iter_mut().zip(&batch.fixed_variables) {
        pair.restore_dual_difference(at.z[*index] - *value);
        products += pair.products();
        violations += pair.dual_upper + pair.dual_lower;
    }
    for (pair, halfspace) in at.halfspaces.iter_mut().zip(&batch.halfspaces) {
        pair.restore_dual_difference(halfspace.value(&at.z) - halfspace.bound);
        products += pair.products() * halfspace.present;
        violations += pair.dual_upper * halfspace.present;
    }
    let values = at.z.iter().zip(&at.dual).zip(&batch.bounds);
    for (variable, ((&z, &dual), bounds)) in at.variables.iter_mut().zip(values) {
        let Variable { trust_region, upper, lower } = variable;
        trust_region.restore_dual_difference(-dual);
        upper.restore_dual_difference(z - bounds.soft_upper);
        lower.restore_dual_difference(bounds.soft_lower - z);
        products += trust_region.products() + (upper.products() + lower.products());
        violations += upper.dual_upper + lower.dual_upper;
    }
    Measures { products, objective: batch.theta_cost * at.z[at.z.len() - 1] + batch.penalty * violations }
}
