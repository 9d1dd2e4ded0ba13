//! One Newton direction of the perturbed optimality conditions: what a factorisation needs, and what follows from it.
//!
//! With targets r_c, r_d of everything that is boxed (see [`Boxed`]) and ρ = r_c/a - r_d/b, elimination leaves
//!
//! ```text
//! H dz + E^T dy = r_z        H = W + F^T Ω_F^-1 F,    r_z = -ρ + F^T Ω_F^-1 ρ_F
//! E dz - Ω_E dy = r_y        r_y = ρ_E
//! ```
//!
//! with W = c/a + d/b of the trust region's boxes and Ω = c/a + d/b of the multipliers' boxes.

use super::batch::Batch;
use super::block::{Columns, Weights};
use super::boxed::{AffineTally, Loss};
use super::iterate::{Iterate, Variable};
use super::lanes::{Lanes, Mask, Vector};
use super::program::{LINK, STAGE};

/// Added to every ω, so that a row that holds exactly does not swallow the digits of the others.
const REGULARISATION: f64 = 1e-12;

/// Newton system of one iterate, without its factors.
#[derive(Clone, Debug)]
pub struct Newton<S: Vector> {
    /// Matrix of the system.
    pub weights: Weights<S>,
    /// 1/ω of the elastic bounds, upper and lower, of every variable.
    bound_weights: Vec<[Lanes<S>; 2]>,
    /// 1/ω of the pins.
    pin_weights: Vec<Lanes<S>>,
    /// Right-hand side; becomes the direction.
    pub step: Columns<S, 1>,
    /// The direction's other multipliers.
    pub multipliers: MultiplierSteps<S>,
}

/// Steps dλ and dy that are not in [`Columns`]: they follow from dz.
#[derive(Clone, Debug)]
pub struct MultiplierSteps<S: Vector> {
    /// Of the upper and the lower elastic bound of every variable.
    pub bounds: Vec<[Lanes<S>; 2]>,
    /// Of the pins.
    pub pins: Vec<Lanes<S>>,
    /// Of the planes.
    pub planes: Vec<Lanes<S>>,
}

/// Losses of what is counted in the primal step, and in the dual one.
#[derive(Clone, Copy, Debug)]
pub struct Losses<S: Vector> {
    /// Of z and of the slacks of elastic rows.
    pub primal: Lanes<S>,
    /// Of multipliers and of the duals of the trust region.
    pub dual: Lanes<S>,
}

impl<S: Vector> Newton<S> {
    /// Room for nothing yet.
    pub fn new(simd: S) -> Self {
        Self {
            weights: Weights { diagonal: Vec::new(), planes: Vec::new(), links: Vec::new() },
            bound_weights: Vec::new(),
            pin_weights: Vec::new(),
            step: Columns::zero(simd, 0),
            multipliers: MultiplierSteps { bounds: Vec::new(), pins: Vec::new(), planes: Vec::new() },
        }
    }

    /// Makes room for `batch`.
    pub fn fit(&mut self, batch: &Batch<S>) {
        let (zero, n_z, n_y) = (Lanes::splat(batch.simd, 0.0), batch.len(), LINK * batch.intervals());
        self.weights.diagonal.resize(n_z, zero);
        self.weights.links.resize(n_y, zero);
        self.bound_weights.resize(n_z, [zero; 2]);
        self.pin_weights.resize(batch.pins.len(), zero);
        self.step.z.resize(n_z, [zero]);
        self.step.y.resize(n_y, [zero]);
        self.multipliers.bounds.resize(n_z, [zero; 2]);
        self.multipliers.pins.resize(batch.pins.len(), zero);
        self.multipliers.planes.resize(batch.planes.len(), zero);
    }

    /// Forms the matrix at `at`, and the right-hand side of the affine direction: targets of zero (Mehrotra's predictor).
    #[inline(always)]
    pub fn weigh(&mut self, batch: &Batch<S>, at: &mut Iterate<S>) {
        let ε = Lanes::splat(batch.simd, REGULARISATION);
        let Self { weights, bound_weights, pin_weights, step, .. } = self;
        let rows = weights.diagonal.iter_mut().zip(bound_weights).zip(&mut step.z);
        for (variable, ((diagonal, weights), r_z)) in at.variables.iter_mut().zip(rows) {
            let Variable { trust, upper, lower } = variable;
            *weights = [upper.weigh().recip(), lower.weigh().recip()];
            *diagonal = trust.weigh() + (weights[0] + weights[1]);
            let bounds = upper.aim_at_zero() * weights[0] - lower.aim_at_zero() * weights[1];
            *r_z = [bounds - trust.aim_at_zero()];
        }
        let links = weights.links.iter_mut().zip(&mut step.y);
        for (boxed, (ω, r_y)) in at.links.as_flattened_mut().iter_mut().zip(links) {
            *ω = boxed.weigh() + ε;
            *r_y = [boxed.aim_at_zero()];
        }
        for ((boxed, weight), (index, _)) in at.pins.iter_mut().zip(pin_weights).zip(&batch.pins) {
            *weight = boxed.weigh().recip();
            weights.diagonal[*index] += *weight;
            step.z[*index][0] += boxed.aim_at_zero() * *weight;
        }
        weights.planes.clear();
        for (boxed, plane) in at.planes.iter_mut().zip(&batch.planes) {
            let weight = boxed.weigh().recip();
            weights.planes.push(weight);
            plane.add(boxed.aim_at_zero() * weight, step.z.as_flattened_mut());
        }
    }

