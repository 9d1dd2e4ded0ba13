use super::barrier::{self, Errors};
use super::filter::Filter;
use super::iterate::{Iterate, Sides, Start, Warm};
use super::line_search::{Search, step_length};
use super::newton::{Newton, Values, largest};
use super::program::Program;
use super::solution::{Record, Settings, Solution, Status};

/// Bounds on how far duals may leave the central path (Wächter and Biegler 2006, eq. 16).
const Κ_SIGMA: f64 = 1e10;

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
    pub(super) settings: Settings,
    pub(super) sides: Sides,
    pub(super) newton: Newton,
    pub(super) filter: Filter,
    pub(super) point: Iterate,
    pub(super) trial: Iterate,
    pub(super) step: Iterate,
    pub(super) corrected: Iterate,
    pub(super) values: Values,
    pub(super) trial_values: Values,
    pub(super) c: Vec<f64>,
    pub(super) excess: Vec<f64>,
    work: Vec<f64>,
    pub(super) μ: f64,
    δ: f64,
    δ_last: f64,
    δ_least: f64,
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
    pub fn warm_start(&self) -> Warm {
        let bounds = self.sides.0.len();
        let mut z = [vec![0.0; self.point.x.len()], vec![0.0; self.point.x.len()]];
        for (side, dual) in self.sides.0.iter().zip(&self.point.dual) {
            z[usize::from(side.sign < 0.0)][side.index] = *dual;
        }
        Warm { x: self.point.x.clone(), y: self.point.y.clone(), v: self.point.dual[bounds..].to_vec(), z }
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
        self.point = Iterate::begin(program, &self.sides, start, (self.μ, self.settings.push));
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
