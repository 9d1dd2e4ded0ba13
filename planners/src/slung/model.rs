//! The problem as a motion in phases: q = (x, y, z, ψ, θ, φ, α, β) and, where the cable can be slack, ρ.

use super::attitude::{angular, thrust_axis};
use super::cable::{Cable, Rates};
use super::jet::Jet;
use super::problem::{Body, GRAVITY, Mode, Problem};
use crate::pseudospectral::{Duration, EndDerivatives, EndValues, EndWeights, Motion, NodeDerivatives, NodeWeights};

/// Indices of the coordinates.
const POSITION: usize = 0;
const EULER: usize = 3;
const ALPHA: usize = 6;
const BETA: usize = 7;
const LENGTH: usize = 8;

/// Rotors.
const ROTORS: usize = 4;

/// Rows that hold the envelope's circle off one obstacle.
const ENVELOPE_ROWS: usize = 5;

/// Shortest cable that a plan may ask for, as a share of its full length: a load does not fly into the quadrotor.
const SHORTEST: f64 = 0.1;

/// The motion of a [`Problem`].
#[derive(Clone, Debug)]
pub struct Model<'a> {
    problem: &'a Problem,
    /// 8, or 9 where the cable can be slack.
    coordinates: usize,
    /// 4 thrusts, and the tension where it is free.
    controls: usize,
    durations: Vec<Duration>,
    start: Vec<f64>,
    bounds: Vec<[Vec<f64>; 2]>,
}

/// One scalar of the form `A b3.axis + rest`, weighted: an acceleration or the tension.
#[derive(Clone, Copy)]
struct Output<const N: usize> {
    axis: [Jet<N>; 3],
    rest: f64,
}

impl<'a> Model<'a> {
    /// The motion of `problem`.
    pub fn new(problem: &'a Problem) -> Self {
        let is_free = |mode: &Mode| matches!(mode, Mode::Either { .. });
        let modes: Vec<Mode> = problem.stages.iter().map(|stage| stage.mode).collect();
        let coordinates = if modes.iter().all(|mode| *mode == Mode::Taut) { 8 } else { 9 };
        let controls = ROTORS + usize::from(modes.iter().any(is_free));
        let mut model = Self {
            problem,
            coordinates,
            controls,
            durations: problem.stages.iter().map(|stage| stage.duration).collect(),
            start: vec![0.0; 2 * coordinates],
            bounds: Vec::new(),
        };
        model.start[..3].copy_from_slice(&problem.start.position_m);
        let cable = coordinates - ALPHA;
        model.start[ALPHA..coordinates].copy_from_slice(&problem.start.cable[..cable]);
        model.bounds = modes.iter().map(|&mode| model.box_of(mode)).collect();
        model
    }

    /// Length of a node vector.
    pub fn width(&self) -> usize {
        2 * self.coordinates + self.controls
    }

    fn mode(&self, phase: usize) -> Mode {
        self.problem.stages[phase].mode
    }

    fn box_of(&self, mode: Mode) -> [Vec<f64>; 2] {
        let limits = &self.problem.limits;
        let mut lower = vec![f64::NEG_INFINITY; self.width()];
        let mut upper = vec![f64::INFINITY; self.width()];
        let euler = [limits.euler_rad; 3];
        let boxes = limits.position_m.iter().chain(&euler).chain([&limits.cable_rad; 2]);
        for (index, [low, high]) in boxes.enumerate() {
            (lower[index], upper[index]) = (*low, *high);
        }
        if self.coordinates > LENGTH && mode != Mode::Taut {
            lower[LENGTH] = SHORTEST * self.problem.body.cable_m;
            upper[LENGTH] = self.problem.body.cable_m;
        }
        let thrusts = 2 * self.coordinates..2 * self.coordinates + ROTORS;
        lower[thrusts.clone()].fill(limits.thrust_n[0]);
        upper[thrusts.clone()].fill(limits.thrust_n[1]);
        if self.controls > ROTORS {
            (lower[thrusts.end], upper[thrusts.end]) = (0.0, limits.tension_n);
        }
        [lower, upper]
    }

