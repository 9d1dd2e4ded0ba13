//! The primal-dual iterate of four programmes side by side.

use super::batch::{Batch, Bounds};
use super::boxed::Boxed;
use super::certificate::Multipliers;
use super::lanes::{Lanes, Vector};
use super::program::{LINK, STAGE};

/// z with everything that is boxed.
#[derive(Clone, Debug)]
pub struct Iterate<S: Vector> {
    /// Variables; length of z.
    pub z: Vec<Lanes<S>>,
    /// What belongs to each of them.
    pub variables: Vec<Variable<S>>,
    /// Multipliers y of the links.
    pub links: Vec<[Boxed<S>; LINK]>,
    /// Multipliers y of the pins.
    pub pins: Vec<Boxed<S>>,
    /// Multipliers λ of the planes.
    pub planes: Vec<Boxed<S>>,
    /// E^T y + F^T λ + q e.
    pub dual: Vec<Lanes<S>>,
}

/// A variable in its trust region, and the multipliers of its elastic bounds.
#[derive(Clone, Copy, Debug)]
pub struct Variable<S: Vector> {
    /// z in the trust region, with the duals v_u and v_l.
    pub trust: Boxed<S>,
    /// Multiplier of z <= hi, with the slacks β and t.
    pub upper: Boxed<S>,
    /// Multiplier of -z <= -lo, with the slacks β and t.
    pub lower: Boxed<S>,
}

impl<S: Vector> Iterate<S> {
    /// Nothing yet.
    pub fn new() -> Self {
        let (variables, links, pins, planes) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
        Self { z: Vec::new(), variables, links, pins, planes, dual: Vec::new() }
    }

    /// A strictly feasible start: z in the middle of the trust region, elastic slacks on the central path of parameter τ,
    /// and box duals that take up what is left of the dual equation. τ is `boldness` times μ times the largest violation
    /// of an equality.
    #[inline(always)]
    pub fn start(&mut self, batch: &Batch<S>, boldness: f64) {
        let zero = Lanes::splat(batch.simd, 0.0);
        self.z.clear();
        for bounds in &batch.bounds {
            self.z.push(bounds.middle());
        }
        let μ = batch.penalty;
        let τ = μ * zero.like(boldness) * self.largest_off(batch);
        self.links.clear();
        for k in 0..batch.intervals() {
            let values = link_values(batch, &self.z, k);
            let mut link = [Boxed::central(τ, τ); LINK];
            for (boxed, value) in link.iter_mut().zip(values) {
                *boxed = central(value, μ + μ, τ);
            }
            self.links.push(link);
        }
        self.pins.clear();
        for (index, value) in &batch.pins {
            self.pins.push(central(self.z[*index] - *value, μ + μ, τ));
        }
        self.planes.clear();
        for plane in &batch.planes {
            self.planes.push(central(plane.value(&self.z) - plane.bound, μ, τ));
        }
        self.variables.clear();
        for (&z, bounds) in self.z.iter().zip(&batch.bounds) {
            self.variables.push(Variable {
                trust: Boxed::central(bounds.room() * zero.like(0.5), τ),
                upper: central(z - bounds.soft_upper, μ, τ),
                lower: central(bounds.soft_lower - z, μ, τ),
            });
        }
        self.set_dual(batch);
        for (variable, &dual) in self.variables.iter_mut().zip(&self.dual) {
            let half = variable.trust.above;
            let base = τ.over(half);
            // v_u v_l = (τ/half)^2 with v_l - v_u = r
            let r = dual.abs();
            let smaller = (base * base).over(r * r.like(0.5) + (r * r * r.like(0.25) + base * base).sqrt());
            variable.trust.force_above = smaller;
            variable.trust.force_below = smaller;
            variable.trust.tie_forces(-dual);
        }
    }

    /// The multipliers of one lane, without those of empty planes.
    pub fn multipliers(&self, batch: &Batch<S>, lane: usize) -> Multipliers {
        let links = self.links.as_flattened().iter().chain(&self.pins);
        let bounds = self
            .variables
            .iter()
            .map(|variable| &variable.upper)
            .chain(self.variables.iter().map(|variable| &variable.lower));
        let planes = self.planes.iter().zip(&batch.planes).filter(|(_, plane)| plane.present.lane(lane) > 0.0);
        Multipliers {
            equalities: links.map(|boxed| multiplier(boxed).lane(lane)).collect(),
            inequalities: bounds.chain(planes.map(|(boxed, _)| boxed)).map(|boxed| boxed.below.lane(lane)).collect(),
        }
    }

    /// Largest violation of an equality, at least 1e-3.
    #[inline(always)]
    fn largest_off(&self, batch: &Batch<S>) -> Lanes<S> {
        let mut largest = Lanes::splat(batch.simd, 1e-3);
        for k in 0..batch.intervals() {
            for value in link_values(batch, &self.z, k) {
                largest = value.abs().max(largest);
            }
        }
        for (index, value) in &batch.pins {
            largest = (self.z[*index] - *value).abs().max(largest);
        }
        largest
    }

