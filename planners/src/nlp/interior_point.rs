use super::barrier::{self, Errors};
use super::filter::Filter;
use super::iterate::{Iterate, Sides, Start};
use super::newton::{Newton, Values, largest};
use super::program::Program;
use super::solution::{Record, Settings, Solution, Status};

/// Constants of Wächter and Biegler 2006, section 3.1, with their names there.
const Κ_SIGMA: f64 = 1e10;
const Η_PHI: f64 = 1e-8;
const S_PHI: f64 = 2.3;
const S_THETA: f64 = 1.1;
const Γ_ALPHA: f64 = 0.05;
const Γ_THETA: f64 = 1e-5;
const Γ_PHI: f64 = 1e-8;
const CORRECTIONS: usize = 4;
const Κ_CORRECTION: f64 = 0.99;

/// Additions δ to the Hessian's diagonal: first, least, most, and their growth.
const Δ_FIRST: f64 = 1e-2;
const Δ_LEAST: f64 = 1e-12;
const Δ_MOST: f64 = 1e10;
const GROWTH_FIRST: f64 = 100.0;
const GROWTH: f64 = 8.0;
const DECAY: f64 = 1.0 / 3.0;

/// How often a failed line search may be answered by a stronger regularisation before the run counts as stalled.
const RESCUES: usize = 12;

/// The method, with its work vectors for programmes of one size.
#[derive(Clone, Debug)]
pub struct InteriorPoint {
    settings: Settings,
    sides: Sides,
    newton: Newton,
    filter: Filter,
    point: Iterate,
    trial: Iterate,
    step: Iterate,
    corrected: Iterate,
    values: Values,
    trial_values: Values,
    c: Vec<f64>,
    excess: Vec<f64>,
    work: Vec<f64>,
    μ: f64,
    δ: f64,
    δ_last: f64,
    δ_least: f64,
}

/// What the line search decided.
enum Search {
    Accepted(f64),
    Failed,
}

impl InteriorPoint {
    /// Room for `program`, whose bounds must not change afterwards.
    pub fn new(program: &impl Program, settings: Settings) -> Self {
        let sizes = program.sizes();
        let sides = Sides::of(program);
        let point = Iterate::zero(sizes, &sides);
        Self {
            settings,
            newton: Newton::new(sizes),
            filter: Filter::new(),
            trial: point.clone(),
            step: point.clone(),
            corrected: point.clone(),
            point,
            sides,
            values: Values::zero(sizes),
            trial_values: Values::zero(sizes),
            c: vec![0.0; sizes.equalities],
            excess: vec![0.0; sizes.inequalities],
            work: vec![0.0; sizes.variables],
            μ: settings.start,
            δ: 0.0,
            δ_last: 0.0,
            δ_least: 0.0,
        }
    }

    /// Variables of the last point.
    pub fn x(&self) -> &[f64] {
        &self.point.x
    }

    /// The last point, as the start of a similar programme.
    pub fn warm_start(&self) -> Start {
        let bounds = self.sides.0.len();
        let mut z = [vec![0.0; self.point.x.len()], vec![0.0; self.point.x.len()]];
        for (side, dual) in self.sides.0.iter().zip(&self.point.dual) {
            z[usize::from(side.sign < 0.0)][side.index] = *dual;
        }
        Start::Warm { x: self.point.x.clone(), y: self.point.y.clone(), v: self.point.dual[bounds..].to_vec(), z }
    }

    /// Solves `program` from `start`.
    pub fn solve(&mut self, program: &mut impl Program, start: &Start) -> Solution {
        self.begin(program, start);
        let mut history = Vec::with_capacity(64);
        let (mut α, mut rescues) = (0.0, 0);
        loop {
            let errors = Errors::at(program, &self.sides, &self.point, &self.values, &mut self.work);
            history.push(self.record(&errors, α));
            if let Some(status) = self.ended(&errors, history.len() - 1, rescues) {
                return self.finish(status, &errors, history);
            }
            self.lower_barrier(&errors);
            if !self.factor(program) {
                return self.finish(Status::Stalled, &errors, history);
            }
            self.direction(program);
            match self.line_search(program) {
                Search::Accepted(length) => {
                    α = length;
                    (rescues, self.δ_least) = (0, 0.0);
                    self.advance(program, length);
                }
                Search::Failed => {
                    // a shorter, more cautious step: the next factorisation begins with a stronger regularisation
                    rescues += 1;
                    α = 0.0;
                    self.δ_least = GROWTH * self.δ.max(Δ_FIRST);
                    self.filter.forget();
                }
            }
        }
    }