    /// Reduced mass m_Q m_L/(m_Q + m_L), kg.
    fn reduced_kg(&self) -> f64 {
        let body = &self.problem.body;
        body.quadrotor_kg * body.load_kg / (body.quadrotor_kg + body.load_kg)
    }

    fn length_m(&self, mode: Mode, node: &[f64]) -> f64 {
        if mode == Mode::Taut || self.coordinates <= LENGTH { self.problem.body.cable_m } else { node[LENGTH] }
    }

    /// Whether the length is a variable of the equations.
    fn has_length(&self, mode: Mode) -> bool {
        self.coordinates > LENGTH && mode != Mode::Taut
    }

    fn tension_n(&self, mode: Mode, node: &[f64]) -> f64 {
        if let Mode::Either { .. } = mode { node[2 * self.coordinates + ROTORS] } else { 0.0 }
    }

    fn length_rate(&self, mode: Mode, node: &[f64]) -> f64 {
        if self.has_length(mode) { node[self.coordinates + LENGTH] } else { 0.0 }
    }

    /// Arguments of the rates' terms: α, ρ, α', β', ρ'.
    fn rate_arguments(&self, mode: Mode, node: &[f64]) -> [f64; 5] {
        let v = &node[self.coordinates..];
        [node[ALPHA], self.length_m(mode, node), v[ALPHA], v[BETA], self.length_rate(mode, node)]
    }

    /// The accelerations of position and cable and, last, the tension, as far as the mode has them: x, y, z, α, β, ρ, λ.
    /// Terms that hold rates or the free tension are part of `rest` in value only.
    #[inline(always)]
    fn outputs<const N: usize>(
        &self,
        mode: Mode,
        cable: &Cable<N>,
        rates: &Rates<0>,
        tension_n: f64,
    ) -> [Output<N>; 7] {
        let body = &self.problem.body;
        let reduced = self.reduced_kg();
        let zero = Jet::constant(0.0);
        let carried = if mode == Mode::Parked { GRAVITY } else { 0.0 };
        let unit = |i: usize| std::array::from_fn(|k| Jet::constant(f64::from(u8::from(i == k))));
        let mut outputs = [Output { axis: [zero; 3], rest: 0.0 }; 7];
        for i in 0..3 {
            let d = cable.direction[i];
            let axis: [Jet<N>; 3] = unit(i);
            outputs[i].axis = axis;
            outputs[i].rest = tension_n / body.quadrotor_kg * d.value;
            if mode == Mode::Taut {
                let pull = d * (-reduced / body.quadrotor_kg);
                outputs[i].axis = std::array::from_fn(|k| axis[k] + pull * cable.direction[k]);
                outputs[i].rest = reduced * body.cable_m / body.quadrotor_kg * rates.squares.value * d.value;
            }
        }
        outputs[2].rest -= GRAVITY;
        let swing = |axis: [Jet<N>; 3], rates: f64| Output { axis, rest: rates - carried * axis[2].value };
        outputs[3] = swing(cable.swing_alpha, rates.alpha.value);
        outputs[4] = swing(cable.swing_beta, rates.beta.value);
        let towards = cable.direction.map(|d| -d);
        if mode == Mode::Taut {
            let axis = cable.direction.map(|d| d * -reduced);
            outputs[6] = Output { axis, rest: reduced * body.cable_m * rates.squares.value };
        } else {
            outputs[5] = swing(towards, rates.centrifugal.value - tension_n / reduced);
        }
        outputs
    }

    /// Where the accelerations among the outputs go.
    fn coordinate_of(output: usize) -> usize {
        if output < 3 { POSITION + output } else { ALPHA + output - 3 }
    }

    /// Rows before those of the obstacles: that of the mode, that of the floor.
    fn row_counts(&self, mode: Mode) -> [usize; 2] {
        let of_mode = match mode {
            Mode::Taut => 1 + usize::from(self.problem.limits.tension_n.is_finite()),
            Mode::Either { .. } => 1,
            Mode::Slack | Mode::Parked => 0,
        };
        [of_mode, usize::from(self.problem.limits.floor_m.is_some() && mode != Mode::Parked)]
    }

