//! Accelerations of position and cable, and the closed-form tension of the taut cable, with derivatives.
//!
//! Each of these outputs (x'', y'', z'', α'', β'', ρ'', λ) is the sum
//!
//! ```text
//! A b3(ψ, θ, φ) . axis(α, β, ρ)  +  terms of the cable's rates  +  terms of the tension or of the ground
//! ```
//!
//! so that the Hessian of the first part splits into those of b3, those of the weighted axes, and products of
//! gradients.

use scenarios::GRAVITY_MPS2;

use super::attitude::thrust_axis;
use super::cable::{CableGeometry, CableRates};
use super::jet::Jet;
use super::problem::CableMode;
use super::system::{ALPHA, BETA, EULER, LENGTH, SlungLoadSystem};
use crate::pseudospectral::{NodeDerivatives, NodeWeights};

/// Indices of the outputs; those of the position come first.
pub(super) const ALPHA_OUT: usize = 3;
pub(super) const BETA_OUT: usize = 4;
pub(super) const LENGTH_OUT: usize = 5;
const TENSION_OUT: usize = 6;
const OUTPUTS: usize = 7;

/// Indices of (ψ, θ, φ) in a node vector.
const EULER_AT: [usize; 3] = [EULER, EULER + 1, EULER + 2];

/// Index of the coordinate whose acceleration an output is.
fn coordinate(output: usize) -> usize {
    if output < ALPHA_OUT { output } else { output - ALPHA_OUT + ALPHA }
}

/// The axis of every output; with the cable taut, that of the position is `e_i - m/m_Q d_i d`.
#[inline(always)]
fn axes<const N: usize>(system: &SlungLoadSystem, mode: CableMode, cable: &CableGeometry<N>) -> [[Jet<N>; 3]; OUTPUTS] {
    let reduced_kg = system.reduced_kg();
    let zero = [Jet::constant(0.0); 3];
    let mut axes = [zero; OUTPUTS];
    let mass_ratio = if mode == CableMode::Taut { -reduced_kg / system.problem.vehicle.quadrotor_kg } else { 0.0 };
    for (i, axis) in axes.iter_mut().take(ALPHA_OUT).enumerate() {
        axis[i] = Jet::constant(1.0);
        if mode == CableMode::Taut {
            let pull = cable.direction[i] * mass_ratio;
            *axis = std::array::from_fn(|k| axis[k] + pull * cable.direction[k]);
        }
    }
    axes[ALPHA_OUT] = cable.swing_alpha;
    axes[BETA_OUT] = cable.swing_beta;
    if mode == CableMode::Taut {
        axes[TENSION_OUT] = cable.direction.map(|d| d * -reduced_kg);
    } else {
        axes[LENGTH_OUT] = cable.direction.map(|d| -d);
    }
    axes
}

/// Acceleration of the load that the ground compensates, m/s^2: g while it carries the load.
pub(super) fn ground_support(mode: CableMode) -> f64 {
    if mode == CableMode::OnGround { GRAVITY_MPS2 } else { 0.0 }
}

/// The factors of the outputs at a node, with derivatives.
pub struct Translation<'a> {
    pub(super) system: &'a SlungLoadSystem<'a>,
    pub(super) mode: CableMode,
    /// Specific thrust A, m/s^2.
    specific_thrust: f64,
    /// The tension where it is a control, N.
    pub(super) tension_n: f64,
    b3: [Jet<3>; 3],
    pub(super) cable: CableGeometry<3>,
    pub(super) rates: CableRates<5>,
    pub(super) axes: [[Jet<3>; 3]; OUTPUTS],
    pub(super) weights: [f64; OUTPUTS],
    /// Indices of (α, ρ, α', β', ρ') in a node vector, and which of them are variables.
    pub(super) rate_indices: [usize; 5],
    pub(super) is_rate_variable: [bool; 5],
}

