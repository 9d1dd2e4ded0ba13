//! The Newton system of the perturbed optimality conditions: its matrix, its right-hand sides and its solution.
//!
//! With the targets r_c, r_d of every [`ComplementarityPair`] and ρ = r_c/a - r_d/b, elimination leaves
//!
//! ```text
//! H dz + E^T dy = r_z        H = W + F^T Ω_F^-1 F,    r_z = -ρ + F^T Ω_F^-1 ρ_F
//! E dz - Ω_E dy = r_y        r_y = ρ_E
//! ```
//!
//! with W = c/a + d/b of the trust region and Ω = c/a + d/b of the multipliers; E now stands for the dynamics rows, F
//! for all other elastic rows.

use super::batch::Batch;
use super::block::{Columns, Weights};
use super::complementarity::{Accumulator, AffineSummary, RelativeDecrease};
use super::iterate::{Iterate, Variable};
use super::program::{DYNAMICS_ROWS, STAGE_LEN};
use crate::simd::{Lanes, Mask, Simd4};

/// Added to every ω of the dynamics rows: it bounds their weights, so that a row that holds exactly does not dominate
/// the rounding of the others.
const REGULARISATION: f64 = 1e-12;

/// The Newton system at one iterate, without its factors.
#[derive(Clone, Debug)]
pub struct NewtonSystem<S: Simd4> {
    /// Weights that define the matrix.
    pub weights: Weights<S>,
    /// 1/ω of the elastic bounds, upper and lower, of every variable.
    bound_weights: Vec<[Lanes<S>; 2]>,
    /// 1/ω of the fixed variables.
    fixed_weights: Vec<Lanes<S>>,
    /// Right-hand side; a solve overwrites it with the direction.
    pub step: Columns<S, 1>,
    /// Steps of the eliminated multipliers.
    pub multipliers: MultiplierSteps<S>,
}

/// Steps dλ and dy of the eliminated multipliers, which follow from dz.
#[derive(Clone, Debug)]
pub struct MultiplierSteps<S: Simd4> {
    /// Of the upper and the lower elastic bound of every variable.
    pub bounds: Vec<[Lanes<S>; 2]>,
    /// Of the fixed variables.
    pub fixed_variables: Vec<Lanes<S>>,
    /// Of the halfspaces.
    pub halfspaces: Vec<Lanes<S>>,
}

/// Largest relative decreases of the primal and of the dual variables.
#[derive(Clone, Copy, Debug)]
pub struct MaxDecrease<S: Simd4> {
    /// Of the distances of z to the trust region and of the elastic slacks.
    pub primal: Lanes<S>,
    /// Of the distances of the multipliers to their bounds and of the trust-region duals.
    pub dual: Lanes<S>,
}

impl<S: Simd4> NewtonSystem<S> {
    /// An empty system.
    pub fn new(simd: S) -> Self {
        Self {
            weights: Weights { diagonal: Vec::new(), halfspaces: Vec::new(), dynamics: Vec::new() },
            bound_weights: Vec::new(),
            fixed_weights: Vec::new(),
            step: Columns::zero(simd, 0),
            multipliers: MultiplierSteps { bounds: Vec::new(), fixed_variables: Vec::new(), halfspaces: Vec::new() },
        }
    }

    /// Resizes all vectors for `batch`.
    pub fn resize(&mut self, batch: &Batch<S>) {
        let (zero, n_z, n_y) = (Lanes::splat(batch.simd, 0.0), batch.len(), DYNAMICS_ROWS * batch.intervals());
        self.weights.diagonal.resize(n_z, zero);
        self.weights.dynamics.resize(n_y, zero);
        self.bound_weights.resize(n_z, [zero; 2]);
        self.fixed_weights.resize(batch.fixed_variables.len(), zero);
        self.step.z.resize(n_z, [zero]);
        self.step.y.resize(n_y, [zero]);
        self.multipliers.bounds.resize(n_z, [zero; 2]);
        self.multipliers.fixed_variables.resize(batch.fixed_variables.len(), zero);
        self.multipliers.halfspaces.resize(batch.halfspaces.len(), zero);
    }

