//! Rows of position and cable, and the closed-form tension of the taut cable.
//!
//! Each of these outputs (x, y, z, α, β, ρ, λ) is `A b3(ψ, θ, φ).axis(α, β, ρ) + rest`, so that second derivatives fall
//! apart into those of b3, those of the weighted axes, and products of first ones.

use super::attitude::thrust_axis;
use super::cable::{Cable, Rates};
use super::jet::Jet;
use super::model::{ALPHA, BETA, EULER, LENGTH, Model};
use super::problem::{GRAVITY, Mode};
use crate::pseudospectral::{NodeDerivatives, NodeWeights};

/// Outputs by index.
pub(super) const ALPHA_OUT: usize = 3;
pub(super) const BETA_OUT: usize = 4;
pub(super) const LENGTH_OUT: usize = 5;
const TENSION_OUT: usize = 6;
const OUTPUTS: usize = 7;

/// Where (ψ, θ, φ) stand in a node vector.
const EULER_AT: [usize; 3] = [EULER, EULER + 1, EULER + 2];

/// The coordinate whose acceleration an output is.
fn coordinate(output: usize) -> usize {
    if output < ALPHA_OUT { output } else { output - ALPHA_OUT + ALPHA }
}

/// `axis` of every output.
#[inline(always)]
fn axes<const N: usize>(model: &Model, mode: Mode, cable: &Cable<N>) -> [[Jet<N>; 3]; OUTPUTS] {
    let reduced_kg = model.reduced_kg();
    let zero = [Jet::constant(0.0); 3];
    let mut axes = [zero; OUTPUTS];
    let pulled = if mode == Mode::Taut { -reduced_kg / model.problem.body.quadrotor_kg } else { 0.0 };
    for (i, axis) in axes.iter_mut().take(ALPHA_OUT).enumerate() {
        axis[i] = Jet::constant(1.0);
        if mode == Mode::Taut {
            let pull = cable.direction[i] * pulled;
            *axis = std::array::from_fn(|k| axis[k] + pull * cable.direction[k]);
        }
    }
    axes[ALPHA_OUT] = cable.swing_alpha;
    axes[BETA_OUT] = cable.swing_beta;
    if mode == Mode::Taut {
        axes[TENSION_OUT] = cable.direction.map(|d| d * -reduced_kg);
    } else {
        axes[LENGTH_OUT] = cable.direction.map(|d| -d);
    }
    axes
}

/// Gravity that the ground takes off the load, m/s^2.
pub(super) fn carried(mode: Mode) -> f64 {
    if mode == Mode::Parked { GRAVITY } else { 0.0 }
}

/// A node with everything that derivatives are made of.
pub struct Translation<'a> {
    pub(super) model: &'a Model<'a>,
    pub(super) mode: Mode,
    specific: f64,
    pub(super) tension_n: f64,
    b3: [Jet<3>; 3],
    pub(super) cable: Cable<3>,
    pub(super) rates: Rates<5>,
    pub(super) axes: [[Jet<3>; 3]; OUTPUTS],
    pub(super) weights: [f64; OUTPUTS],
    /// Where (α, ρ, α', β', ρ') stand, and which of them are variables.
    pub(super) rates_at: [usize; 5],
    pub(super) rates_used: [bool; 5],
}

impl<'a> Translation<'a> {
    /// Writes the accelerations of position and cable; returns the tension, N.
    pub fn values(
        model: &Model,
        mode: Mode,
        node: &[f64],
        cable: &Cable<0>,
        rates: &Rates<0>,
        acceleration: &mut [f64],
    ) -> f64 {
        let body = &model.problem.body;
        let specific = model.specific_thrust(node);
        let b3 = thrust_axis(EULER_AT.map(|index| Jet::<0>::constant(node[index])));
        let along = |axis: [Jet<0>; 3]| specific * (0..3).map(|k| b3[k].value * axis[k].value).sum::<f64>();
        let axes = axes(model, mode, cable);
        let reduced_kg = model.reduced_kg();
        let centrifugal_n = reduced_kg * body.cable_m * rates.squares.value;
        let is_taut = mode == Mode::Taut;
        let pull_n = if is_taut { centrifugal_n } else { model.free_tension_n(mode, node) };
        for k in 0..3 {
            acceleration[k] = along(axes[k]) + pull_n / body.quadrotor_kg * cable.direction[k].value;
        }
        acceleration[2] -= GRAVITY;
        let swing = |output: usize, rates: f64| along(axes[output]) + rates - carried(mode) * axes[output][2].value;
        acceleration[ALPHA] = swing(ALPHA_OUT, rates.alpha.value);
        acceleration[BETA] = swing(BETA_OUT, rates.beta.value);
        if model.coordinates > LENGTH {
            let slack = swing(LENGTH_OUT, rates.centrifugal.value - pull_n / reduced_kg);
            acceleration[LENGTH] = if is_taut { 0.0 } else { slack };
        }
        if is_taut { along(axes[TENSION_OUT]) + centrifugal_n } else { pull_n }
    }

