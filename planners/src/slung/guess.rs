//! Where the optimiser begins: along a route with quintic timing, level, in hover.

use super::problem::{GRAVITY, Gate, Mode, Problem};
use super::route::Route;
use crate::pseudospectral::Duration;

/// Time in which a load swings up to a gate, s.
const SWING_S: f64 = 0.35;

/// A motion to begin with.
#[derive(Clone, Debug)]
pub struct Guess<'a> {
    problem: &'a Problem,
    route: &'a Route,
    /// Durations of the phases, s.
    durations_s: Vec<f64>,
    coordinates: usize,
}

impl<'a> Guess<'a> {
    /// Along `route`, for node vectors with so many coordinates.
    pub fn new(problem: &'a Problem, route: &'a Route, coordinates: usize) -> Self {
        let mut durations_s: Vec<f64> = Vec::with_capacity(problem.stages.len());
        for stage in &problem.stages {
            let so_far: f64 = durations_s.iter().sum();
            durations_s.push(match stage.duration {
                Duration::Fixed(seconds) => seconds,
                Duration::Free { guess_s, .. } => guess_s,
                Duration::RestOf(total_s) => total_s - so_far,
            });
        }
        Self { problem, route, durations_s, coordinates }
    }

    /// Durations of the phases, s.
    pub fn durations_s(&self) -> &[f64] {
        &self.durations_s
    }

    /// The node vector at a share of a phase.
    pub fn write(&self, phase: usize, share: f64, node: &mut [f64]) {
        let (start, goal) = (&self.problem.start, &self.problem.goal_m);
        let length_m = self.length_m(phase, share);
        let is_parked = |k: usize| self.problem.stages[k].mode == Mode::Parked;
        let parked_s: f64 = (0..self.durations_s.len()).filter(|&k| is_parked(k)).map(|k| self.durations_s[k]).sum();
        let before_s: f64 = (0..phase).map(|k| self.durations_s[k]).sum();
        let flown_s = if is_parked(phase) { 0.0 } else { before_s + share * self.durations_s[phase] - parked_s };
        let total_s = self.durations_s.iter().sum::<f64>() - parked_s;
        let t = (flown_s / total_s).clamp(0.0, 1.0);
        let along = t * t * t * (10.0 - 15.0 * t + 6.0 * t * t);
        node.fill(0.0);
        node[..2].copy_from_slice(&self.route.at(along));
        let lifted_m = if (0..=phase).any(is_parked) { length_m - start.cable[2] } else { 0.0 };
        node[2] = start.position_m[2] + lifted_m + along * (goal[2] - start.position_m[2] - lifted_m);
        let time_s = before_s + share * self.durations_s[phase];
        (node[6], node[7]) = self.swing(time_s);
        self.lean_towards_gates(time_s, node);
        if self.coordinates > 8 {
            node[8] = length_m;
        }
        node[2 * self.coordinates..].fill(self.problem.hover_n());
        if let Some(tension_n) = node.get_mut(2 * self.coordinates + 4) {
            *tension_n = self.problem.body.load_kg * GRAVITY;
        }
    }

    /// Cable angles (α, β), rad: the load swings up to a gate and back.
    fn swing(&self, time_s: f64) -> (f64, f64) {
        let mut end_s = 0.0;
        let (mut alpha, mut beta) = (0.0, 0.0);
        for (stage, duration_s) in self.problem.stages.iter().zip(&self.durations_s) {
            end_s += duration_s;
            let Some(gate) = stage.gate else { continue };
            let [x, y, z] = hanging(&gate);
            let near = (-((time_s - end_s) / SWING_S).powi(2)).exp();
            let [least, most] = self.problem.limits.cable_rad;
            alpha += near * y.atan2(x.hypot(z));
            beta += near * (-x).atan2(-z).clamp(0.9 * least, 0.9 * most);
        }
        (alpha, beta)
    }

    /// About the instant of a gate the quadrotor leaves the route for the gate: for the nearest point of its own window, and
    /// where that is open, for one from which the load hangs in the middle of its window.
    fn lean_towards_gates(&self, time_s: f64, node: &mut [f64]) {
        let mut end_s = 0.0;
        for (stage, duration_s) in self.problem.stages.iter().zip(&self.durations_s) {
            end_s += duration_s;
            let Some(gate) = stage.gate else { continue };
            let near = (-((time_s - end_s) / SWING_S).powi(2)).exp();
            let hanging_m = hanging(&gate).map(|part| part * self.problem.body.cable_m);
            for axis in 0..3 {
                let [low, high] = gate.quadrotor_m[axis];
                let below = gate.load_m[axis].map(|face_m| face_m - hanging_m[axis]);
                let is_open = !low.is_finite() && !high.is_finite();
                let [low, high] = if is_open { below } else { [low, high] };
                node[axis] += near * (node[axis].clamp(low, high) - node[axis]);
            }
        }
    }

    /// From the start's length to the full one while the cable is slack for the first time; full from then on.
    fn length_m(&self, phase: usize, share: f64) -> f64 {
        let (from, full) = (self.problem.start.cable[2], self.problem.body.cable_m);
        let is_slack = |k: usize| self.problem.stages[k].mode != Mode::Taut;
        let first = (0..=phase).all(is_slack);
        if first { from + share * (full - from) } else { full }
    }
}

/// Direction from the quadrotor to the load as a gate is passed, as far as its windows tell: from the middle of the one to
/// that of the other; along an axis on which one of them is open, nothing, but down where nothing is said of the height.
fn hanging(gate: &Gate) -> [f64; 3] {
    let apart_m: [f64; 3] = std::array::from_fn(|axis| {
        let middle_m = |[low, high]: [f64; 2]| 0.5 * (low + high);
        let apart_m = middle_m(gate.load_m[axis]) - middle_m(gate.quadrotor_m[axis]);
        let unknown_m = if axis == 2 { -1.0 } else { 0.0 };
        if apart_m.is_finite() { apart_m } else { unknown_m }
    });
    let length_m = apart_m.iter().map(|part_m| part_m.powi(2)).sum::<f64>().sqrt().max(f64::MIN_POSITIVE);
    apart_m.map(|part_m| part_m / length_m)
}
