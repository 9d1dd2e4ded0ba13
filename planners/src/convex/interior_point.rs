//! Mehrotra's predictor-corrector loop.

use super::backend::{Backend, NewtonSystem};
use super::point::{Pairs, Point};
use super::program::Program;
use super::progress::{Progress, Watch};
use super::solution::{Settings, Solution, Status};

/// Share of the tolerated gap at which the path's parameter stops falling: going on would only wear out the digits.
const CENTRE_FLOOR: f64 = 0.4;

/// Relative gap below which the weights are so far apart that directions want iterative refinement.
const REFINE_BELOW: f64 = 1e-4;

/// The customised interior-point method; holds every work vector, sized once for programmes of one shape.
#[derive(Clone, Debug)]
pub struct InteriorPoint {
    settings: Settings,
    newton: NewtonSystem,
    point: Point,
    affine: Point,
    step: Point,
    best: Vec<f64>,
}

impl InteriorPoint {
    /// Room for programmes with as many intervals, pins and planes as `program`.
    pub fn new(program: &Program, settings: Settings) -> Self {
        Self::with_backend(program, settings, Backend::Block)
    }

    /// The same with another way to the Newton direction.
    pub fn with_backend(program: &Program, settings: Settings, backend: Backend) -> Self {
        Self {
            settings,
            newton: NewtonSystem::new(program, backend),
            point: Point::zero(program),
            affine: Point::zero(program),
            step: Point::zero(program),
            best: vec![0.0; program.len()],
        }
    }

    /// Solves `program` from a cold start.
    pub fn solve(&mut self, program: &Program) -> Solution {
        if !program.is_well_posed() {
            return Solution::refused(program);
        }
        let solution = self.iterate(program);
        Solution { objective: solution.objective + program.offset, ..solution }
    }

    fn iterate(&mut self, program: &Program) -> Solution {
        self.newton.begin(program);
        let τ = self.start_parameter(program);
        self.point.start(program, τ);
        let mut watch = Watch::new(&self.settings);
        for iteration in 0..=self.settings.max_iterations {
            self.newton.residuals(program, &self.point);
            let now = self.progress(program);
            if watch.is_best(now) {
                self.best.copy_from_slice(&self.point.z);
            }
            if let Some(status) = watch.status() {
                return self.finish(status, watch.best(), iteration);
            }
            self.newton.factor(program, &self.point);
            let σμ = self.predict(program);
            self.correct(program, σμ);
            if self.wants_refinement(now) {
                self.newton.refine(program, &self.point, &mut self.step, &mut self.affine);
            }
            let (α_p, α_d) = Point::step_lengths(&self.newton.inverse, &self.step, self.settings.boundary_share);
            self.point.advance(program, &self.step, α_p, α_d);
        }
        self.finish(Status::IterationLimit, watch.best(), self.settings.max_iterations)
    }

    fn wants_refinement(&self, now: Progress) -> bool {
        now.gap < REFINE_BELOW || now.residual > 0.01 * self.settings.tolerance
    }

    /// τ of the start: on the scale of the products that the initial violations bring with them.
    fn start_parameter(&mut self, program: &Program) -> f64 {
        self.point.start(program, 1.0);
        let over = self.point.over.slack.iter().zip(&self.point.under.slack);
        let violation = over.map(|(p, n)| (p - n).abs()).fold(1e-3, f64::max);
        self.settings.start * program.penalty * violation
    }

    /// Affine direction (σ = 0); returns σ μ with σ = (μ_aff/μ)^3.
    fn predict(&mut self, program: &Program) -> f64 {
        for (target, at) in self.newton.target.pairs_mut().into_iter().zip(self.point.pairs()) {
            for (r, (s, v)) in target.slack.iter_mut().zip(at.slack.iter().zip(&at.dual)) {
                *r = -s * v;
            }
        }
        self.newton.direction(program, &self.point, &mut self.affine);
        let (α_p, α_d) = Point::step_lengths(&self.newton.inverse, &self.affine, 1.0);
        let before = self.point.complementarity();
        let after = self.point.complementarity_after(&self.affine, α_p, α_d);
        let σμ = (after.max(0.0) / before).powi(3) * before;
        let floor = CENTRE_FLOOR * self.settings.tolerance * self.objective(program).abs().max(1.0);
        σμ.max(floor) / self.point.len() as f64
    }

    /// Centred and corrected direction: the target becomes σ μ - s v - ds_aff dv_aff, the factors stay.
    fn correct(&mut self, program: &Program, σμ: f64) {
        let families = self.newton.target.pairs_mut().into_iter().zip(self.point.pairs()).zip(self.affine.pairs());
        for ((target, at), affine) in families {
            let products = at.slack.iter().zip(&at.dual).zip(affine.slack.iter().zip(&affine.dual));
            for (r, ((s, v), (ds, dv))) in target.slack.iter_mut().zip(products) {
                *r = σμ - s * v - ds * dv;
            }
        }
        self.newton.direction(program, &self.point, &mut self.step);
    }

    /// `q θ + μ (violations)` with the violations as the slacks p, n, β measure them.
    fn objective(&self, program: &Program) -> f64 {
        let violation = |pairs: &Pairs| pairs.slack.iter().sum::<f64>();
        let violations = violation(&self.point.over) + violation(&self.point.under) + violation(&self.point.excess);
        program.theta_cost * self.point.z[program.len() - 1] + program.penalty * violations
    }

    fn progress(&self, program: &Program) -> Progress {
        let objective = self.objective(program);
        let products = self.point.complementarity();
        let primal = largest(&self.newton.residual_equality).max(largest(&self.newton.residual_inequality));
        let dual = largest(&self.newton.residual_dual) / program.theta_cost.max(1.0);
        Progress { products, gap: products / objective.abs().max(1.0), residual: primal.max(dual), objective }
    }

    fn finish(&self, status: Status, best: Progress, iterations: usize) -> Solution {
        Solution {
            status,
            z: self.best.clone(),
            objective: best.objective,
            gap: best.gap,
            residual: best.residual,
            iterations,
        }
    }
}

/// Largest absolute value; infinite as soon as one of them is not finite.
fn largest(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |max, value| if value.is_finite() { value.abs().max(max) } else { f64::INFINITY })
}
