//! The primal-dual iterate of four programs side by side.

use super::batch::{Batch, Bounds};
use super::certificate::Multipliers;
use super::complementarity::ComplementarityPair;
use super::program::{DYNAMICS_ROWS, STAGE_LEN};
use crate::simd::{Lanes, Simd4};

/// z with its complementarity pairs.
#[derive(Clone, Debug)]
pub struct Iterate<S: Simd4> {
    /// Variables; length of z.
    pub z: Vec<Lanes<S>>,
    /// Complementarity pairs of each variable.
    pub variables: Vec<Variable<S>>,
    /// Multipliers y of the dynamics constraints.
    pub dynamics: Vec<[ComplementarityPair<S>; DYNAMICS_ROWS]>,
    /// Multipliers y of the fixed variables.
    pub fixed_variables: Vec<ComplementarityPair<S>>,
    /// Multipliers λ of the halfspaces.
    pub halfspaces: Vec<ComplementarityPair<S>>,
    /// E^T y + F^T λ + q e.
    pub dual: Vec<Lanes<S>>,
}

/// The pairs of one variable: its trust region, and the multipliers of its elastic bounds.
#[derive(Clone, Copy, Debug)]
pub struct Variable<S: Simd4> {
    /// z in the trust region, with the duals v_u and v_l.
    pub trust_region: ComplementarityPair<S>,
    /// Multiplier of z <= hi, with the slacks β and t.
    pub upper: ComplementarityPair<S>,
    /// Multiplier of -z <= -lo, with the slacks β and t.
    pub lower: ComplementarityPair<S>,
}

impl<S: Simd4> Iterate<S> {
    /// An empty iterate.
    pub fn new() -> Self {
        let (variables, dynamics, fixed_variables, halfspaces) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
        Self { z: Vec::new(), variables, dynamics, fixed_variables, halfspaces, dual: Vec::new() }
    }

    /// Sets a strictly feasible start: z at the centre of the trust region, elastic slacks on the central path with
    /// parameter τ, and trust-region duals that close the dual equation.
    ///
    /// τ is `initial_barrier` times μ times the largest violation, in units u, of an equality or of a halfspace of large
    /// weight.
    #[inline(always)]
    pub fn start(&mut self, batch: &Batch<S>, initial_barrier: f64) {
        let zero = Lanes::splat(batch.simd, 0.0);
        self.z.clear();
        for bounds in &batch.bounds {
            self.z.push(bounds.centre());
        }
        let τ = batch.penalty * zero.like(initial_barrier) * self.max_violation(batch);
        self.dynamics.clear();
        for k in 0..batch.intervals() {
            let values = dynamics_residuals(batch, &self.z, k);
            let mut constraint = [ComplementarityPair::central(τ, τ); DYNAMICS_ROWS];
            for ((pair, value), scale) in constraint.iter_mut().zip(values).zip(&batch.row_scales) {
                let μ = batch.weight(scale);
                *pair = central(value, μ + μ, τ);
            }
            self.dynamics.push(constraint);
        }
        self.fixed_variables.clear();
        for (index, value) in &batch.fixed_variables {
            let μ = batch.weight(&batch.bounds[*index].row_scale);
            self.fixed_variables.push(central(self.z[*index] - *value, μ + μ, τ));
        }
        self.halfspaces.clear();
        let μ = batch.weight(&batch.row_scales[0]);
        for halfspace in &batch.halfspaces {
            self.halfspaces.push(central(halfspace.value(&self.z) - halfspace.bound, μ, τ));
        }
        self.variables.clear();
        for (&z, bounds) in self.z.iter().zip(&batch.bounds) {
            let μ = batch.weight(&bounds.row_scale);
            self.variables.push(Variable {
                trust_region: ComplementarityPair::central(bounds.width() * zero.like(0.5), τ),
                upper: central(z - bounds.soft_upper, μ, τ),
                lower: central(bounds.soft_lower - z, μ, τ),
            });
        }
        self.set_dual(batch);
        for (variable, &dual) in self.variables.iter_mut().zip(&self.dual) {
            let half = variable.trust_region.slack_upper;
            let base = τ.over(half);
            // v_u v_l = (τ/half)^2 with v_l - v_u = r
            let r = dual.abs();
            let smaller = (base * base).over(r * r.like(0.5) + (r * r * r.like(0.25) + base * base).sqrt());
            variable.trust_region.dual_upper = smaller;
            variable.trust_region.dual_lower = smaller;
            variable.trust_region.restore_dual_difference(-dual);
        }
    }

    /// The multipliers of one lane, without those of absent halfspaces.
    pub fn multipliers(&self, batch: &Batch<S>, lane: usize) -> Multipliers {
        let dynamics = self.dynamics.as_flattened().iter().chain(&self.fixed_variables);
        let bounds = self
            .variables
            .iter()
            .map(|variable| &variable.upper)
            .chain(self.variables.iter().map(|variable| &variable.lower));
        let halfspaces =
            self.halfspaces.iter().zip(&batch.halfspaces).filter(|(_, halfspace)| halfspace.present.lane(lane) > 0.0);
        Multipliers {
            equalities: dynamics.map(|pair| pair.offset.lane(lane)).collect(),
            inequalities: bounds
                .chain(halfspaces.map(|(pair, _)| pair))
                .map(|pair| pair.slack_lower.lane(lane))
                .collect(),
        }
    }