    /// What the envelope's rows subtract from the distance, as functions of the cable: `√2 ρ (± d_x)`, `√2 ρ (± d_y)`, of
    /// which the largest is the paper's r_1 (eq. 19).
    #[inline(always)]
    fn reaches<const N: usize>(cable: &Cable<N>, length: Jet<N>) -> [Jet<N>; 2] {
        [cable.direction[0], cable.direction[1]].map(|d| d * length * std::f64::consts::SQRT_2)
    }
}

/// `I^-1 τ` of the thrusts, rad/s^2, about the body's x, y, z.
pub fn angular_acceleration(body: &Body, thrusts: &[f64]) -> [f64; 3] {
    torque_rows(body).map(|row| row.iter().zip(thrusts).map(|(gain, thrust)| gain * thrust).sum())
}

/// Rows of `I^-1 E` for roll, pitch, yaw (eq. 5).
fn torque_rows(body: &Body) -> [[f64; ROTORS]; 3] {
    let (arm, yaw) = (body.arm_m, body.yaw_m);
    let [i_x, i_y, i_z] = body.inertia_kgm2;
    [
        [-arm, arm, arm, -arm].map(|gain| gain / i_x),
        [-arm, -arm, arm, arm].map(|gain| gain / i_y),
        [yaw, -yaw, yaw, -yaw].map(|gain| gain / i_z),
    ]
}

fn inner<const N: usize>(a: [Jet<N>; 3], b: [f64; 3]) -> f64 {
    a[0].value * b[0] + a[1].value * b[1] + a[2].value * b[2]
}