    fn begin(&mut self, program: &mut impl Program, start: &Start) {
        (self.μ, self.δ_last, self.δ_least) = (self.settings.start, 0.0, 0.0);
        self.point = Iterate::begin(program, &self.sides, start, self.μ);
        self.values.objective = program.values(&self.point.x, &mut self.values.c, &mut self.values.d);
        let θ = barrier::violation(&self.point, self.sides.0.len(), &self.values);
        self.filter.reset(1e4 * θ.max(1.0));
        self.linearise(program);
    }

    fn linearise(&mut self, program: &mut impl Program) {
        let duals = &self.point.dual[self.sides.0.len()..];
        program.linearise(&self.point.x, &self.point.y, duals, &mut self.values.gradient);
    }

    fn ended(&self, errors: &Errors, iterations: usize, rescues: usize) -> Option<Status> {
        if !(largest(&self.values.gradient).is_finite() && errors.violation.is_finite() && errors.dual.is_finite()) {
            Some(Status::NotFinite)
        } else if errors.total(0.0) <= self.settings.tolerance {
            Some(Status::Solved)
        } else if iterations >= self.settings.max_iterations {
            Some(Status::IterationLimit)
        } else {
            (rescues > RESCUES).then_some(Status::Stalled)
        }
    }

    fn lower_barrier(&mut self, errors: &Errors) {
        let μ = barrier::next(self.μ, errors, &self.settings);
        if μ < self.μ {
            self.μ = μ;
            self.filter.forget();
        }
    }

    /// Factors with the smallest δ tried for which the curvature is right (ibid., algorithm IC).
    fn factor(&mut self, program: &mut impl Program) -> bool {
        self.δ = self.δ_least;
        let first = self.δ_last == 0.0;
        while self.δ <= Δ_MOST {
            if self.newton.factor(program, &self.sides, &self.point, self.δ) {
                if self.δ > 0.0 {
                    self.δ_last = self.δ;
                }
                return true;
            }
            self.δ = match (self.δ == 0.0, first) {
                (true, true) => Δ_FIRST,
                (true, false) => (DECAY * self.δ_last).max(Δ_LEAST),
                (false, true) => GROWTH_FIRST * self.δ,
                (false, false) => GROWTH * self.δ,
            };
        }
        false
    }

    fn direction(&mut self, program: &mut impl Program) {
        self.c.copy_from_slice(&self.values.c);
        let slacks = &self.point.slack[self.sides.0.len()..];
        for (excess, (d, s)) in self.excess.iter_mut().zip(self.values.d.iter().zip(slacks)) {
            *excess = d - s;
        }
        let at = (&self.point, &self.values.gradient[..]);
        self.newton.direction(program, &self.sides, at, (&self.c, &self.excess), self.μ, &mut self.step);
    }

    /// Share of the distance to the boundary that a step may use.
    fn boundary_share(&self) -> f64 {
        (1.0 - self.μ).max(0.99)
    }

    /// Backtracks until the filter accepts (ibid., algorithm A, step 5); the accepted point is left in `trial`.
    fn line_search(&mut self, program: &mut impl Program) -> Search {
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
                let (_, φ_new) = (0, barrier::merit(self.trial_values.objective, &self.trial.slack, self.μ));
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
            if !(θ <= Κ_CORRECTION * θ_last) {
                break;
            }
            θ_last = θ;
        }
        false
    }

    /// Takes the trial point, moves the multipliers, linearises.
    fn advance(&mut self, program: &mut impl Program, α: f64) {
        let α_dual = step_length(&self.point.dual, &self.step.dual, self.boundary_share());
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

    fn record(&self, errors: &Errors, step: f64) -> Record {
        Record {
            objective: self.values.objective,
            violation: errors.violation,
            error: errors.total(0.0),
            barrier: self.μ,
            regularisation: self.δ,
            step,
        }
    }

    fn finish(&self, status: Status, errors: &Errors, history: Vec<Record>) -> Solution {
        Solution {
            status,
            objective: self.values.objective,
            violation: errors.violation,
            error: errors.total(0.0),
            iterations: history.len() - 1,
            history,
        }
    }
}

/// Largest α in (0, 1] with `s + α ds >= (1 - τ) s`.
fn step_length(s: &[f64], ds: &[f64], τ: f64) -> f64 {
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
