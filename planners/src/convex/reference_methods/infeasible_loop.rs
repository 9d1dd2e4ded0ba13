//! The paper's loop from an infeasible start: Mehrotra's predictor-corrector on P4, whose residuals r_d and r_p vanish
//! with the gap (Wang, Xu, Long 2020, section 4).

use super::inequality_form::InequalityForm;
use super::kkt_system::KktSystem;
use super::kkt_vectors::Direction;
use super::{Backend, new_system};
use crate::convex::program::Program;
use crate::convex::solution::{Settings, Solution, Status};

/// The loop and its workspace, which is kept from solve to solve.
#[derive(Clone, Debug)]
pub struct InfeasibleLoop {
    settings: Settings,
    method: Backend,
    /// `None` before the first program.
    kkt: Option<KktSystem>,
    x: Vec<f64>,
}

/// Relative measures of one iterate.
#[derive(Clone, Copy, Debug)]
struct Measures {
    /// g^T X.
    objective: f64,
    /// Largest of gap, residuals, and what the primal residual is worth in the objective.
    error: f64,
}

impl InfeasibleLoop {
    /// A loop with an empty workspace. Panics if `method` is not one of the paper's.
    pub fn new(settings: Settings, method: Backend) -> Self {
        assert!(method != Backend::Block, "the block factorisation keeps every iterate feasible");
        Self { settings, method, kkt: None, x: Vec::new() }
    }

    /// Solves one program.
    pub fn solve(&mut self, program: &Program) -> Solution {
        if !program.is_well_posed() {
            return Solution::refused(program);
        }
        let form = InequalityForm::new(program);
        match &mut self.kkt {
            Some(kkt) => kkt.set_form(form),
            None => self.kkt = Some(new_system(self.method, form)),
        }
        self.start();
        let mut measures = self.measure();
        let mut iterations = 0;
        while measures.error > self.settings.tolerance && iterations < self.settings.max_iterations {
            self.step();
            measures = self.measure();
            iterations += 1;
        }
        let status = match measures.error {
            error if error <= self.settings.tolerance => Status::Solved,
            error if error.is_finite() => Status::IterationLimit,
            _ => Status::Stalled,
        };
        let bounds = program.box_lower.iter().zip(&program.box_upper);
        let z = self
            .x
            .iter()
            .zip(bounds)
            .map(|(x, (&lower, &upper))| if x.is_nan() { lower } else { x.clamp(lower, upper) });
        Solution {
            status,
            z: z.collect(),
            objective: measures.objective + program.offset,
            gap: measures.error,
            iterations,
        }
    }

    /// Mehrotra's start [1992, section 7]: X and s of least |s| with s + A X = b, λ of least |λ| with g + A^T λ = 0, and
    /// both shifted until they are positive and their products are alike.
    fn start(&mut self) {
        let kkt = self.kkt.as_mut().expect("`solve` sets it");
        kkt.at.slack.fill(1.0);
        kkt.at.multiplier.fill(1.0);
        kkt.factor();
        // with S = Λ = I, dλ = A dX + r_p is -s for r_d = 0, r_p = -b, and λ for r_d = g, r_p = 0
        let cost = kkt.form().cost.clone();
        let minus_b: Vec<f64> = kkt.form().rhs.iter().map(|b| -b).collect();
        let no_cost = vec![0.0; cost.len()];
        let no_rhs = vec![0.0; minus_b.len()];
        let primal = kkt.direction_for(&no_cost, &minus_b);
        let dual = kkt.direction_for(&cost, &no_rhs);
        self.x.clone_from(&primal.x);
        kkt.at.slack = primal.multiplier.iter().map(|s| -s).collect();
        kkt.at.multiplier = dual.multiplier;
        for values in [&mut kkt.at.slack, &mut kkt.at.multiplier] {
            let min = values.iter().copied().fold(0.0, f64::min);
            values.iter_mut().for_each(|value| *value -= 1.5 * min);
        }
        let products: f64 = kkt.at.slack.iter().zip(&kkt.at.multiplier).map(|(s, λ)| s * λ).sum();
        let [sum_s, sum_λ] = [&kkt.at.slack, &kkt.at.multiplier].map(|values| values.iter().sum::<f64>());
        kkt.at.slack.iter_mut().for_each(|s| *s += 0.5 * products / sum_λ);
        kkt.at.multiplier.iter_mut().for_each(|λ| *λ += 0.5 * products / sum_s);
    }