    /// Everything at a node, and the weights with which second derivatives are summed.
    #[inline(always)]
    pub fn at(model: &'a Model<'a>, mode: Mode, node: &[f64], weights: &NodeWeights) -> Self {
        let nq = model.coordinates;
        let has_length = model.has_length(mode);
        let rate_values = model.rate_arguments(mode, node);
        let mut rate_arguments = Jet::<5>::variables(rate_values);
        if !has_length {
            rate_arguments[1] = Jet::constant(rate_values[1]);
            rate_arguments[4] = Jet::constant(0.0);
        }
        let cable = Cable::at(model.cable_arguments(mode, node));
        let mut output_weights = [0.0; OUTPUTS];
        for (output, weight) in output_weights.iter_mut().enumerate().take(nq - ALPHA_OUT) {
            *weight = weights.acceleration[coordinate(output)];
        }
        if mode == Mode::Taut {
            output_weights[LENGTH_OUT] = 0.0;
            let ceiling = if has_ceiling(model) { weights.rows[1] } else { 0.0 };
            output_weights[TENSION_OUT] = weights.rows[0] - ceiling;
        }
        Self {
            model,
            mode,
            specific: model.specific_thrust(node),
            tension_n: model.free_tension_n(mode, node),
            b3: thrust_axis(Jet::variables(EULER_AT.map(|index| node[index]))),
            rates: Rates::at(rate_arguments),
            axes: axes(model, mode, &cable),
            cable,
            weights: output_weights,
            rates_at: [ALPHA, LENGTH, nq + ALPHA, nq + BETA, nq + LENGTH],
            rates_used: [true, has_length, true, true, has_length],
        }
    }

    /// Writes first derivatives, of the tension into the first path rows, and adds the weighted Hessian.
    #[inline(always)]
    pub fn differentiate(&self, derivatives: &mut NodeDerivatives) {
        self.thrust_rows(derivatives);
        self.thrust_hessian(derivatives.hessian);
        self.rate_rows(derivatives);
        match self.mode {
            Mode::Taut => self.pull_of_rates(derivatives),
            Mode::Parked => self.carried_weight(derivatives),
            Mode::Either { .. } => self.free_tension(derivatives),
            Mode::Slack => {}
        }
        if self.mode == Mode::Taut && has_ceiling(self.model) {
            let width = self.model.width();
            let (floor, ceiling) = derivatives.rows[..2 * width].split_at_mut(width);
            ceiling.iter_mut().zip(floor).for_each(|(ceiling, floor)| *ceiling = -*floor);
        }
    }

