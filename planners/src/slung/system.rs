//! The planner's coordinates, and the layout of its node vectors.
//!
//! `q = (x, y, z, ψ, θ, φ, α, β)` and, where the cable can be slack, its length ρ; `u` are the thrusts and, under
//! complementarity, the tension λ.

use super::cable::{CableGeometry, CableRates};
use super::jet::Jet;
use super::problem::{CableMode, Problem};
use crate::pseudospectral::Duration;

/// Indices of the coordinates.
pub const EULER: usize = 3;
pub const ALPHA: usize = 6;
pub const BETA: usize = 7;
pub const LENGTH: usize = 8;

/// Number of rotors.
pub const ROTORS: usize = 4;

/// Lower bound of the cable's length where the load starts close to the quadrotor, as a fraction of its full length.
const MIN_LENGTH_FRACTION: f64 = 0.1;

/// Bound of |α|, rad. The coordinates are singular at a right angle, where β turns about the cable.
const MAX_ALPHA: f64 = 1.4;

/// A [`Problem`] as a multiphase system: its sizes, bounds and the meaning of its node vectors.
#[derive(Clone, Debug)]
pub struct SlungLoadSystem<'a> {
    /// The problem.
    pub problem: &'a Problem,
    /// Number of coordinates: 8, or 9 where the cable can be slack.
    pub coordinates: usize,
    /// Number of controls: 4 thrusts, and under complementarity the tension.
    pub controls: usize,
    pub(super) durations: Vec<Duration>,
    pub(super) initial_state: Vec<f64>,
    pub(super) bounds: Vec<[Vec<f64>; 2]>,
}

impl<'a> SlungLoadSystem<'a> {
    /// The system of `problem`.
    pub fn new(problem: &'a Problem) -> Self {
        let is_free = |mode: &CableMode| matches!(mode, CableMode::Complementarity { .. });
        let modes: Vec<CableMode> = problem.phases.iter().map(|phase| phase.mode).collect();
        let coordinates = if modes.iter().all(|mode| *mode == CableMode::Taut) { LENGTH } else { LENGTH + 1 };
        let controls = ROTORS + usize::from(modes.iter().any(is_free));
        let mut initial_state = vec![0.0; 2 * coordinates];
        initial_state[..3].copy_from_slice(&problem.start.position_m);
        initial_state[ALPHA..coordinates].copy_from_slice(&problem.start.cable[..coordinates - ALPHA]);
        let durations = problem.phases.iter().map(|phase| phase.duration).collect();
        let mut system = Self { problem, coordinates, controls, durations, initial_state, bounds: Vec::new() };
        system.bounds = modes.iter().map(|&mode| system.bounds_of(mode)).collect();
        system
    }

    /// Length of a node vector.
    pub fn width(&self) -> usize {
        2 * self.coordinates + self.controls
    }

    /// Mode of the cable in a phase.
    pub fn mode(&self, phase: usize) -> CableMode {
        self.problem.phases[phase].mode
    }

    /// Whether the cable's length is a variable of the dynamics; otherwise it is l_0.
    pub fn has_length(&self, mode: CableMode) -> bool {
        self.coordinates > LENGTH && mode != CableMode::Taut
    }

    /// Length of the cable, m.
    pub fn length_m(&self, mode: CableMode, node: &[f64]) -> f64 {
        if self.has_length(mode) { node[LENGTH] } else { self.problem.vehicle.cable_m }
    }

    /// The tension where it is a control, N; zero elsewhere.
    pub fn free_tension_n(&self, mode: CableMode, node: &[f64]) -> f64 {
        if let CableMode::Complementarity { .. } = mode { node[self.tension()] } else { 0.0 }
    }

    /// Whether the taut cable's tension has an upper limit.
    pub fn has_tension_limit(&self) -> bool {
        self.problem.limits.tension_n.is_finite()
    }

    /// Indices of the thrusts in a node vector.
    pub fn thrusts(&self) -> std::ops::Range<usize> {
        2 * self.coordinates..2 * self.coordinates + ROTORS
    }

