//! The problem as a motion in phases: q = (x, y, z, ψ, θ, φ, α, β) and, where the cable can be slack, ρ; u the thrusts
//! and, where it is free, the tension λ.

use super::cable::{Cable, Rates};
use super::cost;
use super::ends;
use super::jet::Jet;
use super::problem::{Mode, Problem};
use super::rotation;
use super::rows;
use super::translation::Translation;
use crate::pseudospectral::{Duration, EndDerivatives, EndValues, EndWeights, Motion, NodeDerivatives, NodeWeights};

/// Indices of the coordinates.
pub const EULER: usize = 3;
pub const ALPHA: usize = 6;
pub const BETA: usize = 7;
pub const LENGTH: usize = 8;

/// Rotors.
pub const ROTORS: usize = 4;

/// Shortest cable that a plan may ask for where the load begins close to the quadrotor, as a share of its full length.
const SHORTEST: f64 = 0.1;

/// Largest angle α, rad: the coordinates are singular at a right angle, where β turns about the cable.
const MOST_ALPHA: f64 = 1.4;

/// The motion of a [`Problem`].
#[derive(Clone, Debug)]
pub struct Model<'a> {
    /// The problem.
    pub problem: &'a Problem,
    /// 8, or 9 where the cable can be slack.
    pub coordinates: usize,
    /// 4 thrusts, and the tension where it is free.
    pub controls: usize,
    durations: Vec<Duration>,
    start: Vec<f64>,
    bounds: Vec<[Vec<f64>; 2]>,
}

impl<'a> Model<'a> {
    /// The motion of `problem`.
    pub fn new(problem: &'a Problem) -> Self {
        let is_free = |mode: &Mode| matches!(mode, Mode::Either { .. });
        let modes: Vec<Mode> = problem.stages.iter().map(|stage| stage.mode).collect();
        let coordinates = if modes.iter().all(|mode| *mode == Mode::Taut) { LENGTH } else { LENGTH + 1 };
        let controls = ROTORS + usize::from(modes.iter().any(is_free));
        let mut start = vec![0.0; 2 * coordinates];
        start[..3].copy_from_slice(&problem.start.position_m);
        start[ALPHA..coordinates].copy_from_slice(&problem.start.cable[..coordinates - ALPHA]);
        let durations = problem.stages.iter().map(|stage| stage.duration).collect();
        let mut model = Self { problem, coordinates, controls, durations, start, bounds: Vec::new() };
        model.bounds = modes.iter().map(|&mode| model.box_of(mode)).collect();
        model
    }

    /// Length of a node vector.
    pub fn width(&self) -> usize {
        2 * self.coordinates + self.controls
    }

    /// What the cable does in a phase.
    pub fn mode(&self, phase: usize) -> Mode {
        self.problem.stages[phase].mode
    }

    /// Whether the cable's length is a variable of the equations; where it is not, it is l_0.
    pub fn has_length(&self, mode: Mode) -> bool {
        self.coordinates > LENGTH && mode != Mode::Taut
    }

    /// Length of the cable, m.
    pub fn length_m(&self, mode: Mode, node: &[f64]) -> f64 {
        if self.has_length(mode) { node[LENGTH] } else { self.problem.body.cable_m }
    }

    /// The tension where it is a control, N; zero elsewhere.
    pub fn free_tension_n(&self, mode: Mode, node: &[f64]) -> f64 {
        if let Mode::Either { .. } = mode { node[self.tension()] } else { 0.0 }
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
        let body = &self.problem.body;
        body.quadrotor_kg * body.load_kg / (body.quadrotor_kg + body.load_kg)
    }

    /// Specific thrust A = F/m_Q, m/s^2.
    pub fn specific_thrust(&self, node: &[f64]) -> f64 {
        node[self.thrusts()].iter().sum::<f64>() / self.problem.body.quadrotor_kg
    }

    /// (α, β, ρ) as jets, ρ a constant where it is none of the variables.
    pub fn cable_arguments(&self, mode: Mode, node: &[f64]) -> [Jet<3>; 3] {
        let length_m = self.length_m(mode, node);
        let [alpha, beta, length] = Jet::variables([node[ALPHA], node[BETA], length_m]);
        [alpha, beta, if self.has_length(mode) { length } else { Jet::constant(length_m) }]
    }

    /// Where (α, β, ρ) stand in a node vector.
    pub fn cable_at(&self) -> [usize; 3] {
        [ALPHA, BETA, LENGTH]
    }

    /// How many of (α, β, ρ) are variables.
    pub fn cable_count(&self, mode: Mode) -> usize {
        if self.has_length(mode) { 3 } else { 2 }
    }

    /// (α, ρ, α', β', ρ').
    pub fn rate_arguments(&self, mode: Mode, node: &[f64]) -> [f64; 5] {
        let v = &node[self.coordinates..];
        let length_rate = if self.has_length(mode) { v[LENGTH] } else { 0.0 };
        [node[ALPHA], self.length_m(mode, node), v[ALPHA], v[BETA], length_rate]
    }