impl Motion for Model<'_> {
    fn coordinates(&self) -> usize {
        self.coordinates
    }

    fn ignorable(&self) -> usize {
        3
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
        let [mode, floor] = self.row_counts(self.mode(phase));
        mode + floor + ENVELOPE_ROWS * self.problem.obstacles.len()
    }

    fn end_rows(&self, phase: usize) -> (usize, usize) {
        let states = 2 * self.coordinates;
        if phase + 1 == self.problem.stages.len() {
            // a taut cable keeps its length by itself
            let is_given = self.coordinates > LENGTH && self.mode(phase) == Mode::Taut;
            (if is_given { states - 2 } else { states }, 0)
        } else if self.becomes_taut(phase) {
            (1, 1 + usize::from(self.problem.stages[phase].impulse_ns.is_some()))
        } else {
            (0, 0)
        }
    }

    fn values(&self, phase: usize, node: &[f64], acceleration: &mut [f64], rows: &mut [f64]) -> f64 {
        let mode = self.mode(phase);
        let body = &self.problem.body;
        let nq = self.coordinates;
        let (v, thrusts) = (&node[nq..], &node[2 * nq..2 * nq + ROTORS]);
        let number = Jet::<0>::constant;
        let length_m = self.length_m(mode, node);
        let cable = Cable::at([node[ALPHA], node[BETA], length_m].map(number));
        let rates = Rates::at(self.rate_arguments(mode, node).map(number));
        let b3 = thrust_axis([node[EULER], node[EULER + 1], node[EULER + 2]].map(number)).map(|b| b.value);
        let specific = thrusts.iter().sum::<f64>() / body.quadrotor_kg;
        let outputs = self.outputs(mode, &cable, &rates, self.tension_n(mode, node));
        let value = |output: &Output<0>| specific * inner(output.axis, b3) + output.rest;
        for (i, output) in outputs.iter().enumerate().take(nq - 3) {
            acceleration[Self::coordinate_of(i)] = value(output);
        }
        let angles = [node[EULER + 1], node[EULER + 2], v[EULER], v[EULER + 1], v[EULER + 2]].map(number);
        let turning = angular(angles, body.inertia_kgm2, angular_acceleration(body, thrusts));
        for (to, jet) in acceleration[EULER..EULER + 3].iter_mut().zip(turning.acceleration) {
            *to = jet.value;
        }
        self.row_values(mode, node, &cable, value(&outputs[6]), rows);
        self.cost(mode, node)
    }

    fn differentiate(&self, phase: usize, node: &[f64], weights: NodeWeights, mut derivatives: NodeDerivatives) {
        let mode = self.mode(phase);
        self.differentiate_translation(mode, node, &weights, &mut derivatives);
        self.differentiate_rotation(node, &weights, &mut derivatives);
        self.differentiate_cost(mode, node, weights.cost, &mut derivatives);
        self.differentiate_rows(mode, node, &weights, &mut derivatives);
    }

    fn end_values(&self, phase: usize, state: &[f64], values: &mut EndValues) {
        let nq = self.coordinates;
        if phase + 1 == self.problem.stages.len() {
            for (event, (state, goal)) in values.events.iter_mut().zip(self.goal(state)) {
                *event = state - goal;
            }
            return;
        }
        values.next.copy_from_slice(state);
        if self.becomes_taut(phase) {
            let body = &self.problem.body;
            let impulse = self.reduced_kg() * state[nq + LENGTH];
            let cable = Cable::at([state[ALPHA], state[BETA], body.cable_m].map(Jet::<0>::constant));
            for (v, d) in values.next[nq..].iter_mut().zip(cable.direction) {
                *v += impulse / body.quadrotor_kg * d.value;
            }
            values.next[LENGTH] = body.cable_m;
            values.next[nq + LENGTH] = 0.0;
            values.events[0] = state[LENGTH] - body.cable_m;
            values.rows[0] = state[nq + LENGTH];
            if let Some(most) = self.problem.stages[phase].impulse_ns {
                values.rows[1] = most - impulse;
            }
        }
    }

    fn end_differentiate(&self, phase: usize, state: &[f64], weights: EndWeights, derivatives: EndDerivatives) {
        let (nq, n) = (self.coordinates, 2 * self.coordinates);
        if phase + 1 == self.problem.stages.len() {
            for (event, index) in self.goal_indices().enumerate() {
                derivatives.events[event * n + index] = 1.0;
            }
            return;
        }
        for r in 0..n {
            derivatives.next[r * n + r] = 1.0;
        }
        if self.becomes_taut(phase) {
            let body = &self.problem.body;
            let share = self.reduced_kg() / body.quadrotor_kg;
            let [alpha, beta] = Jet::<2>::variables([state[ALPHA], state[BETA]]);
            let cable = Cable::at([alpha, beta, Jet::constant(body.cable_m)]);
            let rate = nq + LENGTH;
            for (k, d) in cable.direction.into_iter().enumerate() {
                let row = &mut derivatives.next[(nq + k) * n..][..n];
                let weight = share * weights.next[nq + k];
                row[rate] = share * d.value;
                for (i, a) in [ALPHA, BETA].into_iter().enumerate() {
                    row[a] = share * state[rate] * d.gradient[i];
                    derivatives.hessian[a * n + rate] += weight * d.gradient[i];
                    derivatives.hessian[rate * n + a] += weight * d.gradient[i];
                    for (j, b) in [ALPHA, BETA].into_iter().enumerate() {
                        derivatives.hessian[a * n + b] += weight * state[rate] * d.hessian[i][j];
                    }
                }
            }
            derivatives.next[LENGTH * n + LENGTH] = 0.0;
            derivatives.next[rate * n + rate] = 0.0;
            derivatives.events[LENGTH] = 1.0;
            derivatives.rows[rate] = 1.0;
            if self.problem.stages[phase].impulse_ns.is_some() {
                derivatives.rows[n + rate] = -self.reduced_kg();
            }
        }
    }
}

