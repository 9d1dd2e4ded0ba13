//! One Newton direction of the perturbed optimality conditions: what a factorisation needs, and what follows from it.
//!
//! With targets r for the products of each family of pairs (s dv + v ds = r), elimination leaves
//!
//! ```text
//! H dz + E^T dy = r_z        H = V_u/U + V_l/L + F^T Ω_F^-1 F,    Ω_F = T/λ + β/(μ - λ)
//! E dz - Ω_E dy = r_y        Ω_E = P/(μ - y) + N/(μ + y)
//! ```

use super::block::{BlockSystem, Weights};
use super::point::{Point, dual_sum};
use super::program::{LINK, Program};

/// Added to every ω, so that a row that holds exactly does not swallow the digits of the others; refinement makes up
/// for it.
const REGULARISATION: f64 = 1e-12;

/// Index among the families of [`Point::pairs`] from which on they belong to the box, where the slack of a step is known
/// first and the dual follows.
const BOXES: usize = 4;

/// Newton system of one iterate, its factorisation and its work vectors.
#[derive(Clone, Debug)]
pub struct Newton {
    system: BlockSystem,
    weights: Weights,
    /// Targets r of the products, in the slacks of a point (the duals are unused).
    pub target: Point,
    /// Reciprocals of the slacks and duals of the iterate that was factored last.
    pub inverse: Point,
    /// Ω_E^-1 of the pins; Ω_F^-1 of all inequalities.
    pin_weights: Vec<f64>,
    inequality_weights: Vec<f64>,
    /// Residuals of E z - d = p - n, F z - g = β - t, and of the dual equation.
    pub residual_equality: Vec<f64>,
    pub residual_inequality: Vec<f64>,
    pub residual_dual: Vec<f64>,
    /// Right-hand sides of the rows after the pairs have been eliminated.
    rhs_equality: Vec<f64>,
    rhs_inequality: Vec<f64>,
    dy: Vec<f64>,
    dλ: Vec<f64>,
}

impl Newton {
    /// Room for programmes like `program`.
    pub fn new(program: &Program) -> Self {
        let (n_z, n_eq, n_in) = (program.len(), program.equalities(), program.inequalities());
        Self {
            system: BlockSystem::new(program.intervals()),
            weights: Weights {
                diagonal: vec![0.0; n_z],
                planes: vec![0.0; program.planes.len()],
                links: vec![0.0; LINK * program.intervals()],
            },
            target: Point::zero(program),
            inverse: Point::zero(program),
            pin_weights: vec![0.0; program.pins.len()],
            inequality_weights: vec![0.0; n_in],
            residual_equality: vec![0.0; n_eq],
            residual_inequality: vec![0.0; n_in],
            residual_dual: vec![0.0; n_z],
            rhs_equality: vec![0.0; n_eq],
            rhs_inequality: vec![0.0; n_in],
            dy: vec![0.0; n_eq],
            dλ: vec![0.0; n_in],
        }
    }

    /// Residuals of the linear equations at `point`.
    pub fn residuals(&mut self, program: &Program, point: &Point) {
        program.equality_values(&point.z, &mut self.residual_equality);
        for (i, d) in program.equality_rhs().enumerate() {
            self.residual_equality[i] = d + point.over.slack[i] - point.under.slack[i] - self.residual_equality[i];
        }
        program.inequality_values(&point.z, &mut self.residual_inequality);
        for (i, g) in program.inequality_rhs().enumerate() {
            self.residual_inequality[i] = g + point.excess.slack[i] - point.gap.slack[i] - self.residual_inequality[i];
        }
        for (y, multiplier) in self.dy.iter_mut().zip(point.multipliers()) {
            *y = multiplier;
        }
        dual_sum(program, &self.dy, &point.gap.dual, &mut self.residual_dual);
        for (i, residual) in self.residual_dual.iter_mut().enumerate() {
            *residual += point.upper.dual[i] - point.lower.dual[i];
        }
    }

