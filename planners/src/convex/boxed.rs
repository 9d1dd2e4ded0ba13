//! A quantity between two bounds, with a force on each of them: every complementary pair of the method is half of one.
//!
//! ```text
//! x in [lo, hi]        a = hi - x  ⟂  c        b = x - lo  ⟂  d        a, b, c, d >= 0
//! ```
//!
//! Two kinds of quantities are boxed:
//! - a variable z_i by the trust region; its forces are the duals v_u, v_l, with v_l - v_u = (q e + E^T y + F^T λ)_i;
//! - the multiplier of an elastic row by its penalty, y in [-μ, μ] or λ in [0, μ]; its forces are the row's slacks, p and n
//!   or β and t, with p - n = (E z - d)_i and β - t = (F z - g)_i.
//!
//! In both, the room a + b is fixed and the difference c - d is a linear function of everything else. Both are kept to
//! rounding at every iterate: the smaller of two stays, the larger follows from it. So every iterate is feasible, and the
//! sum of the products a c + b d is its duality gap.

use super::lanes::{Lanes, Mask, Vector};

/// One boxed quantity, and what the present iteration knows of it.
#[derive(Clone, Copy, Debug)]
pub struct Boxed<S: Vector> {
    /// a, > 0.
    pub above: Lanes<S>,
    /// b, > 0.
    pub below: Lanes<S>,
    /// c, > 0.
    pub force_above: Lanes<S>,
    /// d, > 0.
    pub force_below: Lanes<S>,
    /// 1/a.
    inverse_above: Lanes<S>,
    /// 1/b.
    inverse_below: Lanes<S>,
    /// r_c/a, for a target r_c of the step: c da + a dc = r_c.
    target_above: Lanes<S>,
    /// r_d/b, likewise.
    target_below: Lanes<S>,
}

/// Sums and largest relative changes over many boxed quantities, along an affine step (targets -a c and -b d).
#[derive(Clone, Copy, Debug)]
pub struct AffineTally<S: Vector> {
    /// Largest relative loss of room, and of force.
    pub loss: Loss<S>,
    /// Σ a c + b d.
    pub products: Lanes<S>,
    /// Σ (c - d) dx.
    pub first: Lanes<S>,
    /// Σ (c/a + d/b) dx².
    pub second: Lanes<S>,
}

/// Largest relative losses along a step: max -da/a, -db/b and max -dc/c, -dd/d, at least 0.
#[derive(Clone, Copy, Debug)]
pub struct Loss<S: Vector> {
    /// Of room.
    pub room: Lanes<S>,
    /// Of force.
    pub force: Lanes<S>,
}

impl<S: Vector> Boxed<S> {
    /// In the middle of its box of half-width `half`, with forces of which the products are τ.
    #[inline(always)]
    pub fn central(half: Lanes<S>, τ: Lanes<S>) -> Self {
        let force = τ.over(half);
        Self::new(half, half, force, force)
    }

    /// With these rooms and forces.
    #[inline(always)]
    pub fn new(above: Lanes<S>, below: Lanes<S>, force_above: Lanes<S>, force_below: Lanes<S>) -> Self {
        let zero = above.like(0.0);
        let (inverse_above, inverse_below, target_above, target_below) = (zero, zero, zero, zero);
        Self { above, below, force_above, force_below, inverse_above, inverse_below, target_above, target_below }
    }

    /// a c + b d.
    #[inline(always)]
    pub fn products(&self) -> Lanes<S> {
        self.above * self.force_above + self.below * self.force_below
    }

    /// c/a + d/b; keeps the reciprocals for the steps to come.
    #[inline(always)]
    pub fn weigh(&mut self) -> Lanes<S> {
        let inverse = (self.above * self.below).recip();
        self.inverse_above = self.below * inverse;
        self.inverse_below = self.above * inverse;
        self.force_above * self.inverse_above + self.force_below * self.inverse_below
    }

    /// Aims at products of zero; returns ρ.
    #[inline(always)]
    pub fn aim_at_zero(&mut self) -> Lanes<S> {
        self.target_above = -self.force_above;
        self.target_below = -self.force_below;
        self.ρ()
    }

    /// Aims at products of σμ, with Mehrotra's correction for the affine step `dx`; returns ρ.
    ///
    /// ```text
    /// r_c = σμ - a c - da_aff dc_aff,    da_aff = -dx,   dc_aff = -c + c dx/a
    /// r_d = σμ - b d - db_aff dd_aff,    db_aff =  dx,   dd_aff = -d - d dx/b
    /// ```
    #[inline(always)]
    pub fn aim(&mut self, σμ: Lanes<S>, dx: Lanes<S>) -> Lanes<S> {
        let (q_a, q_b) = (dx * self.inverse_above, dx * self.inverse_below);
        let (c, d) = (self.force_above, self.force_below);
        self.target_above = σμ * self.inverse_above - c - c * (q_a - q_a * q_a);
        self.target_below = σμ * self.inverse_below - d + d * (q_b + q_b * q_b);
        self.ρ()
    }