impl<'a> Translation<'a> {
    /// Writes the accelerations of position and cable; returns the tension, N.
    pub fn evaluate(
        system: &SlungLoadSystem,
        mode: CableMode,
        node: &[f64],
        cable: &CableGeometry<0>,
        rates: &CableRates<0>,
        acceleration: &mut [f64],
    ) -> f64 {
        let vehicle = &system.problem.vehicle;
        let specific = system.specific_thrust(node);
        let b3 = thrust_axis(EULER_AT.map(|index| Jet::<0>::constant(node[index])));
        let along = |axis: [Jet<0>; 3]| specific * (0..3).map(|k| b3[k].value * axis[k].value).sum::<f64>();
        let axes = axes(system, mode, cable);
        let reduced_kg = system.reduced_kg();
        let centrifugal_n = reduced_kg * vehicle.cable_m * rates.squares.value;
        let is_taut = mode == CableMode::Taut;
        let pull_n = if is_taut { centrifugal_n } else { system.free_tension_n(mode, node) };
        for k in 0..3 {
            acceleration[k] = along(axes[k]) + pull_n / vehicle.quadrotor_kg * cable.direction[k].value;
        }
        acceleration[2] -= GRAVITY_MPS2;
        let swing =
            |output: usize, rates: f64| along(axes[output]) + rates - ground_support(mode) * axes[output][2].value;
        acceleration[ALPHA] = swing(ALPHA_OUT, rates.alpha.value);
        acceleration[BETA] = swing(BETA_OUT, rates.beta.value);
        if system.coordinates > LENGTH {
            let slack = swing(LENGTH_OUT, rates.centrifugal.value - pull_n / reduced_kg);
            acceleration[LENGTH] = if is_taut { 0.0 } else { slack };
        }
        if is_taut { along(axes[TENSION_OUT]) + centrifugal_n } else { pull_n }
    }

    /// Factors at a node, and the weights of second derivatives by output.
    #[inline(always)]
    pub fn at(system: &'a SlungLoadSystem<'a>, mode: CableMode, node: &[f64], weights: &NodeWeights) -> Self {
        let nq = system.coordinates;
        let has_length = system.has_length(mode);
        let rate_values = system.rate_arguments(mode, node);
        let mut rate_arguments = Jet::<5>::variables(rate_values);
        if !has_length {
            rate_arguments[1] = Jet::constant(rate_values[1]);
            rate_arguments[4] = Jet::constant(0.0);
        }
        let cable = CableGeometry::at(system.cable_arguments(mode, node));
        let mut output_weights = [0.0; OUTPUTS];
        for (output, weight) in output_weights.iter_mut().enumerate().take(nq - ALPHA_OUT) {
            *weight = weights.acceleration[coordinate(output)];
        }
        if mode == CableMode::Taut {
            output_weights[LENGTH_OUT] = 0.0;
            let limit = if system.has_tension_limit() { weights.path_constraints[1] } else { 0.0 };
            output_weights[TENSION_OUT] = weights.path_constraints[0] - limit;
        }
        Self {
            system,
            mode,
            specific_thrust: system.specific_thrust(node),
            tension_n: system.free_tension_n(mode, node),
            b3: thrust_axis(Jet::variables(EULER_AT.map(|index| node[index]))),
            rates: CableRates::at(rate_arguments),
            axes: axes(system, mode, &cable),
            cable,
            weights: output_weights,
            rate_indices: [ALPHA, LENGTH, nq + ALPHA, nq + BETA, nq + LENGTH],
            is_rate_variable: [true, has_length, true, true, has_length],
        }
    }

    /// Writes first derivatives, those of the tension to the first path constraints, and adds the weighted Hessian.
    #[inline(always)]
    pub fn differentiate(&self, derivatives: &mut NodeDerivatives) {
        self.differentiate_thrust(derivatives);
        self.add_thrust_hessian(derivatives.hessian);
        self.differentiate_rates(derivatives);
        match self.mode {
            CableMode::Taut => self.differentiate_centrifugal_pull(derivatives),
            CableMode::OnGround => self.differentiate_ground_support(derivatives),
            CableMode::Complementarity { .. } => self.differentiate_free_tension(derivatives),
            CableMode::Slack => {}
        }
        if self.mode == CableMode::Taut && self.system.has_tension_limit() {
            let width = self.system.width();
            let (min, max) = derivatives.path_constraints[..2 * width].split_at_mut(width);
            max.iter_mut().zip(min).for_each(|(max, min)| *max = -*min);
        }
    }