    /// Forms the matrix at `point` and factors it.
    pub fn factor(&mut self, program: &Program, point: &Point) {
        self.inverse.set_inverse(point);
        let inverse = &self.inverse;
        let gaps = point.gap.slack.iter().zip(&inverse.gap.dual);
        let excesses = point.excess.slack.iter().zip(&inverse.excess.dual);
        for (weight, ((t, λ_inverse), (β, κ_inverse))) in self.inequality_weights.iter_mut().zip(gaps.zip(excesses))
        {
            *weight = 1.0 / (t * λ_inverse + β * κ_inverse + REGULARISATION);
        }
        let (upper, rest) = self.inequality_weights.split_at(program.len());
        let (lower, planes) = rest.split_at(program.len());
        for (i, diagonal) in self.weights.diagonal.iter_mut().enumerate() {
            let boxes = point.upper.dual[i] * inverse.upper.slack[i] + point.lower.dual[i] * inverse.lower.slack[i];
            *diagonal = boxes + upper[i] + lower[i];
        }
        self.weights.planes.copy_from_slice(planes);
        let ω_equality = |i: usize| {
            let over = point.over.slack[i] * inverse.over.dual[i];
            over + point.under.slack[i] * inverse.under.dual[i] + REGULARISATION
        };
        for (i, ω) in self.weights.links.iter_mut().enumerate() {
            *ω = ω_equality(i);
        }
        let links = self.weights.links.len();
        for (i, (pin, weight)) in program.pins.iter().zip(&mut self.pin_weights).enumerate() {
            *weight = 1.0 / ω_equality(links + i);
            self.weights.diagonal[pin.index] += *weight;
        }
        self.system.factor(program, &self.weights);
    }

    /// One step of iterative refinement: what `step` leaves of the linear equations is solved for once more.
    ///
    /// The complementarity rows hold to rounding by construction; the others lose digits where a stiff row's multiplier
    /// follows from a small difference.
    pub fn refine(&mut self, program: &Program, point: &Point, step: &mut Point, correction: &mut Point) {
        self.remainder(program, step);
        for pairs in self.target.pairs_mut() {
            pairs.slack.fill(0.0);
        }
        self.direction(program, point, correction);
        add(&mut step.z, &correction.z);
        for (step, correction) in step.pairs_mut().into_iter().zip(correction.pairs()) {
            add(&mut step.slack, &correction.slack);
            add(&mut step.dual, &correction.dual);
        }
    }

    /// Residuals of the linear equations after `step`, in place of those before it.
    fn remainder(&mut self, program: &Program, step: &Point) {
        program.equality_values(&step.z, &mut self.rhs_equality);
        for (i, residual) in self.residual_equality.iter_mut().enumerate() {
            *residual += step.over.slack[i] - step.under.slack[i] - self.rhs_equality[i];
            self.dy[i] = step.under.dual[i];
        }
        program.inequality_values(&step.z, &mut self.rhs_inequality);
        for (i, residual) in self.residual_inequality.iter_mut().enumerate() {
            *residual += step.excess.slack[i] - step.gap.slack[i] - self.rhs_inequality[i];
        }
        program.add_equality_duals(&self.dy, &mut self.residual_dual);
        program.add_inequality_duals(&step.gap.dual, &mut self.residual_dual);
        for (i, residual) in self.residual_dual.iter_mut().enumerate() {
            *residual += step.upper.dual[i] - step.lower.dual[i];
        }
    }

    /// Direction for the present targets, with the factors at hand.
    pub fn direction(&mut self, program: &Program, point: &Point, step: &mut Point) {
        self.reduce();
        self.right_hand_side(program, &mut step.z);
        let links = LINK * program.intervals();
        self.dy[..links].copy_from_slice(&self.rhs_equality[..links]);
        self.system.solve(program, &mut step.z, &mut self.dy[..links]);
        for (i, pin) in program.pins.iter().enumerate() {
            let row = links + i;
            self.dy[row] = (step.z[pin.index] - self.rhs_equality[row]) * self.pin_weights[i];
        }
        self.recover(program, point, step);
    }

    /// Right-hand sides of the rows: `E dz - Ω_E dy = rhs`, `F dz - Ω_F dλ = rhs`.
    fn reduce(&mut self) {
        let (r, inverse) = (&self.target, &self.inverse);
        set_difference(
            &mut self.rhs_equality,
            [&r.over.slack, &inverse.over.dual],
            [&r.under.slack, &inverse.under.dual],
            &self.residual_equality,
        );
        set_difference(
            &mut self.rhs_inequality,
            [&r.excess.slack, &inverse.excess.dual],
            [&r.gap.slack, &inverse.gap.dual],
            &self.residual_inequality,
        );
    }