    /// Sets the residuals r_d = g + A^T λ, r_p = s + A X - b and r_sl = S Λ e.
    fn measure(&mut self) -> Measures {
        let kkt = self.kkt.as_mut().expect("`solve` sets it");
        kkt.set_residuals(&self.x);
        let (form, residuals) = (kkt.form(), &kkt.residuals);
        let size = |values: &[f64]| values.iter().fold(1.0_f64, |max, value| max.max(value.abs()));
        let largest = |values: &[f64]| {
            values.iter().fold(0.0, |max, value| if value.abs() > max || value.is_nan() { value.abs() } else { max })
        };
        let objective: f64 = form.cost.iter().zip(&self.x).map(|(g, x)| g * x).sum();
        let gap = residuals.product.iter().sum::<f64>() / objective.abs().max(1.0);
        let [dual, primal] = [(&residuals.dual, &form.cost), (&residuals.primal, &form.rhs)]
            .map(|(residual, data)| largest(residual) / size(data));
        // With multipliers up to the penalty weights a small residual is worth a lot.
        let worth = kkt.at.multiplier.iter().zip(&residuals.primal).map(|(λ, r_p)| λ * r_p).sum::<f64>().abs()
            / objective.abs().max(1.0);
        let measures = [gap, dual, primal, worth];
        let error = if measures.iter().any(|it| it.is_nan()) { f64::NAN } else { largest(&measures) };
        Measures { objective, error }
    }

    /// One predictor-corrector step; the residuals must be current.
    fn step(&mut self) {
        let τ = self.settings.boundary_fraction;
        let kkt = self.kkt.as_mut().expect("`solve` sets it");
        kkt.factor();
        kkt.solve();
        kkt.refine();
        let [α_p, α_d] = max_steps(kkt, 1.0);
        let μ = kkt.at.mean_product();
        let affine = &kkt.direction;
        let pairs = kkt.at.slack.iter().zip(&kkt.at.multiplier).zip(affine.slack.iter().zip(&affine.multiplier));
        let after: f64 = pairs.map(|((s, λ), (ds, dλ))| (s + α_p * ds) * (λ + α_d * dλ)).sum();
        let μ_aff = after / kkt.at.slack.len() as f64;
        let σμ = (μ_aff / μ).powi(3) * μ;
        for (r_sl, (ds, dλ)) in kkt.residuals.product.iter_mut().zip(affine.slack.iter().zip(&affine.multiplier)) {
            *r_sl += ds * dλ - σμ;
        }
        kkt.solve();
        kkt.refine();
        let [α_p, α_d] = max_steps(kkt, τ);
        let Direction { x, multiplier, slack } = &kkt.direction;
        add(&mut self.x, α_p, x);
        add(&mut kkt.at.slack, α_p, slack);
        add(&mut kkt.at.multiplier, α_d, multiplier);
    }
}

/// Largest steps at most 1 that use at most the fraction `τ` of the distance to s = 0, and to λ = 0.
fn max_steps(kkt: &KktSystem, τ: f64) -> [f64; 2] {
    let step = |values: &[f64], direction: &[f64]| {
        let decrease = values.iter().zip(direction).map(|(value, step)| -step / value).fold(0.0, f64::max);
        (τ / decrease).min(1.0)
    };
    [step(&kkt.at.slack, &kkt.direction.slack), step(&kkt.at.multiplier, &kkt.direction.multiplier)]
}

fn add(values: &mut [f64], α: f64, steps: &[f64]) {
    for (value, step) in values.iter_mut().zip(steps) {
        *value += α * step;
    }
}