    /// The gradient of an output: a row of the Jacobian of the accelerations or of the path constraints.
    pub(super) fn row<'r>(&self, derivatives: &'r mut NodeDerivatives, output: usize) -> &'r mut [f64] {
        let width = self.system.width();
        if output == TENSION_OUT {
            &mut derivatives.path_constraints[..width]
        } else {
            &mut derivatives.acceleration[coordinate(output) * width..][..width]
        }
    }

    /// First derivatives of `A b3.axis`, by output.
    #[inline(always)]
    fn differentiate_thrust(&self, derivatives: &mut NodeDerivatives) {
        let unused = if self.mode == CableMode::Taut { LENGTH_OUT } else { TENSION_OUT };
        let count = self.system.cable_count(self.mode);
        for output in (0..OUTPUTS).filter(|&output| output != unused) {
            let axis = &self.axes[output];
            let row = self.row(derivatives, output);
            let mut slope = 0.0;
            for (b, axis) in self.b3.iter().zip(axis) {
                slope += b.value * axis.value;
                for (index, slope) in EULER_AT.into_iter().zip(b.gradient) {
                    row[index] += self.specific_thrust * slope * axis.value;
                }
                for (index, slope) in self.system.cable_indices().into_iter().zip(axis.gradient).take(count) {
                    row[index] += self.specific_thrust * b.value * slope;
                }
            }
            row[self.system.thrusts()].fill(slope / self.system.problem.vehicle.quadrotor_kg);
        }
    }

    /// Hessian of `A b3.(Σ_i weight_i axis_i)`.
    #[inline(always)]
    fn add_thrust_hessian(&self, hessian: &mut [f64]) {
        let (width, count, cable_at) =
            (self.system.width(), self.system.cable_count(self.mode), self.system.cable_indices());
        let mut euler_slope = [0.0; 3];
        let mut cable_slope = [0.0; 3];
        for (k, b) in self.b3.iter().enumerate() {
            let weighted = self.axes.iter().zip(self.weights).map(|(axis, weight)| axis[k] * weight);
            let axis = weighted.fold(Jet::constant(0.0), |sum, term| sum + term);
            b.scatter(hessian, width, EULER_AT, 3, self.specific_thrust * axis.value);
            axis.scatter(hessian, width, cable_at, count, self.specific_thrust * b.value);
            for i in 0..3 {
                euler_slope[i] += b.gradient[i] * axis.value;
                cable_slope[i] += b.value * axis.gradient[i];
            }
            for (i, j) in (0..3).flat_map(|i| (0..count).map(move |j| (i, j))) {
                let mixed = self.specific_thrust * b.gradient[i] * axis.gradient[j];
                add_symmetric(hessian, width, EULER_AT[i], cable_at[j], mixed);
            }
        }
        for u in self.system.thrusts() {
            let per_newton = 1.0 / self.system.problem.vehicle.quadrotor_kg;
            for (index, slope) in EULER_AT.into_iter().zip(euler_slope) {
                add_symmetric(hessian, width, u, index, per_newton * slope);
            }
            for (index, slope) in cable_at.into_iter().zip(cable_slope).take(count) {
                add_symmetric(hessian, width, u, index, per_newton * slope);
            }
        }
    }

    /// Adds the gradient of a function of the rates, times `factor`, to a row.
    #[inline(always)]
    pub(super) fn add_rates(&self, row: &mut [f64], function: &Jet<5>, factor: f64) {
        for i in (0..5).filter(|&i| self.is_rate_variable[i]) {
            row[self.rate_indices[i]] += factor * function.gradient[i];
        }
    }

    /// Derivatives of the terms that depend on the rates only.
    #[inline(always)]
    fn differentiate_rates(&self, derivatives: &mut NodeDerivatives) {
        let (rates, weights) = (&self.rates, &self.weights);
        self.add_rates(self.row(derivatives, ALPHA_OUT), &rates.alpha, 1.0);
        self.add_rates(self.row(derivatives, BETA_OUT), &rates.beta, 1.0);
        let mut sum = rates.alpha * weights[ALPHA_OUT] + rates.beta * weights[BETA_OUT];
        if self.mode == CableMode::Taut {
            let gain = self.system.reduced_kg() * self.system.problem.vehicle.cable_m;
            self.add_rates(self.row(derivatives, TENSION_OUT), &rates.squares, gain);
            sum = sum + rates.squares * (gain * weights[TENSION_OUT]);
        } else {
            self.add_rates(self.row(derivatives, LENGTH_OUT), &rates.centrifugal, 1.0);
            sum = sum + rates.centrifugal * weights[LENGTH_OUT];
        }
        self.scatter_rates(derivatives.hessian, &sum);
    }

    /// Adds the Hessian of a function of the rates.
    #[inline(always)]
    pub(super) fn scatter_rates(&self, hessian: &mut [f64], function: &Jet<5>) {
        let (width, used) = (self.system.width(), self.is_rate_variable);
        for (i, j) in (0..5).flat_map(|i| (0..5).map(move |j| (i, j))).filter(|&(i, j)| used[i] && used[j]) {
            hessian[self.rate_indices[i] * width + self.rate_indices[j]] += function.hessian[i][j];
        }
    }
}

/// Adds a value to the entries (i, j) and (j, i).
#[inline(always)]
pub(super) fn add_symmetric(matrix: &mut [f64], width: usize, i: usize, j: usize, value: f64) {
    matrix[i * width + j] += value;
    matrix[j * width + i] += value;
}
