//! The primal-dual iterate.

use super::program::Program;
use super::reductions::{largest, sum};

/// A family of complementary pairs: slacks and duals, all > 0 at an iterate (of any sign in a direction).
#[derive(Clone, Debug, Default)]
pub struct Pairs {
    /// Slacks.
    pub slack: Vec<f64>,
    /// Their duals.
    pub dual: Vec<f64>,
}

impl Pairs {
    fn zero(length: usize) -> Self {
        Self { slack: vec![0.0; length], dual: vec![0.0; length] }
    }

    /// Becomes the reciprocals of `pairs`.
    fn set_inverse(&mut self, pairs: &Pairs) {
        for (inverse, value) in self.slack.iter_mut().zip(&pairs.slack) {
            *inverse = 1.0 / value;
        }
        for (inverse, value) in self.dual.iter_mut().zip(&pairs.dual) {
            *inverse = 1.0 / value;
        }
    }
}

/// z with every slack and dual; also the form of a Newton direction.
#[derive(Clone, Debug)]
pub struct Point {
    /// Variables.
    pub z: Vec<f64>,
    /// p ⟂ μ - y of the equalities.
    pub over: Pairs,
    /// n ⟂ μ + y of the equalities.
    pub under: Pairs,
    /// t ⟂ λ of the inequalities.
    pub gap: Pairs,
    /// β ⟂ μ - λ of the inequalities.
    pub excess: Pairs,
    /// u ⟂ v_u of the box.
    pub upper: Pairs,
    /// l ⟂ v_l of the box.
    pub lower: Pairs,
}

impl Point {
    /// Room for an iterate of `program`.
    pub fn zero(program: &Program) -> Self {
        let (n_z, n_eq, n_in) = (program.len(), program.equalities(), program.inequalities());
        Self {
            z: vec![0.0; n_z],
            over: Pairs::zero(n_eq),
            under: Pairs::zero(n_eq),
            gap: Pairs::zero(n_in),
            excess: Pairs::zero(n_in),
            upper: Pairs::zero(n_z),
            lower: Pairs::zero(n_z),
        }
    }

    /// Every family of pairs.
    pub fn pairs(&self) -> [&Pairs; 6] {
        [&self.over, &self.under, &self.gap, &self.excess, &self.upper, &self.lower]
    }

    /// Every family of pairs, to change.
    pub fn pairs_mut(&mut self) -> [&mut Pairs; 6] {
        [&mut self.over, &mut self.under, &mut self.gap, &mut self.excess, &mut self.upper, &mut self.lower]
    }

    /// Becomes the reciprocals of every slack and dual of `point`; z stays.
    pub fn set_inverse(&mut self, point: &Point) {
        for (inverse, pairs) in self.pairs_mut().into_iter().zip(point.pairs()) {
            inverse.set_inverse(pairs);
        }
    }

    /// Sum of all complementarity products: the duality gap of a feasible point.
    pub fn complementarity(&self) -> f64 {
        self.pairs().into_iter().map(|pairs| sum(&pairs.slack, &pairs.dual, |s, v| s * v)).sum()
    }

    /// Number of complementary pairs n_A.
    pub fn len(&self) -> usize {
        self.pairs().into_iter().map(|pairs| pairs.slack.len()).sum()
    }

    /// Sum of products after steps `α_p`, `α_d` along `step`:
    /// s^T v + α_p ds^T v + α_d s^T dv + α_p α_d ds^T dv.
    pub fn complementarity_after(&self, step: &Point, α_p: f64, α_d: f64) -> f64 {
        let product = |a: &[f64], b: &[f64]| sum(a, b, |a, b| a * b);
        let families = self.pairs().into_iter().zip(step.pairs());
        let changes = families.map(|(at, by)| {
            α_p * product(&by.slack, &at.dual)
                + α_d * product(&at.slack, &by.dual)
                + α_p * α_d * product(&by.slack, &by.dual)
        });
        self.complementarity() + changes.sum::<f64>()
    }

    /// Largest steps (α_p, α_d) in (0, 1] along `step` that leave every slack and every dual at least `1 - τ` of its
    /// value, `inverse` being the reciprocals of this point.
    pub fn step_lengths(inverse: &Point, step: &Point, τ: f64) -> (f64, f64) {
        let (mut slack, mut dual) = (0.0_f64, 0.0_f64);
        for (inverse, by) in inverse.pairs().into_iter().zip(step.pairs()) {
            slack = slack.max(largest(&inverse.slack, &by.slack, |inverse, ds| -ds * inverse));
            dual = dual.max(largest(&inverse.dual, &by.dual, |inverse, dv| -dv * inverse));
        }
        ((τ / slack).min(1.0), (τ / dual).min(1.0))
    }

    /// The step `z + α_p dz`, slacks likewise, duals by `α_d`; then the identities that tie slacks and duals together
    /// (u + l = hi - lo, λ + κ = μ, ...) are restored to rounding: the smaller of two is kept, the larger follows.
    pub fn advance(&mut self, program: &Program, step: &Point, α_p: f64, α_d: f64) {
        for (at, by) in self.pairs_mut().into_iter().zip(step.pairs()) {
            add_scaled(&mut at.slack, α_p, &by.slack);
            add_scaled(&mut at.dual, α_d, &by.dual);
        }
        for (over, under) in self.over.dual.iter_mut().zip(&mut self.under.dual) {
            keep_sum(over, under, 2.0 * program.penalty);
        }
        for (gap, excess) in self.gap.dual.iter_mut().zip(&mut self.excess.dual) {
            keep_sum(gap, excess, program.penalty);
        }
        let slacks = self.upper.slack.iter_mut().zip(&mut self.lower.slack);
        let bounds = program.box_lower.iter().zip(&program.box_upper);
        for ((z, (u, l)), (lower, upper)) in self.z.iter_mut().zip(slacks).zip(bounds) {
            keep_sum(u, l, upper - lower);
            *z = if *u < *l { upper - *u } else { lower + *l };
        }
    }