    /// `dual <- q e + E^T y + F^T λ`.
    #[inline(always)]
    pub fn set_dual(&mut self, batch: &Batch<S>) {
        let dual = &mut self.dual;
        dual.clear();
        for variable in &self.variables {
            dual.push(variable.upper.below - variable.lower.below);
        }
        let last = dual.len() - 1;
        dual[last] += batch.theta_cost;
        for (k, (link, boxed)) in batch.links.iter().zip(&self.links).enumerate() {
            for i in 0..LINK {
                let y = multiplier(&boxed[i]);
                for j in 0..STAGE {
                    dual[STAGE * k + j] = link.left[i][j].mul_add(y, dual[STAGE * k + j]);
                    dual[STAGE * (k + 1) + j] = link.right[i][j].mul_add(y, dual[STAGE * (k + 1) + j]);
                }
                dual[last] += link.theta[i] * y;
            }
        }
        for ((index, _), pin) in batch.pins.iter().zip(&self.pins) {
            dual[*index] += multiplier(pin);
        }
        for (plane, boxed) in batch.planes.iter().zip(&self.planes) {
            plane.add(boxed.below * plane.present, dual);
        }
    }
}

impl<S: Vector> Bounds<S> {
    /// Width of the box.
    #[inline(always)]
    pub fn room(&self) -> Lanes<S> {
        self.box_upper - self.box_lower
    }

    /// Middle of the box.
    #[inline(always)]
    fn middle(&self) -> Lanes<S> {
        (self.box_upper + self.box_lower) * self.box_upper.like(0.5)
    }
}

/// E z - d of link k.
#[inline(always)]
pub fn link_values<S: Vector>(batch: &Batch<S>, z: &[Lanes<S>], k: usize) -> [Lanes<S>; LINK] {
    let link = &batch.links[k];
    let (stages, _) = z.as_chunks::<STAGE>();
    let (here, next, θ) = (&stages[k], &stages[k + 1], z[z.len() - 1]);
    let mut values = link.rhs;
    for i in 0..LINK {
        let mut value = link.theta[i] * θ - link.rhs[i];
        for j in 0..STAGE {
            value = link.left[i][j].mul_add(here[j], link.right[i][j].mul_add(next[j], value));
        }
        values[i] = value;
    }
    values
}

/// y in [-μ, μ] from the room on its two sides.
#[inline(always)]
fn multiplier<S: Vector>(boxed: &Boxed<S>) -> Lanes<S> {
    (boxed.below - boxed.above) * boxed.below.like(0.5)
}

/// A multiplier with `room` between its bounds on the central path of parameter τ, at a row of value `f`:
/// c - d = f and τ/c + τ/d = room.
#[inline(always)]
fn central<S: Vector>(f: Lanes<S>, room: Lanes<S>, τ: Lanes<S>) -> Boxed<S> {
    let (zero, half) = (f.like(0.0), f.like(0.5));
    // the smaller of c and d, x, solves x^2 + x (|f| - 2 τ/room) = |f| τ/room
    let (size, ratio) = (f.abs(), τ.over(room));
    let b = size - (ratio + ratio);
    let root = (b * b + size * (ratio + ratio + ratio + ratio)).sqrt();
    let by_quotient = (size * (ratio + ratio)).over(b + root);
    let smaller = b.is_above(zero).select(by_quotient, half * (root - b));
    let larger = size + smaller;
    let is_positive = f.is_above(zero);
    let (c, d) = (is_positive.select(larger, smaller), is_positive.select(smaller, larger));
    // of the rooms τ/c and τ/d the smaller is exact, the other is what is left
    let least = τ.over(larger);
    let (a, b) = (is_positive.select(least, room - least), is_positive.select(room - least, least));
    Boxed::new(a, b, c, d)
}

#[cfg(test)]
mod tests {
    use pulp::Scalar256b;

    use super::central;
    use crate::convex::lanes::Lanes;

    #[test]
    fn central_slacks_solve_their_equations() {
        let lanes = |value| Lanes::splat(Scalar256b, value);
        for f in [-3.0, -1e-6, 0.0, 1e-9, 0.4, 200.0] {
            for τ in [1e-6, 1.0, 1e4] {
                let boxed = central(lanes(f), lanes(2000.0), lanes(τ));
                let [a, b, c, d] = [boxed.above, boxed.below, boxed.force_above, boxed.force_below].map(|v| v.lane(2));
                assert!(a > 0.0 && b > 0.0 && c > 0.0 && d > 0.0);
                assert!((c - d - f).abs() <= 1e-12 * (1.0 + f.abs()));
                assert!((a + b - 2000.0).abs() < 1e-9, "f {f} τ {τ}");
                assert!((a * c - τ).abs() < 1e-6 * τ && (b * d - τ).abs() < 1e-6 * τ, "f {f} τ {τ}");
            }
        }
    }
}
