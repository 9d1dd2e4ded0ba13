//! The ties that keep every iterate feasible: differences of forces that follow from everything else.

use super::batch::Batch;
use super::iterate::{Iterate, Variable, link_values};
use super::lanes::{Lanes, Vector};

/// What the loop wants to know of an iterate.
#[derive(Clone, Copy, Debug)]
pub struct Measures<S: Vector> {
    /// Sum of all complementarity products: the duality gap.
    pub products: Lanes<S>,
    /// q θ + μ (violations).
    pub objective: Lanes<S>,
}

/// Restores every difference of forces at `at`: slacks fit z, duals fit the multipliers.
#[inline(always)]
pub fn tie<S: Vector>(batch: &Batch<S>, at: &mut Iterate<S>) -> Measures<S> {
    let mut products = Lanes::splat(batch.simd, 0.0);
    let mut violations = products;
    at.set_dual(batch);
    for k in 0..batch.intervals() {
        let values = link_values(batch, &at.z, k);
        for (boxed, value) in at.links[k].iter_mut().zip(values) {
            boxed.tie_forces(value);
            products += boxed.products();
            violations += boxed.force_above + boxed.force_below;
        }
    }
    for (boxed, (index, value)) in at.pins.iter_mut().zip(&batch.pins) {
        boxed.tie_forces(at.z[*index] - *value);
        products += boxed.products();
        violations += boxed.force_above + boxed.force_below;
    }
    for (boxed, plane) in at.planes.iter_mut().zip(&batch.planes) {
        boxed.tie_forces(plane.value(&at.z) - plane.bound);
        products += boxed.products() * plane.present;
        violations += boxed.force_above * plane.present;
    }
    let values = at.z.iter().zip(&at.dual).zip(&batch.bounds);
    for (variable, ((&z, &dual), bounds)) in at.variables.iter_mut().zip(values) {
        let Variable { trust, upper, lower } = variable;
        trust.tie_forces(-dual);
        upper.tie_forces(z - bounds.soft_upper);
        lower.tie_forces(bounds.soft_lower - z);
        products += trust.products() + (upper.products() + lower.products());
        violations += upper.force_above + lower.force_above;
    }
    Measures { products, objective: batch.theta_cost * at.z[at.z.len() - 1] + batch.penalty * violations }
}