    /// ρ = r_c/a - r_d/b for the targets that were set last.
    #[inline(always)]
    pub fn ρ(&self) -> Lanes<S> {
        self.target_above - self.target_below
    }

    /// Targets r_c and r_d of the step.
    #[inline(always)]
    pub fn targets(&self) -> [Lanes<S>; 2] {
        [self.target_above * self.above, self.target_below * self.below]
    }

    /// (dc, dd) of the step `dx`: (r_c + c dx)/a and (r_d - d dx)/b.
    #[inline(always)]
    fn force_steps(&self, dx: Lanes<S>) -> [Lanes<S>; 2] {
        let above = self.target_above + self.force_above * (dx * self.inverse_above);
        let below = self.target_below - self.force_below * (dx * self.inverse_below);
        [above, below]
    }

    /// dc - dd of the step `dx`.
    #[inline(always)]
    pub fn force_difference_step(&self, dx: Lanes<S>) -> Lanes<S> {
        let [dc, dd] = self.force_steps(dx);
        dc - dd
    }

    /// Moves by `share_room` of `dx`, the forces by `share_force` of theirs; then ties them: a + b = `room` and
    /// c - d = `difference`, which is given later, by [`Boxed::tie_forces`].
    #[inline(always)]
    pub fn advance(&mut self, dx: Lanes<S>, share_room: Lanes<S>, share_force: Lanes<S>, room: Lanes<S>) {
        let [dc, dd] = self.force_steps(dx);
        self.force_above += share_force * dc;
        self.force_below += share_force * dd;
        let (above, below) = (self.above - share_room * dx, self.below + share_room * dx);
        let is_nearer_above = below.is_above(above);
        self.above = is_nearer_above.select(above, room - below);
        self.below = is_nearer_above.select(room - above, below);
    }

    /// Restores c - d = `difference`: the smaller stays.
    #[inline(always)]
    pub fn tie_forces(&mut self, difference: Lanes<S>) {
        let above_is_larger = difference.is_above(difference.like(0.0));
        let (c, d) = (self.force_above, self.force_below);
        self.force_above = above_is_larger.select(d + difference, c);
        self.force_below = above_is_larger.select(d, c - difference);
    }
}

impl<S: Vector> Loss<S> {
    /// Nothing lost.
    #[inline(always)]
    pub fn none(simd: S) -> Self {
        Self { room: Lanes::splat(simd, 0.0), force: Lanes::splat(simd, 0.0) }
    }

    /// `yes` where the mask says so, else `no`.
    #[inline(always)]
    pub fn select(mask: Mask<S>, yes: Self, no: Self) -> Self {
        Self { room: mask.select(yes.room, no.room), force: mask.select(yes.force, no.force) }
    }

    /// Takes the step `dx` of `boxed` into account.
    #[inline(always)]
    pub fn add(&mut self, boxed: &Boxed<S>, dx: Lanes<S>) {
        let (q_a, q_b) = (dx * boxed.inverse_above, dx * boxed.inverse_below);
        self.room = q_a.max((-q_b).max(self.room));
        let [dc, dd] = boxed.force_steps(dx);
        let inverse = (boxed.force_above * boxed.force_below).recip();
        self.force = (-dc * boxed.force_below * inverse).max(self.force);
        self.force = (-dd * boxed.force_above * inverse).max(self.force);
    }
}

impl<S: Vector> AffineTally<S> {
    /// Nothing counted.
    #[inline(always)]
    pub fn none(simd: S) -> Self {
        let zero = Lanes::splat(simd, 0.0);
        Self { loss: Loss::none(simd), products: zero, first: zero, second: zero }
    }

    /// `yes` where the mask says so, else `no`.
    #[inline(always)]
    pub fn select(mask: Mask<S>, yes: Self, no: Self) -> Self {
        Self {
            loss: Loss::select(mask, yes.loss, no.loss),
            products: mask.select(yes.products, no.products),
            first: mask.select(yes.first, no.first),
            second: mask.select(yes.second, no.second),
        }
    }

    /// Takes the affine step `dx` of `boxed` into account: dc/c = -1 + dx/a and dd/d = -1 - dx/b.
    #[inline(always)]
    pub fn add(&mut self, boxed: &Boxed<S>, dx: Lanes<S>) {
        let (q_a, q_b) = (dx * boxed.inverse_above, dx * boxed.inverse_below);
        let (c, d, one) = (boxed.force_above, boxed.force_below, dx.like(1.0));
        self.loss.room = q_a.max((-q_b).max(self.loss.room));
        self.loss.force = (one - q_a).max((one + q_b).max(self.loss.force));
        self.products += boxed.products();
        self.first += (c - d) * dx;
        self.second += (c * q_a + d * q_b) * dx;
    }

    /// Σ of the products after shares `room` and `force` of the step:
    /// (a - room dx)(c + force dc) + (b + room dx)(d + force dd).
    #[inline(always)]
    pub fn products_after(&self, room: Lanes<S>, force: Lanes<S>) -> Lanes<S> {
        let rest = force.like(1.0) - force;
        rest * self.products + (force - room * rest) * self.first - room * force * self.second
    }
}
