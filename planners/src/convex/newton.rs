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

/// Newton system of one iterate, its factorisation and its work vectors.
#[derive(Clone, Debug)]
pub struct Newton {
    system: BlockSystem,
    weights: Weights,
    /// Targets r of the products, in the slacks of a point (the duals are unused).
    pub target: Point,
    /// Ω_E of all equalities; Ω_F of all inequalities.
    ω_equality: Vec<f64>,
    ω_inequality: Vec<f64>,
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
            ω_equality: vec![0.0; n_eq],
            ω_inequality: vec![0.0; n_in],
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
        for (i, ω) in self.ω_equality.iter_mut().enumerate() {
            *ω = point.over.slack[i] / point.over.dual[i] + point.under.slack[i] / point.under.dual[i] + REGULARISATION;
        }
        for (i, ω) in self.ω_inequality.iter_mut().enumerate() {
            *ω = point.gap.slack[i] / point.gap.dual[i] + point.excess.slack[i] / point.excess.dual[i] + REGULARISATION;
        }
        let n_z = program.len();
        let (ω_upper, rest) = self.ω_inequality.split_at(n_z);
        let (ω_lower, ω_planes) = rest.split_at(n_z);
        for (i, diagonal) in self.weights.diagonal.iter_mut().enumerate() {
            let boxes = point.upper.dual[i] / point.upper.slack[i] + point.lower.dual[i] / point.lower.slack[i];
            *diagonal = boxes + 1.0 / ω_upper[i] + 1.0 / ω_lower[i];
        }
        for (weight, ω) in self.weights.planes.iter_mut().zip(ω_planes) {
            *weight = 1.0 / ω;
        }
        let (ω_links, ω_pins) = self.ω_equality.split_at(LINK * program.intervals());
        self.weights.links.copy_from_slice(ω_links);
        for (pin, ω) in program.pins.iter().zip(ω_pins) {
            self.weights.diagonal[pin.index] += 1.0 / ω;
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
        self.reduce(point);
        self.right_hand_side(program, point, &mut step.z);
        let links = LINK * program.intervals();
        self.dy[..links].copy_from_slice(&self.rhs_equality[..links]);
        self.system.solve(program, &mut step.z, &mut self.dy[..links]);
        for (i, pin) in program.pins.iter().enumerate() {
            let row = links + i;
            self.dy[row] = (step.z[pin.index] - self.rhs_equality[row]) / self.ω_equality[row];
        }
        self.recover(program, point, step);
    }

    /// Right-hand sides of the rows: `E dz - Ω_E dy = rhs`, `F dz - Ω_F dλ = rhs`.
    fn reduce(&mut self, point: &Point) {
        let target = &self.target;
        for (i, rhs) in self.rhs_equality.iter_mut().enumerate() {
            *rhs = target.over.slack[i] / point.over.dual[i] - target.under.slack[i] / point.under.dual[i]
                + self.residual_equality[i];
        }
        for (i, rhs) in self.rhs_inequality.iter_mut().enumerate() {
            *rhs = target.excess.slack[i] / point.excess.dual[i] - target.gap.slack[i] / point.gap.dual[i]
                + self.residual_inequality[i];
        }
    }

    /// r_z, with the pins eliminated like the inequalities.
    fn right_hand_side(&mut self, program: &Program, point: &Point, r_z: &mut [f64]) {
        for (i, r) in r_z.iter_mut().enumerate() {
            *r = self.target.lower.slack[i] / point.lower.slack[i]
                - self.target.upper.slack[i] / point.upper.slack[i]
                - self.residual_dual[i];
        }
        for ((dλ, rhs), ω) in self.dλ.iter_mut().zip(&self.rhs_inequality).zip(&self.ω_inequality) {
            *dλ = rhs / ω;
        }
        program.add_inequality_duals(&self.dλ, r_z);
        let links = LINK * program.intervals();
        for (i, pin) in program.pins.iter().enumerate() {
            r_z[pin.index] += self.rhs_equality[links + i] / self.ω_equality[links + i];
        }
    }

    /// Slacks and duals of the direction from dz and dy.
    fn recover(&mut self, program: &Program, point: &Point, step: &mut Point) {
        let target = &self.target;
        for (i, dy) in self.dy.iter().enumerate() {
            step.over.dual[i] = -dy;
            step.under.dual[i] = *dy;
            step.over.slack[i] = (target.over.slack[i] + point.over.slack[i] * dy) / point.over.dual[i];
            step.under.slack[i] = (target.under.slack[i] - point.under.slack[i] * dy) / point.under.dual[i];
        }
        program.inequality_values(&step.z, &mut self.dλ);
        for (i, dλ) in self.dλ.iter_mut().enumerate() {
            *dλ = (*dλ - self.rhs_inequality[i]) / self.ω_inequality[i];
            step.gap.dual[i] = *dλ;
            step.excess.dual[i] = -*dλ;
            step.gap.slack[i] = (target.gap.slack[i] - point.gap.slack[i] * *dλ) / point.gap.dual[i];
            step.excess.slack[i] = (target.excess.slack[i] + point.excess.slack[i] * *dλ) / point.excess.dual[i];
        }
        for (i, &dz) in step.z.iter().enumerate() {
            step.upper.slack[i] = -dz;
            step.lower.slack[i] = dz;
            step.upper.dual[i] = (target.upper.slack[i] + point.upper.dual[i] * dz) / point.upper.slack[i];
            step.lower.dual[i] = (target.lower.slack[i] - point.lower.dual[i] * dz) / point.lower.slack[i];
        }
    }
}

fn add(value: &mut [f64], increment: &[f64]) {
    for (value, increment) in value.iter_mut().zip(increment) {
        *value += increment;
    }
}
