//! The initial guess: level flight along a route with quintic timing, at hover thrust.

use scenarios::GRAVITY_MPS2;

use super::problem::{CableMode, Gate, Problem};
use super::route::Route;
use super::system::{ALPHA, BETA, LENGTH, ROTORS};
use crate::pseudospectral::Duration;

/// Time constant of the load's swing at a gate, s.
const SWING_S: f64 = 0.35;

/// An initial guess of the motion.
#[derive(Clone, Debug)]
pub struct Guess<'a> {
    problem: &'a Problem,
    route: &'a Route,
    /// Durations of the phases, s.
    durations_s: Vec<f64>,
    coordinates: usize,
}

impl<'a> Guess<'a> {
    /// The guess along `route`, for node vectors with this many coordinates.
    pub fn new(problem: &'a Problem, route: &'a Route, coordinates: usize) -> Self {
        let mut durations_s: Vec<f64> = Vec::with_capacity(problem.phases.len());
        for phase in &problem.phases {
            let elapsed_s: f64 = durations_s.iter().sum();
            durations_s.push(match phase.duration {
                Duration::Fixed(seconds) => seconds,
                Duration::Free { guess_s, .. } => guess_s,
                Duration::Remainder(total_s) => total_s - elapsed_s,
            });
        }
        Self { problem, route, durations_s, coordinates }
    }

    /// Durations of the phases, s.
    pub fn durations_s(&self) -> &[f64] {
        &self.durations_s
    }

    /// Writes the node vector at a fraction of a phase.
    pub fn write(&self, phase: usize, fraction: f64, node: &mut [f64]) {
        let (start, goal) = (&self.problem.start, &self.problem.goal_m);
        let length_m = self.length_m(phase, fraction);
        let is_on_ground = |k: usize| self.problem.phases[k].mode == CableMode::OnGround;
        let ground_s: f64 = (0..self.durations_s.len()).filter(|&k| is_on_ground(k)).map(|k| self.durations_s[k]).sum();
        let before_s: f64 = (0..phase).map(|k| self.durations_s[k]).sum();
        let flown_s = if is_on_ground(phase) { 0.0 } else { before_s + fraction * self.durations_s[phase] - ground_s };
        let total_s = self.durations_s.iter().sum::<f64>() - ground_s;
        let t = (flown_s / total_s).clamp(0.0, 1.0);
        let along = t * t * t * (10.0 - 15.0 * t + 6.0 * t * t);
        node.fill(0.0);
        node[..2].copy_from_slice(&self.route.at(along));
        let lifted_m = if (0..=phase).any(is_on_ground) { length_m - start.cable[2] } else { 0.0 };
        node[2] = start.position_m[2] + lifted_m + along * (goal[2] - start.position_m[2] - lifted_m);
        let time_s = before_s + fraction * self.durations_s[phase];
        (node[ALPHA], node[BETA]) = self.swing(time_s);
        self.detour_to_gates(time_s, node);
        if self.coordinates > LENGTH {
            node[LENGTH] = length_m;
        }
        node[2 * self.coordinates..].fill(self.problem.hover_n());
        if let Some(tension_n) = node.get_mut(2 * self.coordinates + ROTORS) {
            *tension_n = self.problem.vehicle.load_kg * GRAVITY_MPS2;
        }
    }

    /// Cable angles (α, β), rad: the load swings to each gate and back, with a Gaussian in time.
    fn swing(&self, time_s: f64) -> (f64, f64) {
        let mut end_s = 0.0;
        let (mut alpha, mut beta) = (0.0, 0.0);
        for (phase, duration_s) in self.problem.phases.iter().zip(&self.durations_s) {
            end_s += duration_s;
            let Some(gate) = phase.gate else { continue };
            let [x, y, z] = hanging(&gate);
            let weight = (-((time_s - end_s) / SWING_S).powi(2)).exp();
            let [min, max] = self.problem.limits.cable_rad;
            alpha += weight * y.atan2(x.hypot(z));
            beta += weight * (-x).atan2(-z).clamp(0.9 * min, 0.9 * max);
        }
        (alpha, beta)
    }

    /// Moves the quadrotor from the route towards each gate, with a Gaussian in time: to the nearest point of its own
    /// window, or, along an axis on which that is open, to a point from which the load hangs inside its window.
    fn detour_to_gates(&self, time_s: f64, node: &mut [f64]) {
        let mut end_s = 0.0;
        for (phase, duration_s) in self.problem.phases.iter().zip(&self.durations_s) {
            end_s += duration_s;
            let Some(gate) = phase.gate else { continue };
            let weight = (-((time_s - end_s) / SWING_S).powi(2)).exp();
            let hanging_m = hanging(&gate).map(|part| part * self.problem.vehicle.cable_m);
            for axis in 0..3 {
                let [low, high] = gate.quadrotor_m[axis];
                let above_load = gate.load_m[axis].map(|face_m| face_m - hanging_m[axis]);
                let is_open = !low.is_finite() && !high.is_finite();
                let [low, high] = if is_open { above_load } else { [low, high] };
                node[axis] += weight * (node[axis].clamp(low, high) - node[axis]);
            }
        }
    }

    /// Length of the cable, m: from the initial to the full one during the leading slack phases, full from then on.
    fn length_m(&self, phase: usize, fraction: f64) -> f64 {
        let (from, full) = (self.problem.start.cable[2], self.problem.vehicle.cable_m);
        let is_slack = |k: usize| self.problem.phases[k].mode != CableMode::Taut;
        let is_leading = (0..=phase).all(is_slack);
        if is_leading { from + fraction * (full - from) } else { full }
    }
}

/// Unit vector from the quadrotor to the load at a gate: from the middle of its window to that of the load's. A
/// component along which either window is open is zero, or -1 before normalisation for the vertical one.
fn hanging(gate: &Gate) -> [f64; 3] {
    let offset_m: [f64; 3] = std::array::from_fn(|axis| {
        let middle_m = |[low, high]: [f64; 2]| 0.5 * (low + high);
        let offset_m = middle_m(gate.load_m[axis]) - middle_m(gate.quadrotor_m[axis]);
        let unknown_m = if axis == 2 { -1.0 } else { 0.0 };
        if offset_m.is_finite() { offset_m } else { unknown_m }
    });
    let length_m = offset_m.iter().map(|part_m| part_m.powi(2)).sum::<f64>().sqrt().max(f64::MIN_POSITIVE);
    offset_m.map(|part_m| part_m / length_m)
}