    /// Computes the weights at `at` and the right-hand side of the affine direction, targets of zero (Mehrotra's
    /// predictor).
    #[inline(always)]
    pub fn compute_weights(&mut self, batch: &Batch<S>, at: &mut Iterate<S>) {
        let ε = Lanes::splat(batch.simd, REGULARISATION);
        let Self { weights, bound_weights, fixed_weights, step, .. } = self;
        let rows = weights.diagonal.iter_mut().zip(bound_weights).zip(&mut step.z);
        for (variable, ((diagonal, weights), r_z)) in at.variables.iter_mut().zip(rows) {
            let Variable { trust_region, upper, lower } = variable;
            *weights = [upper.compute_weight().recip(), lower.compute_weight().recip()];
            *diagonal = trust_region.compute_weight() + (weights[0] + weights[1]);
            let bounds = upper.set_zero_target() * weights[0] - lower.set_zero_target() * weights[1];
            *r_z = [bounds - trust_region.set_zero_target()];
        }
        let dynamics = weights.dynamics.iter_mut().zip(&mut step.y);
        for (pair, (ω, r_y)) in at.dynamics.as_flattened_mut().iter_mut().zip(dynamics) {
            *ω = pair.compute_weight() + ε;
            *r_y = [pair.set_zero_target()];
        }
        for ((pair, weight), (index, _)) in at.fixed_variables.iter_mut().zip(fixed_weights).zip(&batch.fixed_variables)
        {
            *weight = pair.compute_weight().recip();
            weights.diagonal[*index] += *weight;
            step.z[*index][0] += pair.set_zero_target() * *weight;
        }
        weights.halfspaces.clear();
        for (pair, halfspace) in at.halfspaces.iter_mut().zip(&batch.halfspaces) {
            let weight = pair.compute_weight().recip();
            weights.halfspaces.push(weight);
            halfspace.add(pair.set_zero_target() * weight, step.z.as_flattened_mut());
        }
    }

    /// Sets the targets and the right-hand side of the centred direction: products of σμ, with Mehrotra's correction
    /// for the affine direction, which `step` must hold.
    #[inline(always)]
    pub fn set_centred_rhs(&mut self, batch: &Batch<S>, at: &mut Iterate<S>, σμ: Lanes<S>) {
        let Self { weights, bound_weights, fixed_weights, step, multipliers } = self;
        let steps = step.z.iter_mut().zip(&multipliers.bounds).zip(bound_weights);
        for (variable, ((dz, dλ), weights)) in at.variables.iter_mut().zip(steps) {
            let upper = variable.upper.set_target(σμ, dλ[0]) * weights[0];
            let lower = variable.lower.set_target(σμ, dλ[1]) * weights[1];
            *dz = [upper - lower - variable.trust_region.set_target(σμ, dz[0])];
        }
        for (pair, dy) in at.dynamics.as_flattened_mut().iter_mut().zip(&mut step.y) {
            *dy = [pair.set_target(σμ, dy[0])];
        }
        let fixed_variables = at.fixed_variables.iter_mut().zip(&multipliers.fixed_variables);
        for ((pair, dy), (weight, (index, _))) in fixed_variables.zip(fixed_weights.iter().zip(&batch.fixed_variables))
        {
            step.z[*index][0] += pair.set_target(σμ, *dy) * *weight;
        }
        let halfspaces = at.halfspaces.iter_mut().zip(&multipliers.halfspaces);
        for ((pair, dλ), (&weight, halfspace)) in halfspaces.zip(weights.halfspaces.iter().zip(&batch.halfspaces)) {
            halfspace.add(pair.set_target(σμ, *dλ) * weight, step.z.as_flattened_mut());
        }
    }

