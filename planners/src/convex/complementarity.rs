//! A quantity between two bounds, with the dual of each bound: two complementarity conditions that share one step.
//!
//! ```text
//! x in [lo, hi]        a = hi - x  ⟂  c        b = x - lo  ⟂  d        a, b, c, d >= 0
//! ```
//!
//! There are two kinds of bounded quantities:
//! - a variable z_i in its trust region; c and d are the duals v_u, v_l, with v_l - v_u = (q e + E^T y + F^T λ)_i;
//! - the multiplier of an elastic row, bounded by the penalty, y in [-μ, μ] or λ in [0, μ]; c and d are the elastic
//!   slacks of the row, p and n or β and t, with p - n = (E z - d)_i and β - t = (F z - g)_i.
//!
//! In both, the sum a + b is constant, and the difference c - d is a linear function of the other unknowns. Both are
//! restored to rounding after every step: the smaller of the two numbers is kept, the larger follows from it. Every
//! iterate is therefore feasible, and the sum of the products a c + b d is its duality gap.

use super::program::MAX_PLAIN_WEIGHT;
use crate::simd::{Lanes, Mask, Simd4};

/// The two complementarity conditions of one bounded quantity, with the coefficients of the current Newton step.
#[derive(Clone, Copy, Debug)]
pub struct ComplementarityPair<S: Simd4> {
    /// a = hi - x, > 0.
    pub slack_upper: Lanes<S>,
    /// b = x - lo, > 0.
    pub slack_lower: Lanes<S>,
    /// c, the dual of the upper bound, > 0.
    pub dual_upper: Lanes<S>,
    /// d, the dual of the lower bound, > 0.
    pub dual_lower: Lanes<S>,
    /// (b - a)/2 = x - (lo + hi)/2. Between bounds that are far apart it resolves an x that a and b would round.
    pub offset: Lanes<S>,
    /// 1/a.
    inverse_upper: Lanes<S>,
    /// 1/b.
    inverse_lower: Lanes<S>,
    /// r_c/a, with the target r_c of the step: c da + a dc = r_c.
    target_upper: Lanes<S>,
    /// r_d/b, with the target r_d of the step: d db + b dd = r_d.
    target_lower: Lanes<S>,
}

/// Largest relative decreases along a step: max -da/a, -db/b and max -dc/c, -dd/d, at least 0.
#[derive(Clone, Copy, Debug)]
pub struct RelativeDecrease<S: Simd4> {
    /// Of the slacks a and b.
    pub slack: Lanes<S>,
    /// Of the duals c and d.
    pub dual: Lanes<S>,
}

/// Sums and largest relative decreases over many pairs along an affine step (targets -a c and -b d).
#[derive(Clone, Copy, Debug)]
pub struct AffineSummary<S: Simd4> {
    /// Largest relative decreases.
    pub decrease: RelativeDecrease<S>,
    /// Σ a c + b d.
    pub products: Lanes<S>,
    /// Σ (c - d) dx.
    pub first: Lanes<S>,
    /// Σ (c/a + d/b) dx².
    pub second: Lanes<S>,
}

/// A quantity accumulated over the steps of many pairs.
pub trait Accumulator<S: Simd4>: Copy {
    /// Accumulates the step `dx` of `pair`.
    fn add(&mut self, pair: &ComplementarityPair<S>, dx: Lanes<S>);

    /// `yes` in the lanes of `mask`, `no` in the others.
    fn select(mask: Mask<S>, yes: Self, no: Self) -> Self;
}

impl<S: Simd4> ComplementarityPair<S> {
    /// The centre of a box of half-width `half`, with duals for which both products are τ.
    #[inline(always)]
    pub fn central(half: Lanes<S>, τ: Lanes<S>) -> Self {
        let dual = τ.over(half);
        Self::new(half, half, dual, dual)
    }

    /// The pair with slacks a, b and duals c, d; weights and targets are not yet set.
    #[inline(always)]
    pub fn new(slack_upper: Lanes<S>, slack_lower: Lanes<S>, dual_upper: Lanes<S>, dual_lower: Lanes<S>) -> Self {
        let zero = slack_upper.like(0.0);
        let (inverse_upper, inverse_lower, target_upper, target_lower) = (zero, zero, zero, zero);
        Self {
            slack_upper,
            slack_lower,
            dual_upper,
            dual_lower,
            offset: (slack_lower - slack_upper) * zero.like(0.5),
            inverse_upper,
            inverse_lower,
            target_upper,
            target_lower,
        }
    }

    /// a c + b d.
    #[inline(always)]
    pub fn products(&self) -> Lanes<S> {
        self.slack_upper * self.dual_upper + self.slack_lower * self.dual_lower
    }