    /// Sets targets and right-hand side of the centred direction: products of σμ, with Mehrotra's correction for the
    /// affine direction, which must be the present one.
    #[inline(always)]
    pub fn centre(&mut self, batch: &Batch<S>, at: &mut Iterate<S>, σμ: Lanes<S>) {
        let Self { weights, bound_weights, pin_weights, step, multipliers } = self;
        let steps = step.z.iter_mut().zip(&multipliers.bounds).zip(bound_weights);
        for (variable, ((dz, by), weights)) in at.variables.iter_mut().zip(steps) {
            let upper = variable.upper.aim(σμ, by[0]) * weights[0];
            let lower = variable.lower.aim(σμ, by[1]) * weights[1];
            *dz = [upper - lower - variable.trust.aim(σμ, dz[0])];
        }
        for (boxed, dy) in at.links.as_flattened_mut().iter_mut().zip(&mut step.y) {
            *dy = [boxed.aim(σμ, dy[0])];
        }
        let pins = at.pins.iter_mut().zip(&multipliers.pins);
        for ((boxed, dy), (weight, (index, _))) in pins.zip(pin_weights.iter().zip(&batch.pins)) {
            step.z[*index][0] += boxed.aim(σμ, *dy) * *weight;
        }
        let planes = at.planes.iter_mut().zip(&multipliers.planes);
        for ((boxed, dλ), (&weight, plane)) in planes.zip(weights.planes.iter().zip(&batch.planes)) {
            plane.add(boxed.aim(σμ, *dλ) * weight, step.z.as_flattened_mut());
        }
    }

    /// The direction's other multipliers, from dz.
    #[inline(always)]
    pub fn recover(&mut self, batch: &Batch<S>, at: &Iterate<S>) {
        let Self { weights, bound_weights, pin_weights, step, multipliers } = self;
        let rows = multipliers.bounds.iter_mut().zip(bound_weights).zip(&step.z);
        for (variable, ((by, weights), dz)) in at.variables.iter().zip(rows) {
            by[0] = (dz[0] - variable.upper.ρ()) * weights[0];
            by[1] = (-dz[0] - variable.lower.ρ()) * weights[1];
        }
        let pins = at.pins.iter().zip(&mut multipliers.pins);
        for ((boxed, dy), (weight, (index, _))) in pins.zip(pin_weights.iter().zip(&batch.pins)) {
            *dy = (step.z[*index][0] - boxed.ρ()) * *weight;
        }
        let planes = at.planes.iter().zip(&mut multipliers.planes);
        for ((boxed, dλ), (&weight, plane)) in planes.zip(weights.planes.iter().zip(&batch.planes)) {
            *dλ = (plane.value(step.z.as_flattened()) - boxed.ρ()) * weight;
        }
    }

    /// `out <-` what the direction leaves of the two equations, of every multiplier with the step that it will take:
    ///
    /// ```text
    /// -(E^T dy + F^T dλ + dc - dd)        and        -(E dz - (dc - dd))
    /// ```
    #[inline(always)]
    pub fn remainder(&self, batch: &Batch<S>, at: &Iterate<S>, out: &mut Columns<S, 1>) {
        let step = &self.step;
        let bounds = &self.multipliers.bounds;
        for (variable, (out, (dz, by))) in at.variables.iter().zip(out.z.iter_mut().zip(step.z.iter().zip(bounds))) {
            out[0] = by[1] - by[0] - variable.trust.force_difference_step(dz[0]);
        }
        for (boxed, (out, dy)) in at.links.as_flattened().iter().zip(out.y.iter_mut().zip(&step.y)) {
            out[0] = boxed.force_difference_step(dy[0]);
        }
        let last = batch.len() - 1;
        let (outs, _) = out.y.as_chunks_mut::<LINK>();
        let (dys, _) = step.y.as_chunks::<LINK>();
        for (k, (link, (row, dy))) in batch.links.iter().zip(outs.iter_mut().zip(dys)).enumerate() {
            for i in 0..LINK {
                let mut value = link.theta[i] * step.z[last][0];
                for j in 0..STAGE {
                    let (here, next) = (STAGE * k + j, STAGE * (k + 1) + j);
                    value += link.left[i][j] * step.z[here][0] + link.right[i][j] * step.z[next][0];
                    out.z[here][0] -= link.left[i][j] * dy[i][0];
                    out.z[next][0] -= link.right[i][j] * dy[i][0];
                }
                out.z[last][0] -= link.theta[i] * dy[i][0];
                row[i][0] -= value;
            }
        }
        for ((index, _), dy) in batch.pins.iter().zip(&self.multipliers.pins) {
            out.z[*index][0] -= *dy;
        }
        for (plane, &dλ) in batch.planes.iter().zip(&self.multipliers.planes) {
            plane.add(-dλ, out.z.as_flattened_mut());
        }
    }