    /// Cable and rates in plain numbers.
    pub fn cable_in_numbers(&self, mode: Mode, node: &[f64]) -> (Cable<0>, Rates<0>) {
        let angles = [node[ALPHA], node[BETA], self.length_m(mode, node)];
        let rates = self.rate_arguments(mode, node);
        (Cable::at(angles.map(Jet::constant)), Rates::at(rates.map(Jet::constant)))
    }

    /// Shortest cable in a phase, m: a load that flies stays off the ball about the body, unless it begins inside.
    fn shortest_m(&self, mode: Mode) -> f64 {
        let (body, limits) = (&self.problem.body, &self.problem.limits);
        let off_body_m = body.radius_m + limits.clearance_m;
        let is_outside = mode == Mode::Slack && self.problem.start.cable[2] >= off_body_m && off_body_m < body.cable_m;
        if is_outside { off_body_m } else { SHORTEST * body.cable_m }
    }

    fn box_of(&self, mode: Mode) -> [Vec<f64>; 2] {
        let limits = &self.problem.limits;
        let mut lower = vec![f64::NEG_INFINITY; self.width()];
        let mut upper = vec![f64::INFINITY; self.width()];
        let mut put = |index: usize, [low, high]: [f64; 2]| (lower[index], upper[index]) = (low, high);
        let euler = [limits.euler_rad; 3];
        let alpha = limits.cable_rad.map(|angle| angle.clamp(-MOST_ALPHA, MOST_ALPHA));
        let boxes = limits.position_m.iter().chain(&euler).chain([&alpha, &limits.cable_rad]);
        boxes.enumerate().for_each(|(index, limit)| put(index, *limit));
        self.thrusts().for_each(|index| put(index, limits.thrust_n));
        let full_m = self.problem.body.cable_m;
        if self.has_length(mode) {
            put(LENGTH, [self.shortest_m(mode), full_m]);
        }
        if self.controls > ROTORS {
            put(self.tension(), [0.0, limits.tension_n]);
        }
        [lower, upper]
    }
}

impl Motion for Model<'_> {
    fn coordinates(&self) -> usize {
        self.coordinates
    }

    /// The position.
    fn ignorable(&self) -> usize {
        EULER
    }

    fn controls(&self) -> usize {
        self.controls
    }

    fn durations(&self) -> &[Duration] {
        &self.durations
    }

    fn time_cost(&self) -> f64 {
        self.problem.weights.time
    }

    fn start(&self) -> &[f64] {
        &self.start
    }

    fn bounds(&self, phase: usize) -> (&[f64], &[f64]) {
        let [lower, upper] = &self.bounds[phase];
        (lower, upper)
    }

    fn rows(&self, phase: usize) -> usize {
        rows::count(self, self.mode(phase))
    }

    fn end_rows(&self, phase: usize) -> (usize, usize) {
        ends::counts(self, phase)
    }

    fn values(&self, phase: usize, node: &[f64], acceleration: &mut [f64], rows: &mut [f64]) -> f64 {
        let mode = self.mode(phase);
        let (cable, rates) = self.cable_in_numbers(mode, node);
        let tension_n = Translation::values(self, mode, node, &cable, &rates, acceleration);
        rotation::values(self, node, acceleration);
        rows::values(self, mode, node, &cable, tension_n, rows);
        cost::value(self, node)
    }

    fn differentiate(&self, phase: usize, node: &[f64], weights: NodeWeights, derivatives: NodeDerivatives) {
        let mode = self.mode(phase);
        pulp::Arch::new().dispatch(Differentiate { model: self, mode, node, weights, derivatives });
    }

    fn end_values(&self, phase: usize, state: &[f64], values: &mut EndValues) {
        ends::values(self, phase, state, values);
    }

    fn end_differentiate(&self, phase: usize, state: &[f64], weights: EndWeights, mut derivatives: EndDerivatives) {
        ends::differentiate(self, phase, state, &weights, &mut derivatives);
    }
}

/// All derivatives at a node, to be compiled for the widest vector registers that the processor turns out to have.
struct Differentiate<'a> {
    model: &'a Model<'a>,
    mode: Mode,
    node: &'a [f64],
    weights: NodeWeights<'a>,
    derivatives: NodeDerivatives<'a>,
}

impl pulp::WithSimd for Differentiate<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: pulp::Simd>(self, _: S) {
        let Self { model, mode, node, weights, mut derivatives } = self;
        Translation::at(model, mode, node, &weights).differentiate(&mut derivatives);
        rotation::differentiate(model, node, &weights, &mut derivatives);
        cost::differentiate(model, node, weights.cost, &mut derivatives);
        rows::differentiate(model, mode, node, weights.rows, &mut derivatives);
    }
}