    /// The weight c/a + d/b. Stores 1/a and 1/b for the steps that follow.
    #[inline(always)]
    pub fn compute_weight(&mut self) -> Lanes<S> {
        let inverse = (self.slack_upper * self.slack_lower).recip();
        self.inverse_upper = self.slack_lower * inverse;
        self.inverse_lower = self.slack_upper * inverse;
        self.dual_upper * self.inverse_upper + self.dual_lower * self.inverse_lower
    }

    /// Sets the targets of the affine step, products of zero; returns ρ.
    #[inline(always)]
    pub fn set_zero_target(&mut self) -> Lanes<S> {
        self.target_upper = -self.dual_upper;
        self.target_lower = -self.dual_lower;
        self.ρ()
    }

    /// Sets the targets of the centred step, products of σμ, with Mehrotra's correction for the affine step `dx`;
    /// returns ρ.
    ///
    /// ```text
    /// r_c = σμ - a c - da_aff dc_aff,    da_aff = -dx,   dc_aff = -c + c dx/a
    /// r_d = σμ - b d - db_aff dd_aff,    db_aff =  dx,   dd_aff = -d - d dx/b
    /// ```
    #[inline(always)]
    pub fn set_target(&mut self, σμ: Lanes<S>, dx: Lanes<S>) -> Lanes<S> {
        let (q_a, q_b) = (dx * self.inverse_upper, dx * self.inverse_lower);
        let (c, d) = (self.dual_upper, self.dual_lower);
        self.target_upper = σμ * self.inverse_upper - c - c * (q_a - q_a * q_a);
        self.target_lower = σμ * self.inverse_lower - d + d * (q_b + q_b * q_b);
        self.ρ()
    }

    /// ρ = r_c/a - r_d/b of the current targets.
    #[inline(always)]
    pub fn ρ(&self) -> Lanes<S> {
        self.target_upper - self.target_lower
    }

    /// The current targets r_c and r_d.
    #[inline(always)]
    pub fn targets(&self) -> [Lanes<S>; 2] {
        [self.target_upper * self.slack_upper, self.target_lower * self.slack_lower]
    }

    /// (dc, dd) of the step `dx`: (r_c + c dx)/a and (r_d - d dx)/b.
    #[inline(always)]
    fn dual_steps(&self, dx: Lanes<S>) -> [Lanes<S>; 2] {
        let upper = self.target_upper + self.dual_upper * (dx * self.inverse_upper);
        let lower = self.target_lower - self.dual_lower * (dx * self.inverse_lower);
        [upper, lower]
    }

    /// dc - dd of the step `dx`.
    #[inline(always)]
    pub fn dual_difference_step(&self, dx: Lanes<S>) -> Lanes<S> {
        let [dc, dd] = self.dual_steps(dx);
        dc - dd
    }

    /// Moves the slacks by `α_slack` times their step, the duals by `α_dual` times theirs, and restores a + b =
    /// `width`. c - d is restored by [`ComplementarityPair::restore_dual_difference`], once its value is known.
    #[inline(always)]
    pub fn advance(&mut self, dx: Lanes<S>, α_slack: Lanes<S>, α_dual: Lanes<S>, width: Lanes<S>) {
        let [dc, dd] = self.dual_steps(dx);
        self.dual_upper += α_dual * dc;
        self.dual_lower += α_dual * dd;
        let (upper, lower) = (self.slack_upper - α_slack * dx, self.slack_lower + α_slack * dx);
        let offset = self.offset + α_slack * dx;
        let is_nearer_upper = lower.is_above(upper);
        self.slack_upper = is_nearer_upper.select(upper, width - lower);
        self.slack_lower = is_nearer_upper.select(width - upper, lower);
        self.restore_offset(offset, width * offset.like(0.5));
    }

    /// Restores (b - a)/2 = offset with the bounds `half` away from 0: of a, b and |offset| the smallest is kept.
    #[inline(always)]
    fn restore_offset(&mut self, offset: Lanes<S>, half: Lanes<S>) {
        let nearest = self.slack_upper.min(self.slack_lower);
        // 0 where the bounds are near enough to resolve every x between them
        let reach = half.is_above(half.like(MAX_PLAIN_WEIGHT)).select(nearest, half.like(0.0));
        let is_central = reach.is_above(offset.abs());
        self.slack_upper = is_central.select(half - offset, self.slack_upper);
        self.slack_lower = is_central.select(half + offset, self.slack_lower);
        let between = (self.slack_lower - self.slack_upper) * half.like(0.5);
        self.offset = is_central.select(offset, between);
    }