    /// r_z, with the pins eliminated like the inequalities.
    fn right_hand_side(&mut self, program: &Program, r_z: &mut [f64]) {
        let (r, inverse) = (&self.target, &self.inverse);
        for (r_z, residual) in r_z.iter_mut().zip(&self.residual_dual) {
            *r_z = -residual;
        }
        add_difference(r_z, [&r.lower.slack, &inverse.lower.slack], [&r.upper.slack, &inverse.upper.slack]);
        for ((dλ, rhs), weight) in self.dλ.iter_mut().zip(&self.rhs_inequality).zip(&self.inequality_weights) {
            *dλ = rhs * weight;
        }
        program.add_inequality_duals(&self.dλ, r_z);
        let links = LINK * program.intervals();
        for (i, pin) in program.pins.iter().enumerate() {
            r_z[pin.index] += self.rhs_equality[links + i] * self.pin_weights[i];
        }
    }

    /// Slacks and duals of the direction from dz and dy.
    fn recover(&mut self, program: &Program, point: &Point, step: &mut Point) {
        let (target, inverse) = (&self.target, &self.inverse);
        set_signed(&mut step.under.dual, &mut step.over.dual, &self.dy);
        program.inequality_values(&step.z, &mut self.dλ);
        let rows = self.rhs_inequality.iter().zip(&self.inequality_weights);
        for (dλ, (rhs, weight)) in self.dλ.iter_mut().zip(rows) {
            *dλ = (*dλ - rhs) * weight;
        }
        set_signed(&mut step.gap.dual, &mut step.excess.dual, &self.dλ);
        set_signed(&mut step.lower.slack, &mut step.upper.slack, &step.z);
        let [targets, points, inverses] = [target.pairs(), point.pairs(), inverse.pairs()];
        for (i, step) in step.pairs_mut().into_iter().enumerate() {
            let (target, point, inverse) = (targets[i], points[i], inverses[i]);
            if i < BOXES {
                complement(&mut step.slack, &target.slack, &point.slack, &step.dual, &inverse.dual);
            } else {
                complement(&mut step.dual, &target.slack, &point.dual, &step.slack, &inverse.slack);
            }
        }
    }
}

/// `plus <- values`, `minus <- -values`.
fn set_signed(plus: &mut [f64], minus: &mut [f64], values: &[f64]) {
    for ((plus, minus), value) in plus.iter_mut().zip(minus).zip(values) {
        *plus = *value;
        *minus = -*value;
    }
}

/// The unknown half of a step of pairs: `s dv + v ds = r` gives `ds = (r - s dv) / v`, and dv likewise.
fn complement(out: &mut [f64], r: &[f64], at: &[f64], by: &[f64], inverse: &[f64]) {
    let known = r.iter().zip(at).zip(by.iter().zip(inverse));
    for (out, ((r, at), (by, inverse))) in out.iter_mut().zip(known) {
        *out = (r - at * by) * inverse;
    }
}

/// `out <- a b - c d + e`.
fn set_difference(out: &mut [f64], [a, b]: [&[f64]; 2], [c, d]: [&[f64]; 2], e: &[f64]) {
    let terms = a.iter().zip(b).zip(c.iter().zip(d)).zip(e);
    for (out, (((a, b), (c, d)), e)) in out.iter_mut().zip(terms) {
        *out = a * b - c * d + e;
    }
}

/// `out += a b - c d`.
fn add_difference(out: &mut [f64], [a, b]: [&[f64]; 2], [c, d]: [&[f64]; 2]) {
    let terms = a.iter().zip(b).zip(c.iter().zip(d));
    for (out, ((a, b), (c, d))) in out.iter_mut().zip(terms) {
        *out += a * b - c * d;
    }
}

fn add(value: &mut [f64], increment: &[f64]) {
    for (value, increment) in value.iter_mut().zip(increment) {
        *value += increment;
    }
}