    /// Computes the steps of the eliminated multipliers from dz.
    #[inline(always)]
    pub fn recover_multipliers(&mut self, batch: &Batch<S>, at: &Iterate<S>) {
        let Self { weights, bound_weights, fixed_weights, step, multipliers } = self;
        let rows = multipliers.bounds.iter_mut().zip(bound_weights).zip(&step.z);
        for (variable, ((dλ, weights), dz)) in at.variables.iter().zip(rows) {
            dλ[0] = (dz[0] - variable.upper.ρ()) * weights[0];
            dλ[1] = (-dz[0] - variable.lower.ρ()) * weights[1];
        }
        let fixed_variables = at.fixed_variables.iter().zip(&mut multipliers.fixed_variables);
        for ((pair, dy), (weight, (index, _))) in fixed_variables.zip(fixed_weights.iter().zip(&batch.fixed_variables))
        {
            *dy = (step.z[*index][0] - pair.ρ()) * *weight;
        }
        let halfspaces = at.halfspaces.iter().zip(&mut multipliers.halfspaces);
        for ((pair, dλ), (&weight, halfspace)) in halfspaces.zip(weights.halfspaces.iter().zip(&batch.halfspaces)) {
            *dλ = (halfspace.value(step.z.as_flattened()) - pair.ρ()) * weight;
        }
    }

    /// `out <-` the residuals that the direction leaves in both equations:
    ///
    /// ```text
    /// -(E^T dy + F^T dλ + dc - dd)        and        -(E dz - (dc - dd))
    /// ```
    #[inline(always)]
    pub fn residuals(&self, batch: &Batch<S>, at: &Iterate<S>, out: &mut Columns<S, 1>) {
        let step = &self.step;
        let bounds = &self.multipliers.bounds;
        for (variable, (out, (dz, dλ))) in at.variables.iter().zip(out.z.iter_mut().zip(step.z.iter().zip(bounds))) {
            out[0] = dλ[1] - dλ[0] - variable.trust_region.dual_difference_step(dz[0]);
        }
        for (pair, (out, dy)) in at.dynamics.as_flattened().iter().zip(out.y.iter_mut().zip(&step.y)) {
            out[0] = pair.dual_difference_step(dy[0]);
        }
        let last = batch.len() - 1;
        let (outs, _) = out.y.as_chunks_mut::<DYNAMICS_ROWS>();
        let (dys, _) = step.y.as_chunks::<DYNAMICS_ROWS>();
        for (k, (constraint, (row, dy))) in batch.dynamics.iter().zip(outs.iter_mut().zip(dys)).enumerate() {
            for i in 0..DYNAMICS_ROWS {
                let mut value = constraint.theta[i] * step.z[last][0];
                for j in 0..STAGE_LEN {
                    let (current, next) = (STAGE_LEN * k + j, STAGE_LEN * (k + 1) + j);
                    value += constraint.left[i][j] * step.z[current][0] + constraint.right[i][j] * step.z[next][0];
                    out.z[current][0] -= constraint.left[i][j] * dy[i][0];
                    out.z[next][0] -= constraint.right[i][j] * dy[i][0];
                }
                out.z[last][0] -= constraint.theta[i] * dy[i][0];
                row[i][0] -= value;
            }
        }
        for ((index, _), dy) in batch.fixed_variables.iter().zip(&self.multipliers.fixed_variables) {
            out.z[*index][0] -= *dy;
        }
        for (halfspace, &dλ) in batch.halfspaces.iter().zip(&self.multipliers.halfspaces) {
            halfspace.add(-dλ, out.z.as_flattened_mut());
        }
    }

    /// Adds `correction` to the direction in the lanes of `mask`.
    #[inline(always)]
    pub fn add_correction(&mut self, correction: &Columns<S, 1>, mask: Mask<S>) {
        for (value, by) in self.step.z.iter_mut().zip(&correction.z) {
            value[0] = mask.select(value[0] + by[0], value[0]);
        }
        for (value, by) in self.step.y.iter_mut().zip(&correction.y) {
            value[0] = mask.select(value[0] + by[0], value[0]);
        }
    }

    /// Summaries of the affine direction: over the trust region, and over the multipliers of all elastic rows.
    #[inline(always)]
    pub fn affine_summaries(&self, batch: &Batch<S>, at: &Iterate<S>) -> [AffineSummary<S>; 2] {
        self.accumulate(batch, at, AffineSummary::zero(batch.simd))
    }

