//! The step length: backtracking until the filter accepts, with second-order corrections.

use super::barrier;
use super::filter::Filter;
use super::interior_point::InteriorPoint;
use super::program::Program;

/// Constants of Wächter and Biegler 2006, section 3.1, with their names there.
const Η_PHI: f64 = 1e-8;
const S_PHI: f64 = 2.3;
const S_THETA: f64 = 1.1;
const Γ_ALPHA: f64 = 0.05;
const Γ_THETA: f64 = 1e-5;
const Γ_PHI: f64 = 1e-8;
const CORRECTIONS: usize = 4;
const Κ_CORRECTION: f64 = 0.99;

/// What the line search decided.
pub enum Search {
    Accepted(f64),
    Failed,
}

impl InteriorPoint {
    /// Share of the distance to the boundary that a step may use.
    pub(super) fn boundary_share(&self) -> f64 {
        (1.0 - self.μ).max(0.99)
    }

    /// Backtracks until the filter accepts (ibid., algorithm A, step 5); the accepted point is left in `trial`.
    pub(super) fn line_search(&mut self, program: &mut impl Program) -> Search {
        let bounds = self.sides.0.len();
        let α_max = step_length(&self.point.slack, &self.step.slack, self.boundary_share());
        let θ = barrier::violation(&self.point, bounds, &self.values);
        let φ = barrier::merit(self.values.objective, &self.point.slack, self.μ);
        let slope = self.slope();
        let is_switching = |α: f64| slope < 0.0 && α * (-slope).powf(S_PHI) > θ.powf(S_THETA);
        let α_min = Γ_ALPHA * least_step(θ, slope);
        let mut α = α_max;
        let mut first = true;
        while α > α_min || first {
            let (θ_trial, φ_trial) = self.try_step(program, α, false);
            let armijo = |φ_trial: f64| φ_trial <= φ + Η_PHI * α * slope + 10.0 * f64::EPSILON * φ.abs();
            let judge = |θ_t: f64, φ_t: f64| {
                if θ <= 1e-4 && is_switching(α) { armijo(φ_t) } else { Filter::improves((θ, φ), (θ_t, φ_t)) }
            };
            let accepted = self.filter.accepts(θ_trial, φ_trial) && judge(θ_trial, φ_trial);
            let accepted = accepted || (first && θ_trial >= θ && self.correct(program, α, θ_trial, &judge));
            if accepted {
                let φ_new = barrier::merit(self.trial_values.objective, &self.trial.slack, self.μ);
                if !(is_switching(α) && armijo(φ_new)) {
                    self.filter.add(θ, φ);
                }
                return Search::Accepted(α);
            }
            first = false;
            α *= 0.5;
        }
        Search::Failed
    }

    /// Derivative of φ along the step.
    fn slope(&self) -> f64 {
        let objective: f64 = self.values.gradient.iter().zip(&self.step.x).map(|(g, dx)| g * dx).sum();
        let logarithms: f64 = self.step.slack.iter().zip(&self.point.slack).map(|(ds, s)| ds / s).sum();
        objective - self.μ * logarithms
    }

    /// θ and φ after a step of length α along the step or its correction.
    fn try_step(&mut self, program: &mut impl Program, α: f64, corrected: bool) -> (f64, f64) {
        let bounds = self.sides.0.len();
        let step = if corrected { &self.corrected } else { &self.step };
        along(&self.point.x, α, &step.x, &mut self.trial.x);
        along(&self.point.slack[bounds..], α, &step.slack[bounds..], &mut self.trial.slack[bounds..]);
        self.sides.slacks(&self.trial.x, &mut self.trial.slack);
        let values = &mut self.trial_values;
        values.objective = program.values(&self.trial.x, &mut values.c, &mut values.d);
        let θ = barrier::violation(&self.trial, bounds, values);
        (θ, barrier::merit(values.objective, &self.trial.slack, self.μ))
    }

    /// Second-order corrections (ibid., section 2.4): the rows' curvature along the step is taken out with the factors at
    /// hand. True if one of them is accepted.
    fn correct(
        &mut self, program: &mut impl Program, α: f64, θ_trial: f64, judge: &dyn Fn(f64, f64) -> bool
    ) -> bool {
        let bounds = self.sides.0.len();
        let (mut α, mut θ_last) = (α, θ_trial);
        for _ in 0..CORRECTIONS {
            for (c, trial) in self.c.iter_mut().zip(&self.trial_values.c) {
                *c = α * *c + trial;
            }
            let trial = self.trial_values.d.iter().zip(&self.trial.slack[bounds..]);
            for (excess, (d, s)) in self.excess.iter_mut().zip(trial) {
                *excess = α * *excess + (d - s);
            }
            let at = (&self.point, &self.values.gradient[..]);
            self.newton.direction(program, &self.sides, at, (&self.c, &self.excess), self.μ, &mut self.corrected);
            α = step_length(&self.point.slack, &self.corrected.slack, self.boundary_share());
            let (θ, φ) = self.try_step(program, α, true);
            if self.filter.accepts(θ, φ) && judge(θ, φ) {
                std::mem::swap(&mut self.step, &mut self.corrected);
                return true;
            }
            if θ.is_nan() || θ > Κ_CORRECTION * θ_last {
                break;
            }
            θ_last = θ;
        }
        false
    }
}

/// Largest α in (0, 1] with `s + α ds >= (1 - τ) s`.
pub fn step_length(s: &[f64], ds: &[f64], τ: f64) -> f64 {
    let steepest = s.iter().zip(ds).fold(0.0_f64, |max, (s, ds)| max.max(-ds / s));
    if steepest > τ { τ / steepest } else { 1.0 }
}

/// Step length below which the search gives up (ibid., eq. 23).
fn least_step(θ: f64, slope: f64) -> f64 {
    if slope < 0.0 {
        let switching = θ.powf(S_THETA) / (-slope).powf(S_PHI);
        Γ_THETA.min(Γ_PHI * θ / -slope).min(switching).max(1e-12)
    } else {
        Γ_THETA
    }
}

fn along(from: &[f64], α: f64, step: &[f64], to: &mut [f64]) {
    for (to, (from, step)) in to.iter_mut().zip(from.iter().zip(step)) {
        *to = from + α * step;
    }
}
