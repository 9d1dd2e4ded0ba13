use super::barrier::{self, OptimalityErrors};
use super::iterate::{Start, WarmStart};
use super::newton::max_norm;
use super::program::Program;
use super::solution::{IterationRecord, Settings, Solution, Status};
use super::state::State;

/// Regularisation δ of the Hessian's diagonal (Wächter and Biegler 2006, algorithm IC): first trial, minimum, maximum,
/// and the factors by which it changes.
const Δ_FIRST: f64 = 1e-2;
const Δ_MIN: f64 = 1e-12;
const Δ_MAX: f64 = 1e10;
const GROWTH_FIRST: f64 = 100.0;
const GROWTH: f64 = 8.0;
const DECAY: f64 = 1.0 / 3.0;

/// Consecutive failures of the line search, each followed by a larger δ, after which the run counts as stalled.
const MAX_LINE_SEARCH_FAILURES: usize = 12;

/// The method, with its work vectors for programs of one size.
#[derive(Clone, Debug)]
pub struct InteriorPoint {
    settings: Settings,
    state: State,
    work: Vec<f64>,
    /// Regularisation of the present factors, of the last ones that needed any, and the minimum for the next ones.
    δ: f64,
    δ_last: f64,
    δ_min: f64,
}

impl InteriorPoint {
    /// Work vectors for `program`, whose bounds must not change afterwards.
    pub fn new(program: &impl Program, settings: Settings) -> Self {
        let work = vec![0.0; program.sizes().variables];
        Self { settings, state: State::new(program), work, δ: 0.0, δ_last: 0.0, δ_min: 0.0 }
    }

    /// Variables of the last iterate.
    pub fn x(&self) -> &[f64] {
        &self.state.point.x
    }

    /// The last iterate, for a warm start of a similar program.
    pub fn warm_start(&self) -> WarmStart {
        let State { bounds, point, .. } = &self.state;
        let mut z = [vec![0.0; point.x.len()], vec![0.0; point.x.len()]];
        for (bound, dual) in bounds.0.iter().zip(&point.dual) {
            z[usize::from(bound.sign < 0.0)][bound.index] = *dual;
        }
        WarmStart { x: point.x.clone(), y: point.y.clone(), v: point.dual[bounds.0.len()..].to_vec(), z }
    }

    /// Solves `program` from `start`.
    pub fn solve(&mut self, program: &mut impl Program, start: &Start) -> Solution {
        (self.δ_last, self.δ_min) = (0.0, 0.0);
        self.state.initialise(program, start, &self.settings);
        let mut history = Vec::with_capacity(64);
        let (mut α, mut failures) = (0.0, 0);
        loop {
            let State { bounds, point, values, .. } = &self.state;
            let errors = OptimalityErrors::at(program, bounds, point, values, &mut self.work);
            history.push(self.record(&errors, α));
            if let Some(status) = self.termination(&errors, history.len() - 1, failures) {
                return self.finish(status, &errors, history);
            }
            self.update_barrier(&errors);
            if !self.factor(program) {
                return self.finish(Status::Stalled, &errors, history);
            }
            self.state.compute_step(program);
            if let Some(length) = self.state.line_search(program) {
                α = length;
                (failures, self.δ_min) = (0, 0.0);
                self.state.advance(program, length);
            } else {
                α = 0.0;
                failures += 1;
                self.δ_min = GROWTH * self.δ.max(Δ_FIRST);
                self.state.filter.clear();
            }
        }
    }

    fn termination(&self, errors: &OptimalityErrors, iterations: usize, failures: usize) -> Option<Status> {
        let is_finite = max_norm(&self.state.values.gradient).is_finite()
            && errors.violation.is_finite()
            && errors.dual.is_finite();
        if !is_finite {
            Some(Status::NotFinite)
        } else if errors.total(0.0) <= self.settings.tolerance {
            Some(Status::Solved)
        } else if iterations >= self.settings.max_iterations {
            Some(Status::IterationLimit)
        } else {
            (failures > MAX_LINE_SEARCH_FAILURES).then_some(Status::Stalled)
        }
    }

    fn update_barrier(&mut self, errors: &OptimalityErrors) {
        let μ = barrier::next_barrier(self.state.μ, errors, &self.settings);
        if μ < self.state.μ {
            self.state.μ = μ;
            self.state.filter.clear();
        }
    }

    /// Factors with the smallest trial δ for which the inertia is correct (ibid., algorithm IC); false if there is
    /// none.
    fn factor(&mut self, program: &mut impl Program) -> bool {
        self.δ = self.δ_min;
        let is_first = self.δ_last == 0.0;
        while self.δ <= Δ_MAX {
            if self.state.newton.factor(program, &self.state.bounds, &self.state.point, self.δ) {
                if self.δ > 0.0 {
                    self.δ_last = self.δ;
                }
                return true;
            }
            self.δ = match (self.δ == 0.0, is_first) {
                (true, true) => Δ_FIRST,
                (true, false) => (DECAY * self.δ_last).max(Δ_MIN),
                (false, true) => GROWTH_FIRST * self.δ,
                (false, false) => GROWTH * self.δ,
            };
        }
        false
    }

    fn record(&self, errors: &OptimalityErrors, step: f64) -> IterationRecord {
        IterationRecord {
            objective: self.state.values.objective,
            violation: errors.violation,
            error: errors.total(0.0),
            barrier: self.state.μ,
            regularisation: self.δ,
            step,
        }
    }

    fn finish(&self, status: Status, errors: &OptimalityErrors, history: Vec<IterationRecord>) -> Solution {
        Solution {
            status,
            objective: self.state.values.objective,
            violation: errors.violation,
            error: errors.total(0.0),
            iterations: history.len() - 1,
            history,
        }
    }
}