    /// Adds `correction` to the direction in the lanes of `mask`.
    #[inline(always)]
    pub fn correct(&mut self, correction: &Columns<S, 1>, mask: Mask<S>) {
        for (value, by) in self.step.z.iter_mut().zip(&correction.z) {
            value[0] = mask.select(value[0] + by[0], value[0]);
        }
        for (value, by) in self.step.y.iter_mut().zip(&correction.y) {
            value[0] = mask.select(value[0] + by[0], value[0]);
        }
    }

    /// Takes the affine direction into account: what is primal in it, and what is dual.
    #[inline(always)]
    pub fn affine_tallies(&self, batch: &Batch<S>, at: &Iterate<S>) -> [AffineTally<S>; 2] {
        let mut trust = AffineTally::none(batch.simd);
        let mut rows = AffineTally::none(batch.simd);
        for (variable, (dz, by)) in at.variables.iter().zip(self.step.z.iter().zip(&self.multipliers.bounds)) {
            trust.add(&variable.trust, dz[0]);
            rows.add(&variable.upper, by[0]);
            rows.add(&variable.lower, by[1]);
        }
        for (boxed, dy) in at.links.as_flattened().iter().zip(&self.step.y) {
            rows.add(boxed, dy[0]);
        }
        for (boxed, &dy) in at.pins.iter().zip(&self.multipliers.pins) {
            rows.add(boxed, dy);
        }
        for (boxed, (plane, &dλ)) in at.planes.iter().zip(batch.planes.iter().zip(&self.multipliers.planes)) {
            let mut with = rows;
            with.add(boxed, dλ);
            rows = AffineTally::select(plane.is_present(), with, rows);
        }
        [trust, rows]
    }

    /// Largest relative losses along the direction.
    #[inline(always)]
    pub fn losses(&self, batch: &Batch<S>, at: &Iterate<S>) -> Losses<S> {
        let (mut trust, mut rows) = (Loss::none(batch.simd), Loss::none(batch.simd));
        for (variable, (dz, by)) in at.variables.iter().zip(self.step.z.iter().zip(&self.multipliers.bounds)) {
            trust.add(&variable.trust, dz[0]);
            rows.add(&variable.upper, by[0]);
            rows.add(&variable.lower, by[1]);
        }
        for (boxed, dy) in at.links.as_flattened().iter().zip(&self.step.y) {
            rows.add(boxed, dy[0]);
        }
        for (boxed, &dy) in at.pins.iter().zip(&self.multipliers.pins) {
            rows.add(boxed, dy);
        }
        for (boxed, (plane, &dλ)) in at.planes.iter().zip(batch.planes.iter().zip(&self.multipliers.planes)) {
            let mut with = rows;
            with.add(boxed, dλ);
            rows = Loss::select(plane.is_present(), with, rows);
        }
        Losses { primal: trust.room.max(rows.force), dual: trust.force.max(rows.room) }
    }

    /// Goes shares `α_p` and `α_d` of the direction, and ties everything together again.
    #[inline(always)]
    pub fn advance(&self, batch: &Batch<S>, at: &mut Iterate<S>, α_p: Lanes<S>, α_d: Lanes<S>) {
        let (μ, two_μ) = (batch.penalty, batch.penalty + batch.penalty);
        for (boxed, &dy) in at.pins.iter_mut().zip(&self.multipliers.pins) {
            boxed.advance(dy, α_d, α_p, two_μ);
        }
        for (boxed, &dλ) in at.planes.iter_mut().zip(&self.multipliers.planes) {
            boxed.advance(dλ, α_d, α_p, μ);
        }
        for (boxed, dy) in at.links.as_flattened_mut().iter_mut().zip(&self.step.y) {
            boxed.advance(dy[0], α_d, α_p, two_μ);
        }
        let steps = self.step.z.iter().zip(&self.multipliers.bounds);
        let variables = at.variables.iter_mut().zip(&mut at.z).zip(&batch.bounds);
        for (((variable, z), bounds), (dz, by)) in variables.zip(steps) {
            let Variable { trust, upper, lower } = variable;
            trust.advance(dz[0], α_p, α_d, bounds.room());
            let is_nearer_above = trust.below.is_above(trust.above);
            *z = is_nearer_above.select(bounds.box_upper - trust.above, bounds.box_lower + trust.below);
            upper.advance(by[0], α_d, α_p, μ);
            lower.advance(by[1], α_d, α_p, μ);
        }
    }
}