    /// Largest relative decreases along the direction.
    #[inline(always)]
    pub fn max_decrease(&self, batch: &Batch<S>, at: &Iterate<S>) -> MaxDecrease<S> {
        let [trust_region, rows] = self.accumulate(batch, at, RelativeDecrease::zero(batch.simd));
        // the duals of a multiplier's pair are elastic slacks, which are primal variables
        MaxDecrease { primal: trust_region.slack.max(rows.dual), dual: trust_region.dual.max(rows.slack) }
    }

    /// Accumulates the steps of all pairs, starting from `zero`: of the trust region, and of all elastic rows.
    #[inline(always)]
    fn accumulate<A: Accumulator<S>>(&self, batch: &Batch<S>, at: &Iterate<S>, zero: A) -> [A; 2] {
        let (mut trust_region, mut rows) = (zero, zero);
        for (variable, (dz, dλ)) in at.variables.iter().zip(self.step.z.iter().zip(&self.multipliers.bounds)) {
            trust_region.add(&variable.trust_region, dz[0]);
            rows.add(&variable.upper, dλ[0]);
            rows.add(&variable.lower, dλ[1]);
        }
        for (pair, dy) in at.dynamics.as_flattened().iter().zip(&self.step.y) {
            rows.add(pair, dy[0]);
        }
        for (pair, &dy) in at.fixed_variables.iter().zip(&self.multipliers.fixed_variables) {
            rows.add(pair, dy);
        }
        for (pair, (halfspace, &dλ)) in
            at.halfspaces.iter().zip(batch.halfspaces.iter().zip(&self.multipliers.halfspaces))
        {
            let mut with = rows;
            with.add(pair, dλ);
            rows = A::select(halfspace.is_present(), with, rows);
        }
        [trust_region, rows]
    }

    /// Moves `at` by `α_p` of the primal and `α_d` of the dual direction; the slacks a + b keep their sum. The
    /// differences c - d are restored by [`restore_feasibility`](super::feasibility::restore_feasibility).
    #[inline(always)]
    pub fn advance(&self, batch: &Batch<S>, at: &mut Iterate<S>, α_p: Lanes<S>, α_d: Lanes<S>) {
        let fixed_variables = at.fixed_variables.iter_mut().zip(&batch.fixed_variables);
        for ((pair, (index, _)), &dy) in fixed_variables.zip(&self.multipliers.fixed_variables) {
            let μ = batch.weight(&batch.bounds[*index].row_scale);
            pair.advance(dy, α_d, α_p, μ + μ);
        }
        let μ = batch.weight(&batch.row_scales[0]);
        for (pair, &dλ) in at.halfspaces.iter_mut().zip(&self.multipliers.halfspaces) {
            pair.advance(dλ, α_d, α_p, μ);
        }
        for (constraint, dy) in at.dynamics.iter_mut().zip(self.step.y.as_chunks::<DYNAMICS_ROWS>().0) {
            for ((pair, dy), scale) in constraint.iter_mut().zip(dy).zip(&batch.row_scales) {
                let μ = batch.weight(scale);
                pair.advance(dy[0], α_d, α_p, μ + μ);
            }
        }
        let steps = self.step.z.iter().zip(&self.multipliers.bounds);
        let variables = at.variables.iter_mut().zip(&mut at.z).zip(&batch.bounds);
        for (((variable, z), bounds), (dz, dλ)) in variables.zip(steps) {
            let Variable { trust_region, upper, lower } = variable;
            trust_region.advance(dz[0], α_p, α_d, bounds.width());
            let is_nearer_upper = trust_region.slack_lower.is_above(trust_region.slack_upper);
            *z = is_nearer_upper
                .select(bounds.box_upper - trust_region.slack_upper, bounds.box_lower + trust_region.slack_lower);
            let μ = batch.weight(&bounds.row_scale);
            upper.advance(dλ[0], α_d, α_p, μ);
            lower.advance(dλ[1], α_d, α_p, μ);
        }
    }
}
