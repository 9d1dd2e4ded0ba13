use super::barrier;
use super::filter::Filter;
use super::iterate::{Bounds, Iterate, Start};
use super::newton::{Newton, Residuals, Values};
use super::program::Program;
use super::solution::Settings;

/// Bound κ_Σ on the distance of the duals from the central path (Wächter and Biegler 2006, eq. 16).
const Κ_SIGMA: f64 = 1e10;

/// Current iterate, step and trial point, with the work vectors for programs of one size.
#[derive(Clone, Debug)]
pub struct State {
    pub bounds: Bounds,
    pub newton: Newton,
    pub filter: Filter,
    pub point: Iterate,
    pub values: Values,
    /// The Newton step, and its second-order correction.
    pub step: Iterate,
    pub corrected: Iterate,
    pub trial: Iterate,
    pub trial_values: Values,
    pub residuals: Residuals,
    /// Barrier parameter.
    pub μ: f64,
}

impl State {
    /// Work vectors for `program`.
    pub fn new(program: &impl Program) -> Self {
        let sizes = program.sizes();
        let bounds = Bounds::of(program);
        let point = Iterate::zero(sizes, &bounds);
        Self {
            newton: Newton::new(sizes),
            filter: Filter::new(),
            trial: point.clone(),
            step: point.clone(),
            corrected: point.clone(),
            point,
            bounds,
            values: Values::zero(sizes),
            trial_values: Values::zero(sizes),
            residuals: Residuals::zero(sizes),
            μ: 0.0,
        }
    }

    /// Number of finite bounds: pairs of slack and dual from this index on belong to the inequalities.
    pub fn bound_count(&self) -> usize {
        self.bounds.0.len()
    }

    /// Fraction τ of the distance to the boundary that a step may use (Wächter and Biegler 2006, eq. 8).
    pub fn boundary_fraction(&self) -> f64 {
        (1.0 - self.μ).max(0.99)
    }

    /// Moves to an interior point near `start` and linearises there.
    pub fn initialise(&mut self, program: &mut impl Program, start: &Start, settings: &Settings) {
        self.μ = settings.initial_barrier;
        self.point = Iterate::initial(program, &self.bounds, start, (self.μ, settings.bound_push));
        self.values.objective = program.evaluate(&self.point.x, &mut self.values.c, &mut self.values.d);
        let θ = barrier::constraint_violation(&self.point, self.bound_count(), &self.values);
        self.filter.reset(1e4 * θ.max(1.0));
        self.linearise(program);
    }

    /// Computes the Newton step with the factors at hand.
    pub fn compute_step(&mut self, program: &mut impl Program) {
        self.residuals.c.copy_from_slice(&self.values.c);
        let slacks = &self.point.slack[self.bounds.0.len()..];
        for (residual, (d, s)) in self.residuals.slack.iter_mut().zip(self.values.d.iter().zip(slacks)) {
            *residual = d - s;
        }
        let at = (&self.point, &self.values.gradient[..]);
        self.newton.direction(program, &self.bounds, at, &self.residuals, self.μ, &mut self.step);
    }

    /// Accepts the trial point, a primal step of length α, updates the multipliers and linearises.
    pub fn advance(&mut self, program: &mut impl Program, α: f64) {
        let α_dual = max_step(&self.point.dual, &self.step.dual, self.boundary_fraction());
        std::mem::swap(&mut self.point.x, &mut self.trial.x);
        std::mem::swap(&mut self.point.slack, &mut self.trial.slack);
        std::mem::swap(&mut self.values, &mut self.trial_values);
        for (y, dy) in self.point.y.iter_mut().zip(&self.step.y) {
            *y += α * dy;
        }
        for ((v, dv), s) in self.point.dual.iter_mut().zip(&self.step.dual).zip(&self.point.slack) {
            *v = (*v + α_dual * dv).clamp(self.μ / (Κ_SIGMA * s), Κ_SIGMA * self.μ / s);
        }
        self.linearise(program);
    }

    fn linearise(&mut self, program: &mut impl Program) {
        let duals = &self.point.dual[self.bounds.0.len()..];
        program.linearise(&self.point.x, &self.point.y, duals, &mut self.values.gradient);
    }
}

/// Fraction-to-the-boundary rule (Wächter and Biegler 2006, eq. 15):
///
/// ```text
/// max { α in (0, 1] : s + α ds >= (1 - τ) s }
/// ```
pub fn max_step(s: &[f64], ds: &[f64], τ: f64) -> f64 {
    let steepest = s.iter().zip(ds).fold(0.0_f64, |max, (s, ds)| max.max(-ds / s));
    if steepest > τ { τ / steepest } else { 1.0 }
}