    /// Restores c - d = `difference`; the smaller of the two is kept.
    #[inline(always)]
    pub fn restore_dual_difference(&mut self, difference: Lanes<S>) {
        let is_upper_larger = difference.is_above(difference.like(0.0));
        let (c, d) = (self.dual_upper, self.dual_lower);
        self.dual_upper = is_upper_larger.select(d + difference, c);
        self.dual_lower = is_upper_larger.select(d, c - difference);
    }
}

impl<S: Simd4> RelativeDecrease<S> {
    /// No decrease.
    #[inline(always)]
    pub fn zero(simd: S) -> Self {
        Self { slack: Lanes::splat(simd, 0.0), dual: Lanes::splat(simd, 0.0) }
    }
}

impl<S: Simd4> Accumulator<S> for RelativeDecrease<S> {
    #[inline(always)]
    fn add(&mut self, pair: &ComplementarityPair<S>, dx: Lanes<S>) {
        let (q_a, q_b) = (dx * pair.inverse_upper, dx * pair.inverse_lower);
        self.slack = q_a.max((-q_b).max(self.slack));
        let [dc, dd] = pair.dual_steps(dx);
        let inverse = (pair.dual_upper * pair.dual_lower).recip();
        self.dual = (-dc * pair.dual_lower * inverse).max(self.dual);
        self.dual = (-dd * pair.dual_upper * inverse).max(self.dual);
    }

    #[inline(always)]
    fn select(mask: Mask<S>, yes: Self, no: Self) -> Self {
        Self { slack: mask.select(yes.slack, no.slack), dual: mask.select(yes.dual, no.dual) }
    }
}

impl<S: Simd4> AffineSummary<S> {
    /// The summary of no pairs.
    #[inline(always)]
    pub fn zero(simd: S) -> Self {
        let zero = Lanes::splat(simd, 0.0);
        Self { decrease: RelativeDecrease::zero(simd), products: zero, first: zero, second: zero }
    }

    /// Σ of the products after `α_slack` and `α_dual` of the step:
    ///
    /// ```text
    /// Σ (a - α_slack dx)(c + α_dual dc) + (b + α_slack dx)(d + α_dual dd)
    /// ```
    #[inline(always)]
    pub fn products_after(&self, α_slack: Lanes<S>, α_dual: Lanes<S>) -> Lanes<S> {
        let rest = α_dual.like(1.0) - α_dual;
        rest * self.products + (α_dual - α_slack * rest) * self.first - α_slack * α_dual * self.second
    }
}

impl<S: Simd4> Accumulator<S> for AffineSummary<S> {
    /// Accumulates the affine step `dx` of `pair`: dc/c = -1 + dx/a and dd/d = -1 - dx/b.
    #[inline(always)]
    fn add(&mut self, pair: &ComplementarityPair<S>, dx: Lanes<S>) {
        let (q_a, q_b) = (dx * pair.inverse_upper, dx * pair.inverse_lower);
        let (c, d, one) = (pair.dual_upper, pair.dual_lower, dx.like(1.0));
        self.decrease.slack = q_a.max((-q_b).max(self.decrease.slack));
        self.decrease.dual = (one - q_a).max((one + q_b).max(self.decrease.dual));
        self.products += pair.products();
        self.first += (c - d) * dx;
        self.second += (c * q_a + d * q_b) * dx;
    }

    #[inline(always)]
    fn select(mask: Mask<S>, yes: Self, no: Self) -> Self {
        Self {
            decrease: RelativeDecrease::select(mask, yes.decrease, no.decrease),
            products: mask.select(yes.products, no.products),
            first: mask.select(yes.first, no.first),
            second: mask.select(yes.second, no.second),
        }
    }
}

#[cfg(test)]
mod tests {
    use pulp::Scalar256b;

    use super::{ComplementarityPair, Lanes};

    /// Its distances to the bounds, 1e6 ± 1/3, would round it to 1e-10.
    #[test]
    fn a_small_multiplier_between_distant_bounds_keeps_its_digits() {
        let lanes = |value| Lanes::splat(Scalar256b, value);
        let half = 1e6;
        let mut pair = ComplementarityPair::central(lanes(half), lanes(1.0));
        pair.compute_weight();
        pair.set_zero_target();
        pair.advance(lanes(1.0 / 3.0), lanes(1.0), lanes(0.0), lanes(2.0 * half));
        assert_eq!(pair.offset.lane(0), 1.0 / 3.0);
        assert_eq!(pair.slack_lower.lane(0), half + 1.0 / 3.0);
        // beyond the middle between 0 and a bound the distance to the bound counts
        pair.advance(lanes(0.75 * half), lanes(1.0), lanes(0.0), lanes(2.0 * half));
        assert!((pair.offset.lane(0) - (half - pair.slack_upper.lane(0))).abs() < 1e-9);
    }
}
