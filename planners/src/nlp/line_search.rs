//! Backtracking line search with filter and second-order corrections (Wächter and Biegler 2006, algorithm A, step A-5).

use super::barrier::{barrier_objective, constraint_violation};
use super::filter::{Filter, Γ_PHI, Γ_THETA};
use super::program::Program;
use super::state::{State, max_step};

/// Constants of the paper, by their names there.
const Η_PHI: f64 = 1e-8;
const S_PHI: f64 = 2.3;
const S_THETA: f64 = 1.1;
const Γ_ALPHA: f64 = 0.05;
const MAX_CORRECTIONS: usize = 4;
const Κ_SOC: f64 = 0.99;

/// Violation above which the switching condition is not considered; ours is absolute, the paper's relative to the
/// start.
const Θ_MIN: f64 = 1e-4;

impl State {
    /// Backtracks until the filter accepts a trial point, which is left in `trial`.
    ///
    /// Returns the accepted step length α, or none if α fell below its minimum.
    pub fn line_search(&mut self, program: &mut impl Program) -> Option<f64> {
        let α_max = max_step(&self.point.slack, &self.step.slack, self.boundary_fraction());
        let θ = constraint_violation(&self.point, self.bound_count(), &self.values);
        let φ = barrier_objective(self.values.objective, &self.point.slack, self.μ);
        let slope = self.slope();
        // switching condition [eq. 19] and Armijo condition [eq. 20]
        let is_switching = |α: f64| slope < 0.0 && α * (-slope).powf(S_PHI) > θ.powf(S_THETA);
        let α_min = Γ_ALPHA * min_step(θ, slope);
        let mut α = α_max;
        let mut is_first = true;
        while α > α_min || is_first {
            let (θ_trial, φ_trial) = self.try_step(program, α, false);
            let armijo = |φ_trial: f64| φ_trial <= φ + Η_PHI * α * slope + 10.0 * f64::EPSILON * φ.abs();
            let is_sufficient = |θ_t: f64, φ_t: f64| {
                if θ <= Θ_MIN && is_switching(α) { armijo(φ_t) } else { Filter::improves((θ, φ), (θ_t, φ_t)) }
            };
            let is_accepted = self.filter.accepts(θ_trial, φ_trial) && is_sufficient(θ_trial, φ_trial);
            let is_accepted =
                is_accepted || (is_first && θ_trial >= θ && self.correct(program, α, θ_trial, &is_sufficient));
            if is_accepted {
                let φ_new = barrier_objective(self.trial_values.objective, &self.trial.slack, self.μ);
                if !(is_switching(α) && armijo(φ_new)) {
                    self.filter.add(θ, φ);
                }
                return Some(α);
            }
            is_first = false;
            α *= 0.5;
        }
        None
    }

    /// Directional derivative of φ along the step.
    fn slope(&self) -> f64 {
        let objective: f64 = self.values.gradient.iter().zip(&self.step.x).map(|(g, dx)| g * dx).sum();
        let logarithms: f64 = self.step.slack.iter().zip(&self.point.slack).map(|(ds, s)| ds / s).sum();
        objective - self.μ * logarithms
    }

    /// Evaluates the trial point at length α of the step, or of its correction; returns θ and φ there.
    fn try_step(&mut self, program: &mut impl Program, α: f64, is_corrected: bool) -> (f64, f64) {
        let bound_count = self.bound_count();
        let step = if is_corrected { &self.corrected } else { &self.step };
        add_scaled(&self.point.x, α, &step.x, &mut self.trial.x);
        let trial_slack = &mut self.trial.slack[bound_count..];
        add_scaled(&self.point.slack[bound_count..], α, &step.slack[bound_count..], trial_slack);
        self.bounds.slacks(&self.trial.x, &mut self.trial.slack);
        let values = &mut self.trial_values;
        values.objective = program.evaluate(&self.trial.x, &mut values.c, &mut values.d);
        let θ = constraint_violation(&self.trial, bound_count, values);
        (θ, barrier_objective(values.objective, &self.trial.slack, self.μ))
    }

    /// Second-order corrections (ibid., section 2.4): Newton steps with the factors at hand for the residuals
    /// `α c + c(x + α dx)`.
    ///
    /// Returns whether one of them is accepted; it then is the step.
    fn correct(
        &mut self,
        program: &mut impl Program,
        α: f64,
        θ_trial: f64,
        is_sufficient: &dyn Fn(f64, f64) -> bool,
    ) -> bool {
        let bound_count = self.bound_count();
        let (mut α, mut θ_last) = (α, θ_trial);
        for _ in 0..MAX_CORRECTIONS {
            for (c, trial) in self.residuals.c.iter_mut().zip(&self.trial_values.c) {
                *c = α * *c + trial;
            }
            let trial = self.trial_values.d.iter().zip(&self.trial.slack[bound_count..]);
            for (residual, (d, s)) in self.residuals.slack.iter_mut().zip(trial) {
                *residual = α * *residual + (d - s);
            }
            let at = (&self.point, &self.values.gradient[..]);
            self.newton.direction(program, &self.bounds, at, &self.residuals, self.μ, &mut self.corrected);
            α = max_step(&self.point.slack, &self.corrected.slack, self.boundary_fraction());
            let (θ, φ) = self.try_step(program, α, true);
            if self.filter.accepts(θ, φ) && is_sufficient(θ, φ) {
                std::mem::swap(&mut self.step, &mut self.corrected);
                return true;
            }
            if θ.is_nan() || θ > Κ_SOC * θ_last {
                break;
            }
            θ_last = θ;
        }
        false
    }
}

/// Step length, before the factor γ_α, below which the line search fails (Wächter and Biegler 2006, eq. 23).
fn min_step(θ: f64, slope: f64) -> f64 {
    if slope < 0.0 {
        let switching = θ.powf(S_THETA) / (-slope).powf(S_PHI);
        Γ_THETA.min(Γ_PHI * θ / -slope).min(switching).max(1e-12)
    } else {
        Γ_THETA
    }
}

/// `to = from + α step`.
fn add_scaled(from: &[f64], α: f64, step: &[f64], to: &mut [f64]) {
    for (to, (from, step)) in to.iter_mut().zip(from.iter().zip(step)) {
        *to = from + α * step;
    }
}