    /// The row of an output: of an acceleration, or of the tension.
    pub(super) fn row<'r>(&self, derivatives: &'r mut NodeDerivatives, output: usize) -> &'r mut [f64] {
        let width = self.model.width();
        if output == TENSION_OUT {
            &mut derivatives.rows[..width]
        } else {
            &mut derivatives.acceleration[coordinate(output) * width..][..width]
        }
    }

    /// First derivatives of `A b3.axis`.
    #[inline(always)]
    fn thrust_rows(&self, derivatives: &mut NodeDerivatives) {
        let unused = if self.mode == Mode::Taut { LENGTH_OUT } else { TENSION_OUT };
        let count = self.model.cable_count(self.mode);
        for output in (0..OUTPUTS).filter(|&output| output != unused) {
            let axis = &self.axes[output];
            let row = self.row(derivatives, output);
            let mut slope = 0.0;
            for (b, axis) in self.b3.iter().zip(axis) {
                slope += b.value * axis.value;
                for (index, slope) in EULER_AT.into_iter().zip(b.gradient) {
                    row[index] += self.specific * slope * axis.value;
                }
                for (index, slope) in self.model.cable_at().into_iter().zip(axis.gradient).take(count) {
                    row[index] += self.specific * b.value * slope;
                }
            }
            row[self.model.thrusts()].fill(slope / self.model.problem.body.quadrotor_kg);
        }
    }

    /// Hessian of `A b3.(Σ weight axis)`.
    #[inline(always)]
    fn thrust_hessian(&self, hessian: &mut [f64]) {
        let (width, count, cable_at) = (self.model.width(), self.model.cable_count(self.mode), self.model.cable_at());
        let mut euler_slope = [0.0; 3];
        let mut cable_slope = [0.0; 3];
        for (k, b) in self.b3.iter().enumerate() {
            let weighted = self.axes.iter().zip(self.weights).map(|(axis, weight)| axis[k] * weight);
            let axis = weighted.fold(Jet::constant(0.0), |sum, term| sum + term);
            b.scatter(hessian, width, EULER_AT, 3, self.specific * axis.value);
            axis.scatter(hessian, width, cable_at, count, self.specific * b.value);
            for i in 0..3 {
                euler_slope[i] += b.gradient[i] * axis.value;
                cable_slope[i] += b.value * axis.gradient[i];
            }
            for (i, j) in (0..3).flat_map(|i| (0..count).map(move |j| (i, j))) {
                let mixed = self.specific * b.gradient[i] * axis.gradient[j];
                add_both(hessian, width, EULER_AT[i], cable_at[j], mixed);
            }
        }
        for u in self.model.thrusts() {
            let per_newton = 1.0 / self.model.problem.body.quadrotor_kg;
            for (index, slope) in EULER_AT.into_iter().zip(euler_slope) {
                add_both(hessian, width, u, index, per_newton * slope);
            }
            for (index, slope) in cable_at.into_iter().zip(cable_slope).take(count) {
                add_both(hessian, width, u, index, per_newton * slope);
            }
        }
    }

    /// Adds a function of the rates to a row.
    #[inline(always)]
    pub(super) fn add_rates(&self, row: &mut [f64], function: &Jet<5>, factor: f64) {
        for i in (0..5).filter(|&i| self.rates_used[i]) {
            row[self.rates_at[i]] += factor * function.gradient[i];
        }
    }

    /// Terms that hold rates, as far as they stand alone.
    #[inline(always)]
    fn rate_rows(&self, derivatives: &mut NodeDerivatives) {
        let (rates, weights) = (&self.rates, &self.weights);
        self.add_rates(self.row(derivatives, ALPHA_OUT), &rates.alpha, 1.0);
        self.add_rates(self.row(derivatives, BETA_OUT), &rates.beta, 1.0);
        let mut sum = rates.alpha * weights[ALPHA_OUT] + rates.beta * weights[BETA_OUT];
        if self.mode == Mode::Taut {
            let gain = self.model.reduced_kg() * self.model.problem.body.cable_m;
            self.add_rates(self.row(derivatives, TENSION_OUT), &rates.squares, gain);
            sum = sum + rates.squares * (gain * weights[TENSION_OUT]);
        } else {
            self.add_rates(self.row(derivatives, LENGTH_OUT), &rates.centrifugal, 1.0);
            sum = sum + rates.centrifugal * weights[LENGTH_OUT];
        }
        self.scatter_rates(derivatives.hessian, &sum);
    }

    #[inline(always)]
    pub(super) fn scatter_rates(&self, hessian: &mut [f64], function: &Jet<5>) {
        let (width, used) = (self.model.width(), self.rates_used);
        for (i, j) in (0..5).flat_map(|i| (0..5).map(move |j| (i, j))).filter(|&(i, j)| used[i] && used[j]) {
            hessian[self.rates_at[i] * width + self.rates_at[j]] += function.hessian[i][j];
        }
    }
}

/// Whether the taut cable's tension has a limit.
pub fn has_ceiling(model: &Model) -> bool {
    model.problem.limits.tension_n.is_finite()
}

#[inline(always)]
pub(super) fn add_both(matrix: &mut [f64], width: usize, i: usize, j: usize, value: f64) {
    matrix[i * width + j] += value;
    matrix[j * width + i] += value;
}