impl Model<'_> {
    /// Whether the cable goes taut at the end of a phase.
    fn becomes_taut(&self, phase: usize) -> bool {
        self.mode(phase) != Mode::Taut && self.mode(phase + 1) == Mode::Taut
    }

    fn goal_indices(&self) -> impl Iterator<Item = usize> + '_ {
        let (nq, last) = (self.coordinates, self.problem.stages.len() - 1);
        let is_given = nq > LENGTH && self.mode(last) == Mode::Taut;
        (0..2 * nq).filter(move |index| !(is_given && index % nq == LENGTH))
    }

    fn goal<'s>(&'s self, state: &'s [f64]) -> impl Iterator<Item = (f64, f64)> + 's {
        let goal = |index: usize| match index {
            0..3 => self.problem.goal_m[index],
            LENGTH if self.coordinates > LENGTH => self.problem.body.cable_m,
            _ => 0.0,
        };
        self.goal_indices().map(move |index| (state[index], goal(index)))
    }

    /// Weights of the squares of the node vector.
    fn square_weight(&self, index: usize) -> f64 {
        let (weights, nq) = (&self.problem.weights, self.coordinates);
        match index {
            EULER..ALPHA => weights.euler,
            i if i < nq && i >= ALPHA => weights.cable,
            i if i >= nq + EULER && i < nq + ALPHA => weights.euler_rate,
            i if i >= nq + ALPHA && i < 2 * nq => weights.cable_rate,
            i if i >= 2 * nq && i < 2 * nq + ROTORS => weights.thrust,
            _ => 0.0,
        }
    }

    fn cost(&self, mode: Mode, node: &[f64]) -> f64 {
        let squares: f64 = node.iter().enumerate().map(|(i, value)| self.square_weight(i) * value * value).sum();
        let constant = self.problem.weights.cable * self.length_m(mode, node).powi(2);
        squares + if self.coordinates > LENGTH { 0.0 } else { constant }
    }

    fn differentiate_cost(&self, _mode: Mode, node: &[f64], weight: f64, derivatives: &mut NodeDerivatives) {
        let width = self.width();
        for (i, value) in node.iter().enumerate() {
            let square = 2.0 * self.square_weight(i);
            derivatives.cost[i] += square * value;
            derivatives.hessian[i * width + i] += weight * square;
        }
    }

    fn differentiate_rotation(&self, node: &[f64], weights: &NodeWeights, derivatives: &mut NodeDerivatives) {
        let (nq, width) = (self.coordinates, self.width());
        let body = &self.problem.body;
        let at = [EULER + 1, EULER + 2, nq + EULER, nq + EULER + 1, nq + EULER + 2];
        let thrusts = &node[2 * nq..2 * nq + ROTORS];
        let turning =
            angular(Jet::<5>::variables(at.map(|i| node[i])), body.inertia_kgm2, angular_acceleration(body, thrusts));
        let torques = torque_rows(body);
        let mut sum = Jet::<5>::constant(0.0);
        for (k, acceleration) in turning.acceleration.into_iter().enumerate() {
            let weight = weights.acceleration[EULER + k];
            sum = sum + acceleration * weight;
            let row = &mut derivatives.acceleration[(EULER + k) * width..][..width];
            for (&index, slope) in at.iter().zip(acceleration.gradient) {
                row[index] = slope;
            }
            for rotor in 0..ROTORS {
                let u = 2 * nq + rotor;
                for (axis, torque) in torques.iter().enumerate() {
                    let inverse = &turning.inverse[k][axis];
                    row[u] += inverse.value * torque[rotor];
                    for (&index, slope) in at.iter().zip(inverse.gradient).take(2) {
                        let mixed = weight * slope * torque[rotor];
                        derivatives.hessian[index * width + u] += mixed;
                        derivatives.hessian[u * width + index] += mixed;
                    }
                }
            }
        }
        scatter(derivatives.hessian, width, &sum, at, 1.0);
    }

    fn differentiate_translation(
        &self,
        mode: Mode,
        node: &[f64],
        weights: &NodeWeights,
        derivatives: &mut NodeDerivatives,
    ) {
        let (nq, width) = (self.coordinates, self.width());
        let body = &self.problem.body;
        let has_length = self.has_length(mode);
        let cable_at = [ALPHA, BETA, LENGTH];
        let rates_at = [ALPHA, LENGTH, nq + ALPHA, nq + BETA, nq + LENGTH];
        let length_m = self.length_m(mode, node);
        let mut cable_arguments = Jet::<3>::variables([node[ALPHA], node[BETA], length_m]);
        let mut rate_arguments = Jet::<5>::variables(self.rate_arguments(mode, node));
        if !has_length {
            cable_arguments[2] = Jet::constant(length_m);
            rate_arguments[1] = Jet::constant(length_m);
            rate_arguments[4] = Jet::constant(0.0);
        }
        let cable = Cable::at(cable_arguments);
        let rates = Rates::at(rate_arguments);
        let rate_values = Rates::at(self.rate_arguments(mode, node).map(Jet::<0>::constant));
        let b3 = thrust_axis(Jet::<3>::variables([node[EULER], node[EULER + 1], node[EULER + 2]]));
        let specific = node[2 * nq..2 * nq + ROTORS].iter().sum::<f64>() / body.quadrotor_kg;
        let tension_n = self.tension_n(mode, node);
        let outputs = self.outputs(mode, &cable, &rate_values, tension_n);
        let reduced = self.reduced_kg();
        let euler_at = [EULER, EULER + 1, EULER + 2];
        let carried = if mode == Mode::Parked { GRAVITY } else { 0.0 };
        let cable_count = if has_length { 3 } else { 2 };
        let rate_used: [bool; 5] = [true, has_length, true, true, has_length];

        // weights of the outputs x, y, z, α, β, ρ, λ
        let has_ceiling = mode == Mode::Taut && self.problem.limits.tension_n.is_finite();
        let mut output_weights = [0.0; 7];
        for (i, weight) in output_weights.iter_mut().enumerate().take(nq - 3) {
            *weight = weights.acceleration[Self::coordinate_of(i)];
        }
        if mode == Mode::Taut {
            output_weights[5] = 0.0;
            output_weights[6] = weights.rows[0] - if has_ceiling { weights.rows[1] } else { 0.0 };
        }
        let mut axis = [Jet::<3>::constant(0.0); 3];
        for (i, output) in outputs.iter().enumerate() {
            let is_row = i == 6;
            if (is_row && mode != Mode::Taut) || (i == 5 && !has_length) {
                continue;
            }
            let row = if is_row {
                &mut derivatives.rows[..width]
            } else {
                &mut derivatives.acceleration[Self::coordinate_of(i) * width..][..width]
            };
            let mut slope = 0.0;
            for k in 0..3 {
                axis[k] = axis[k] + output.axis[k] * output_weights[i];
                slope += b3[k].value * output.axis[k].value;
                for (j, &index) in euler_at.iter().enumerate() {
                    row[index] += specific * b3[k].gradient[j] * output.axis[k].value;
                }
                for (j, &index) in cable_at.iter().enumerate().take(cable_count) {
                    row[index] += specific * b3[k].value * output.axis[k].gradient[j];
                }
            }
            row[2 * nq..2 * nq + ROTORS].fill(slope / body.quadrotor_kg);
        }
        // Hessian of A b3.axis
        let mut euler_slope = [0.0; 3];
        let mut cable_slope = [0.0; 3];
        for k in 0..3 {
            scatter(derivatives.hessian, width, &b3[k], euler_at, specific * axis[k].value);
            if has_length {
                scatter(derivatives.hessian, width, &axis[k], cable_at, specific * b3[k].value);
            } else {
                scatter_first::<3>(derivatives.hessian, width, &axis[k], cable_at, specific * b3[k].value, 2);
            }
            for i in 0..3 {
                euler_slope[i] += b3[k].gradient[i] * axis[k].value;
                cable_slope[i] += b3[k].value * axis[k].gradient[i];
                for j in 0..cable_count {
                    let mixed = specific * b3[k].gradient[i] * axis[k].gradient[j];
                    derivatives.hessian[euler_at[i] * width + cable_at[j]] += mixed;
                    derivatives.hessian[cable_at[j] * width + euler_at[i]] += mixed;
                }
            }
        }
        for u in 2 * nq..2 * nq + ROTORS {
            let mut put = |index: usize, slope: f64| {
                let mixed = slope / body.quadrotor_kg;
                derivatives.hessian[u * width + index] += mixed;
                derivatives.hessian[index * width + u] += mixed;
            };
            for i in 0..3 {
                put(euler_at[i], euler_slope[i]);
            }
            for i in 0..cable_count {
                put(cable_at[i], cable_slope[i]);
            }
        }
        // the rest: rates, the weight that the ground carries, the free tension
        let put_rates = |row: &mut [f64], jet: &Jet<5>, factor: f64| {
            for i in (0..5).filter(|&i| rate_used[i]) {
                row[rates_at[i]] += factor * jet.gradient[i];
            }
        };
        put_rates(&mut derivatives.acceleration[ALPHA * width..][..width], &rates.alpha, 1.0);
        put_rates(&mut derivatives.acceleration[BETA * width..][..width], &rates.beta, 1.0);
        let mut rate_sum = rates.alpha * output_weights[3] + rates.beta * output_weights[4];
        if mode == Mode::Taut {
            let gain = reduced * body.cable_m;
            put_rates(&mut derivatives.rows[..width], &rates.squares, gain);
            rate_sum = rate_sum + rates.squares * (gain * output_weights[6]);
            let mut pull = Jet::<3>::constant(0.0);
            for (k, d) in cable.direction.iter().enumerate() {
                let row = &mut derivatives.acceleration[(POSITION + k) * width..][..width];
                let factor = gain / body.quadrotor_kg;
                put_rates(row, &rates.squares, factor * d.value);
                for j in 0..cable_count {
                    row[cable_at[j]] += factor * rates.squares.value * d.gradient[j];
                }
                pull = pull + *d * (factor * output_weights[k]);
            }
            rate_sum = rate_sum + rates.squares * pull.value;
            scatter_first::<3>(derivatives.hessian, width, &pull, cable_at, rates.squares.value, cable_count);
            for j in 0..cable_count {
                for i in (0..5).filter(|&i| rate_used[i]) {
                    let mixed = pull.gradient[j] * rates.squares.gradient[i];
                    derivatives.hessian[cable_at[j] * width + rates_at[i]] += mixed;
                    derivatives.hessian[rates_at[i] * width + cable_at[j]] += mixed;
                }
            }
        } else {
            put_rates(&mut derivatives.acceleration[LENGTH * width..][..width], &rates.centrifugal, 1.0);
            rate_sum = rate_sum + rates.centrifugal * output_weights[5];
            if carried != 0.0 {
                for (output, coordinate) in [(3, ALPHA), (4, BETA), (5, LENGTH)] {
                    let up = outputs[output].axis[2];
                    for j in 0..3 {
                        derivatives.acceleration[coordinate * width + cable_at[j]] -= carried * up.gradient[j];
                    }
                    scatter(derivatives.hessian, width, &up, cable_at, -carried * output_weights[output]);
                }
            }
            if let Mode::Either { .. } = mode {
                let tension = 2 * nq + ROTORS;
                derivatives.acceleration[LENGTH * width + tension] = -1.0 / reduced;
                for (k, d) in cable.direction.iter().enumerate() {
                    let row = &mut derivatives.acceleration[(POSITION + k) * width..][..width];
                    row[tension] = d.value / body.quadrotor_kg;
                    let weight = output_weights[k] / body.quadrotor_kg;
                    scatter_first::<3>(derivatives.hessian, width, d, cable_at, weight * tension_n, 2);
                    for j in 0..2 {
                        row[cable_at[j]] += tension_n / body.quadrotor_kg * d.gradient[j];
                        let mixed = weight * d.gradient[j];
                        derivatives.hessian[cable_at[j] * width + tension] += mixed;
                        derivatives.hessian[tension * width + cable_at[j]] += mixed;
                    }
                }
            }
        }
        if has_ceiling {
            let (floor, ceiling) = derivatives.rows[..2 * width].split_at_mut(width);
            for (ceiling, floor) in ceiling.iter_mut().zip(floor) {
                *ceiling = -*floor;
            }
        }
        for i in (0..5).filter(|&i| rate_used[i]) {
            for j in (0..5).filter(|&j| rate_used[j]) {
                derivatives.hessian[rates_at[i] * width + rates_at[j]] += rate_sum.hessian[i][j];
            }
        }
    }

    /// Path rows: the tension or the complementarity, the floor, the envelope's circle off the obstacles.
    fn row_values(&self, mode: Mode, node: &[f64], cable: &Cable<0>, tension_n: f64, rows: &mut [f64]) {
        let limits = &self.problem.limits;
        let length_m = self.length_m(mode, node);
        let [of_mode, of_floor] = self.row_counts(mode);
        match mode {
            Mode::Taut => {
                rows[0] = tension_n;
                if of_mode > 1 {
                    rows[1] = limits.tension_n - tension_n;
                }
            }
            Mode::Either { epsilon } => {
                rows[0] = epsilon - self.tension_n(mode, node) * (self.problem.body.cable_m - length_m);
            }
            Mode::Slack | Mode::Parked => {}
        }
        if of_floor > 0 {
            let floor_m = limits.floor_m.expect("counted");
            rows[of_mode] = node[2] + length_m * cable.direction[2].value - floor_m;
        }
        let reaches = Self::reaches(cable, Jet::constant(length_m)).map(|reach| reach.value);
        for (obstacle, rows) in
            self.problem.obstacles.iter().zip(rows[of_mode + of_floor..].chunks_exact_mut(ENVELOPE_ROWS))
        {
            let gap = obstacle.distance([node[0], node[1]]).value - limits.clearance_m;
            rows[0] = gap - self.problem.body.radius_m;
            for (k, reach) in reaches.into_iter().enumerate() {
                rows[1 + 2 * k] = gap - reach;
                rows[2 + 2 * k] = gap + reach;
            }
        }
    }

    fn differentiate_rows(&self, mode: Mode, node: &[f64], weights: &NodeWeights, derivatives: &mut NodeDerivatives) {
        let width = self.width();
        let length_m = self.length_m(mode, node);
        let has_length = self.has_length(mode);
        let count = if has_length { 3 } else { 2 };
        let cable_at = [ALPHA, BETA, LENGTH];
        let mut arguments = Jet::<3>::variables([node[ALPHA], node[BETA], length_m]);
        if !has_length {
            arguments[2] = Jet::constant(length_m);
        }
        let cable = Cable::at(arguments);
        let [of_mode, of_floor] = self.row_counts(mode);
        if let Mode::Either { .. } = mode {
            let tension = 2 * self.coordinates + ROTORS;
            derivatives.rows[tension] = length_m - self.problem.body.cable_m;
            derivatives.rows[LENGTH] = node[tension];
            derivatives.hessian[tension * width + LENGTH] += weights.rows[0];
            derivatives.hessian[LENGTH * width + tension] += weights.rows[0];
        }
        if of_floor > 0 {
            let height = cable.direction[2] * arguments[2];
            let row = &mut derivatives.rows[of_mode * width..][..width];
            row[2] = 1.0;
            for j in 0..count {
                row[cable_at[j]] = height.gradient[j];
            }
            scatter_first::<3>(derivatives.hessian, width, &height, cable_at, weights.rows[of_mode], count);
        }
        let reaches = Self::reaches(&cable, arguments[2]);
        let mut reach_weights = [0.0; 2];
        for (index, obstacle) in self.problem.obstacles.iter().enumerate() {
            let distance = obstacle.distance([node[0], node[1]]);
            let first = of_mode + of_floor + ENVELOPE_ROWS * index;
            let rows = &mut derivatives.rows[first * width..][..ENVELOPE_ROWS * width];
            let weights = &weights.rows[first..][..ENVELOPE_ROWS];
            for row in rows.chunks_exact_mut(width) {
                row[..2].copy_from_slice(&distance.gradient);
            }
            for k in 0..2 {
                for j in 0..count {
                    rows[(1 + 2 * k) * width + cable_at[j]] = -reaches[k].gradient[j];
                    rows[(2 + 2 * k) * width + cable_at[j]] = reaches[k].gradient[j];
                }
                reach_weights[k] += weights[2 + 2 * k] - weights[1 + 2 * k];
            }
            let weight: f64 = weights.iter().sum();
            let [xx, xy, yy] = distance.hessian;
            for (at, value) in [(0, xx), (1, xy), (width, xy), (width + 1, yy)] {
                derivatives.hessian[at] += weight * value;
            }
        }
        for (reach, weight) in reaches.iter().zip(reach_weights) {
            scatter_first::<3>(derivatives.hessian, width, reach, cable_at, weight, count);
        }
    }
}

/// Adds a jet's weighted Hessian where its variables stand.
#[inline(always)]
fn scatter<const N: usize>(hessian: &mut [f64], width: usize, jet: &Jet<N>, at: [usize; N], weight: f64) {
    scatter_first(hessian, width, jet, at, weight, N);
}

/// The same for its first `count` variables.
#[inline(always)]
fn scatter_first<const N: usize>(
    hessian: &mut [f64],
    width: usize,
    jet: &Jet<N>,
    at: [usize; N],
    weight: f64,
    count: usize,
) {
    for i in 0..count {
        for j in 0..count {
            hessian[at[i] * width + at[j]] += weight * jet.hessian[i][j];
        }
    }
}
