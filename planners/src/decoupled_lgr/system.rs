//! The aircraft as a second-order system in Cartesian coordinates.
//!
//! `q = (x, y, h, σ)`: the clock σ runs with time (σ' = 1), so that constraints may depend on it. With the velocity v, its
//! direction t, the horizontal unit vector b to the left and m = t × b, the equations of Wang, Xu, Long (2020), eq. 2, are
//!
//! ```text
//! p'' = g (n_x t + n_y b + n_z m) - g e_3,    σ'' = 0
//! ```

use super::node_vector::{CLOCK, CONTROLS, COORDINATES, LOAD_FACTORS, STATES, VELOCITY, WIDTH};
use super::problem::Problem;
use super::rows;
use super::units::GRAVITY;
use crate::pseudospectral::{
    Duration, MultiphaseSystem, NodeDerivatives, NodeWeights, TerminalDerivatives, TerminalValues, TerminalWeights,
};
use crate::slung::Jet;

/// A [`Problem`] as a system for the transcription.
#[derive(Clone, Debug)]
pub struct AircraftSystem<'a> {
    /// The problem.
    pub problem: &'a Problem,
    initial_state: [f64; STATES],
    bounds: [Vec<f64>; 2],
    durations: [Duration; 1],
}

impl<'a> AircraftSystem<'a> {
    /// The system of `problem`.
    pub fn new(problem: &'a Problem) -> Self {
        let mut initial_state = [0.0; STATES];
        initial_state[..3].copy_from_slice(&problem.ends[0][..3]);
        initial_state[VELOCITY..VELOCITY + 3].copy_from_slice(&problem.ends[0][3..]);
        initial_state[VELOCITY + CLOCK] = 1.0;
        let bounds = [0, 1].map(|side| {
            let mut bounds = vec![[f64::NEG_INFINITY, f64::INFINITY][side]; WIDTH];
            (0..3).for_each(|axis| bounds[axis] = problem.position[axis][side]);
            (0..CONTROLS).for_each(|k| bounds[LOAD_FACTORS + k] = problem.load_factors[k][side]);
            bounds
        });
        Self { problem, initial_state, bounds, durations: [problem.duration] }
    }
}

/// The axes t, b, m of a velocity, each by its components.
#[inline(always)]
fn axes<const N: usize>([x, y, z]: [Jet<N>; 3]) -> [[Jet<N>; 3]; CONTROLS] {
    let level = (x.square() + y.square()).sqrt();
    let speed = (x.square() + y.square() + z.square()).sqrt();
    let (per_level, per_speed) = (level.recip(), speed.recip());
    let t = [x, y, z].map(|component| component * per_speed);
    let b = [-(y * per_level), x * per_level, Jet::constant(0.0)];
    let m = [-(t[2] * b[1]), t[2] * b[0], level * per_speed];
    [t, b, m]
}

impl MultiphaseSystem for AircraftSystem<'_> {
    fn coordinates(&self) -> usize {
        COORDINATES
    }

    /// None: the accelerations depend on the velocity.
    fn ignorable(&self) -> usize {
        0
    }

    fn controls(&self) -> usize {
        CONTROLS
    }

    fn durations(&self) -> &[Duration] {
        &self.durations
    }

    fn time_cost(&self) -> f64 {
        self.problem.time_cost()
    }

    fn initial_state(&self) -> &[f64] {
        &self.initial_state
    }

    fn bounds(&self, _: usize) -> (&[f64], &[f64]) {
        (&self.bounds[0], &self.bounds[1])
    }

    fn path_constraint_count(&self, _: usize) -> usize {
        rows::count(self.problem)
    }

    fn terminal_constraint_counts(&self, _: usize) -> (usize, usize) {
        (6, 0)
    }

    fn evaluate(&self, _: usize, node: &[f64], acceleration: &mut [f64], path_constraints: &mut [f64]) -> f64 {
        let axes = axes::<0>(std::array::from_fn(|k| Jet::constant(node[VELOCITY + k])));
        let n = &node[LOAD_FACTORS..];
        for (k, acceleration) in acceleration[..3].iter_mut().enumerate() {
            *acceleration = GRAVITY * (0..CONTROLS).map(|i| n[i] * axes[i][k].value).sum::<f64>();
        }
        acceleration[2] -= GRAVITY;
        acceleration[CLOCK] = 0.0;
        rows::evaluate(self.problem, node, path_constraints);
        self.problem.effort_weight() * (n[0].powi(2) + n[1].powi(2) + (n[2] - 1.0).powi(2))
    }

    fn differentiate(&self, _: usize, node: &[f64], weights: NodeWeights, mut derivatives: NodeDerivatives) {
        let axes = axes(Jet::<3>::variables(std::array::from_fn(|k| node[VELOCITY + k])));
        let at = [VELOCITY, VELOCITY + 1, VELOCITY + 2];
        for (i, axis) in axes.iter().enumerate() {
            let n = LOAD_FACTORS + i;
            for (k, component) in axis.iter().enumerate() {
                let row = &mut derivatives.acceleration[k * WIDTH..][..WIDTH];
                let weight = GRAVITY * weights.acceleration[k];
                row[n] = GRAVITY * component.value;
                component.scatter(derivatives.hessian, WIDTH, at, 3, weight * node[n]);
                for (&v, slope) in at.iter().zip(component.gradient) {
                    row[v] += GRAVITY * node[n] * slope;
                    derivatives.hessian[n * WIDTH + v] += weight * slope;
                    derivatives.hessian[v * WIDTH + n] += weight * slope;
                }
            }
        }
        let effort = 2.0 * self.problem.effort_weight();
        for i in 0..CONTROLS {
            let n = LOAD_FACTORS + i;
            derivatives.cost[n] = effort * (node[n] - if i == 2 { 1.0 } else { 0.0 });
            derivatives.hessian[n * WIDTH + n] += weights.cost * effort;
        }
        rows::differentiate(self.problem, node, weights.path_constraints, &mut derivatives);
    }

    fn evaluate_terminal(&self, _: usize, state: &[f64], values: &mut TerminalValues) {
        for (equality, (index, goal)) in values.equalities.iter_mut().zip(goal_states(self.problem)) {
            *equality = state[index] - goal;
        }
    }

    fn differentiate_terminal(&self, _: usize, _: &[f64], _: TerminalWeights, derivatives: TerminalDerivatives) {
        for (equality, (index, _)) in goal_states(self.problem).enumerate() {
            derivatives.equalities[equality * STATES + index] = 1.0;
        }
    }
}

/// Indices and values of the states that the goal fixes: position and velocity.
fn goal_states(problem: &Problem) -> impl Iterator<Item = (usize, f64)> {
    let index = |k: usize| if k < 3 { k } else { VELOCITY + k - 3 };
    problem.ends[1].into_iter().enumerate().map(move |(k, goal)| (index(k), goal))
}