    /// Index of the free tension.
    pub fn tension(&self) -> usize {
        2 * self.coordinates + ROTORS
    }

    /// Reduced mass m_Q m_L/(m_Q + m_L), kg.
    pub fn reduced_kg(&self) -> f64 {
        let vehicle = &self.problem.vehicle;
        vehicle.quadrotor_kg * vehicle.load_kg / (vehicle.quadrotor_kg + vehicle.load_kg)
    }

    /// Specific thrust A = F/m_Q, m/s^2.
    pub fn specific_thrust(&self, node: &[f64]) -> f64 {
        node[self.thrusts()].iter().sum::<f64>() / self.problem.vehicle.quadrotor_kg
    }

    /// (α, β, ρ) as jets; ρ is a constant where it is not a variable.
    pub fn cable_arguments(&self, mode: CableMode, node: &[f64]) -> [Jet<3>; 3] {
        let length_m = self.length_m(mode, node);
        let [alpha, beta, length] = Jet::variables([node[ALPHA], node[BETA], length_m]);
        [alpha, beta, if self.has_length(mode) { length } else { Jet::constant(length_m) }]
    }

    /// Indices of (α, β, ρ) in a node vector.
    pub fn cable_indices(&self) -> [usize; 3] {
        [ALPHA, BETA, LENGTH]
    }

    /// How many of (α, β, ρ) are variables.
    pub fn cable_count(&self, mode: CableMode) -> usize {
        if self.has_length(mode) { 3 } else { 2 }
    }

    /// (α, ρ, α', β', ρ').
    pub fn rate_arguments(&self, mode: CableMode, node: &[f64]) -> [f64; 5] {
        let v = &node[self.coordinates..];
        let length_rate = if self.has_length(mode) { v[LENGTH] } else { 0.0 };
        [node[ALPHA], self.length_m(mode, node), v[ALPHA], v[BETA], length_rate]
    }

    /// Geometry and rates of the cable without derivatives.
    pub fn cable_values(&self, mode: CableMode, node: &[f64]) -> (CableGeometry<0>, CableRates<0>) {
        let arguments = [node[ALPHA], node[BETA], self.length_m(mode, node)];
        let rates = self.rate_arguments(mode, node);
        (CableGeometry::at(arguments.map(Jet::constant)), CableRates::at(rates.map(Jet::constant)))
    }

    /// Lower bound of the cable's length in a phase, m: a flying load stays off the ball around the body, unless it
    /// starts inside.
    fn min_length_m(&self, mode: CableMode) -> f64 {
        let (vehicle, limits) = (&self.problem.vehicle, &self.problem.limits);
        let off_body_m = vehicle.radius_m + limits.clearance_m;
        let is_outside =
            mode == CableMode::Slack && self.problem.start.cable[2] >= off_body_m && off_body_m < vehicle.cable_m;
        if is_outside { off_body_m } else { MIN_LENGTH_FRACTION * vehicle.cable_m }
    }

    /// Lower and upper bounds of the node vector.
    fn bounds_of(&self, mode: CableMode) -> [Vec<f64>; 2] {
        let limits = &self.problem.limits;
        let mut lower = vec![f64::NEG_INFINITY; self.width()];
        let mut upper = vec![f64::INFINITY; self.width()];
        let mut set = |index: usize, [low, high]: [f64; 2]| (lower[index], upper[index]) = (low, high);
        let euler = [limits.euler_rad; 3];
        let alpha = limits.cable_rad.map(|angle| angle.clamp(-MAX_ALPHA, MAX_ALPHA));
        let bounds = limits.position_m.iter().chain(&euler).chain([&alpha, &limits.cable_rad]);
        bounds.enumerate().for_each(|(index, bound)| set(index, *bound));
        self.thrusts().for_each(|index| set(index, limits.thrust_n));
        if self.has_length(mode) {
            set(LENGTH, [self.min_length_m(mode), self.problem.vehicle.cable_m]);
        }
        if self.controls > ROTORS {
            set(self.tension(), [0.0, limits.tension_n]);
        }
        [lower, upper]
    }
}