    /// Largest violation in units u of an equality, or of a halfspace of large weight; at least 1e-3.
    #[inline(always)]
    fn max_violation(&self, batch: &Batch<S>) -> Lanes<S> {
        let mut max = Lanes::splat(batch.simd, 1e-3);
        for k in 0..batch.intervals() {
            for (value, scale) in dynamics_residuals(batch, &self.z, k).into_iter().zip(&batch.row_scales) {
                max = (value.abs() * scale.unit).max(max);
            }
        }
        for (index, value) in &batch.fixed_variables {
            max = ((self.z[*index] - *value).abs() * batch.bounds[*index].row_scale.unit).max(max);
        }
        let scale = &batch.row_scales[0];
        let unit = scale.is_stiff().select(scale.unit, max.like(0.0));
        for halfspace in &batch.halfspaces {
            max = ((halfspace.value(&self.z) - halfspace.bound) * (unit * halfspace.present)).max(max);
        }
        max
    }

    /// `dual <- q e + E^T y + F^T λ`.
    #[inline(always)]
    pub fn set_dual(&mut self, batch: &Batch<S>) {
        let dual = &mut self.dual;
        dual.clear();
        for variable in &self.variables {
            dual.push(variable.upper.slack_lower - variable.lower.slack_lower);
        }
        let last = dual.len() - 1;
        dual[last] += batch.theta_cost;
        for (k, (constraint, pair)) in batch.dynamics.iter().zip(&self.dynamics).enumerate() {
            for i in 0..DYNAMICS_ROWS {
                let y = pair[i].offset;
                for j in 0..STAGE_LEN {
                    dual[STAGE_LEN * k + j] = constraint.left[i][j].mul_add(y, dual[STAGE_LEN * k + j]);
                    dual[STAGE_LEN * (k + 1) + j] = constraint.right[i][j].mul_add(y, dual[STAGE_LEN * (k + 1) + j]);
                }
                dual[last] += constraint.theta[i] * y;
            }
        }
        for ((index, _), fixed) in batch.fixed_variables.iter().zip(&self.fixed_variables) {
            dual[*index] += fixed.offset;
        }
        for (halfspace, pair) in batch.halfspaces.iter().zip(&self.halfspaces) {
            halfspace.add(pair.slack_lower * halfspace.present, dual);
        }
    }
}

impl<S: Simd4> Bounds<S> {
    /// Width of the hard bounds.
    #[inline(always)]
    pub fn width(&self) -> Lanes<S> {
        self.box_upper - self.box_lower
    }

    /// Centre of the hard bounds.
    #[inline(always)]
    fn centre(&self) -> Lanes<S> {
        (self.box_upper + self.box_lower) * self.box_upper.like(0.5)
    }
}

/// E z - d of dynamics constraint k.
#[inline(always)]
pub fn dynamics_residuals<S: Simd4>(batch: &Batch<S>, z: &[Lanes<S>], k: usize) -> [Lanes<S>; DYNAMICS_ROWS] {
    let constraint = &batch.dynamics[k];
    let (stages, _) = z.as_chunks::<STAGE_LEN>();
    let (current, next, θ) = (&stages[k], &stages[k + 1], z[z.len() - 1]);
    let mut values = constraint.rhs;
    for i in 0..DYNAMICS_ROWS {
        let mut value = constraint.theta[i] * θ - constraint.rhs[i];
        for j in 0..STAGE_LEN {
            value = constraint.left[i][j].mul_add(current[j], constraint.right[i][j].mul_add(next[j], value));
        }
        values[i] = value;
    }
    values
}

/// The pair of a multiplier on the central path with parameter τ, for bounds `width` apart and a row with residual `f`:
/// c - d = f and τ/c + τ/d = width.
#[inline(always)]
fn central<S: Simd4>(f: Lanes<S>, width: Lanes<S>, τ: Lanes<S>) -> ComplementarityPair<S> {
    let (zero, half) = (f.like(0.0), f.like(0.5));
    // the smaller of c and d, x, solves x^2 + x (|f| - 2 τ/width) = |f| τ/width
    let (size, ratio) = (f.abs(), τ.over(width));
    let b = size - (ratio + ratio);
    let root = (b * b + size * (ratio + ratio + ratio + ratio)).sqrt();
    let by_quotient = (size * (ratio + ratio)).over(b + root);
    let smaller = b.is_above(zero).select(by_quotient, half * (root - b));
    let larger = size + smaller;
    let is_positive = f.is_above(zero);
    let (c, d) = (is_positive.select(larger, smaller), is_positive.select(smaller, larger));
    // of the slacks τ/c and τ/d the smaller is computed directly, the larger is the difference to the width
    let min = τ.over(larger);
    let (a, b) = (is_positive.select(min, width - min), is_positive.select(width - min, min));
    ComplementarityPair::new(a, b, c, d)
}

#[cfg(test)]
mod tests {
    use pulp::Scalar256b;

    use super::central;
    use crate::simd::Lanes;

    #[test]
    fn central_slacks_solve_their_equations() {
        let lanes = |value| Lanes::splat(Scalar256b, value);
        for f in [-3.0, -1e-6, 0.0, 1e-9, 0.4, 200.0] {
            for τ in [1e-6, 1.0, 1e4] {
                let pair = central(lanes(f), lanes(2000.0), lanes(τ));
                let [a, b, c, d] =
                    [pair.slack_upper, pair.slack_lower, pair.dual_upper, pair.dual_lower].map(|v| v.lane(2));
                assert!(a > 0.0 && b > 0.0 && c > 0.0 && d > 0.0);
                assert!((c - d - f).abs() <= 1e-12 * (1.0 + f.abs()));
                assert!((a + b - 2000.0).abs() < 1e-9, "f {f} τ {τ}");
                assert!((a * c - τ).abs() < 1e-6 * τ && (b * d - τ).abs() < 1e-6 * τ, "f {f} τ {τ}");
            }
        }
    }
}