    /// A strictly feasible start: z in the middle of the trust region, elastic slacks on the central path of parameter
    /// `τ`, and box duals that take up what is left of the dual equation.
    pub fn start(&mut self, program: &Program, τ: f64) {
        let μ = program.penalty;
        for (z, (lower, upper)) in self.z.iter_mut().zip(program.box_lower.iter().zip(&program.box_upper)) {
            *z = 0.5 * (lower + upper);
        }
        program.equality_values(&self.z, &mut self.over.slack);
        for (i, d) in program.equality_rhs().enumerate() {
            let h = self.over.slack[i] - d;
            let (p, n) = central_equality(h, μ, τ);
            (self.over.slack[i], self.over.dual[i]) = (p, τ / p);
            (self.under.slack[i], self.under.dual[i]) = (n, τ / n);
            keep_sum(&mut self.over.dual[i], &mut self.under.dual[i], 2.0 * μ);
        }
        program.inequality_values(&self.z, &mut self.gap.slack);
        for (i, g) in program.inequality_rhs().enumerate() {
            let f = self.gap.slack[i] - g;
            let (t, β) = central_inequality(f, μ, τ);
            (self.gap.slack[i], self.gap.dual[i]) = (t, τ / t);
            (self.excess.slack[i], self.excess.dual[i]) = (β, τ / β);
            keep_sum(&mut self.gap.dual[i], &mut self.excess.dual[i], μ);
        }
        self.start_box(program, τ);
    }

    fn start_box(&mut self, program: &Program, τ: f64) {
        let mut residual = vec![0.0; self.z.len()];
        let y: Vec<f64> = self.multipliers().collect();
        dual_sum(program, &y, &self.gap.dual, &mut residual);
        for (i, r) in residual.into_iter().enumerate() {
            let half = 0.5 * (program.box_upper[i] - program.box_lower[i]);
            (self.upper.slack[i], self.lower.slack[i]) = (half, half);
            // v_u v_l = (τ/half)^2 with v_l - v_u = r
            let base = τ / half;
            let smaller = base * base / (0.5 * r.abs() + (0.25 * r * r + base * base).sqrt());
            let (large, small) = (r.abs() + smaller, smaller);
            (self.upper.dual[i], self.lower.dual[i]) = if r < 0.0 { (large, small) } else { (small, large) };
        }
    }

    /// Multipliers y of the equalities, from μ + y and μ - y.
    pub fn multipliers(&self) -> impl Iterator<Item = f64> + '_ {
        self.under.dual.iter().zip(&self.over.dual).map(|(plus, minus)| 0.5 * (plus - minus))
    }
}

/// `out = q e_θ + E^T y + F^T λ`.
pub fn dual_sum(program: &Program, y: &[f64], λ: &[f64], out: &mut [f64]) {
    out.fill(0.0);
    out[program.len() - 1] = program.theta_cost;
    program.add_equality_duals(y, out);
    program.add_inequality_duals(λ, out);
}

/// p, n > 0 with p - n = h and τ/p + τ/n = 2 μ.
fn central_equality(h: f64, μ: f64, τ: f64) -> (f64, f64) {
    // the smaller of the two, x, solves x^2 + x (|h| - τ/μ) = |h| τ/(2 μ)
    let (h_abs, ratio) = (h.abs(), τ / μ);
    let b = h_abs - ratio;
    let root = (b * b + 2.0 * h_abs * ratio).sqrt();
    let smaller = if b > 0.0 { h_abs * ratio / (b + root) } else { 0.5 * (root - b) };
    if h > 0.0 { (h_abs + smaller, smaller) } else { (smaller, h_abs + smaller) }
}

/// t, β > 0 with β - t = f and τ/t + τ/β = μ.
fn central_inequality(f: f64, μ: f64, τ: f64) -> (f64, f64) {
    let (β, t) = central_equality(f, 0.5 * μ, τ);
    (t, β)
}

fn keep_sum(a: &mut f64, b: &mut f64, sum: f64) {
    if *a < *b {
        *b = sum - *a;
    } else {
        *a = sum - *b;
    }
}

fn add_scaled(value: &mut [f64], factor: f64, step: &[f64]) {
    for (value, step) in value.iter_mut().zip(step) {
        *value += factor * step;
    }
}

#[cfg(test)]
mod tests {
    use super::{central_equality, central_inequality};

    #[test]
    fn central_slacks_solve_their_equations() {
        for h in [-3.0, -1e-6, 0.0, 1e-9, 0.4, 200.0] {
            for τ in [1e-6, 1.0, 1e4] {
                let (p, n) = central_equality(h, 1000.0, τ);
                assert!(p > 0.0 && n > 0.0);
                assert!((p - n - h).abs() <= 1e-12 * (1.0 + h.abs()));
                assert!((τ / p + τ / n - 2000.0).abs() < 1e-6 * 2000.0, "h {h} τ {τ}");
                let (t, β) = central_inequality(h, 1000.0, τ);
                assert!((β - t - h).abs() <= 1e-12 * (1.0 + h.abs()));
                assert!((τ / t + τ / β - 1000.0).abs() < 1e-6 * 1000.0);
            }
        }
    }
}
