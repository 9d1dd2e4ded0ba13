//! Path constraints of an aircraft at a node, each to be >= 0: speed, flight-path angle, obstacles, other aircraft.
//!
//! The avoidance constraints are those of the papers' planners before their linearisation: horizontal distances at the
//! nodes.

use super::node_vector::{CLOCK, VELOCITY, WIDTH};
use super::problem::Problem;
use crate::pseudospectral::NodeDerivatives;
use crate::slung::Jet;

/// Constraints on the velocity.
const ON_VELOCITY: usize = 4;

/// Number of constraints.
pub fn count(problem: &Problem) -> usize {
    ON_VELOCITY + problem.obstacles.len() + problem.neighbours.len()
}

/// Speed and sine of the flight-path angle (times the speed) within their bounds.
#[inline(always)]
fn velocity_rows<const N: usize>(problem: &Problem, [x, y, z]: [Jet<N>; 3]) -> [Jet<N>; ON_VELOCITY] {
    let speed = (x.square() + y.square() + z.square()).sqrt();
    let [[min, max], [low, high]] = [problem.speed, problem.climb];
    [speed - Jet::constant(min), Jet::constant(max) - speed, z - speed * low, speed * high - z]
}

/// Position, velocity and acceleration in the plane of what is to be avoided at a time, with the distance to keep.
fn avoided(problem: &Problem, time: f64) -> impl Iterator<Item = ([[f64; 2]; 3], f64)> {
    let still = problem.obstacles.iter().map(|(center, distance)| ([*center, [0.0; 2], [0.0; 2]], *distance));
    still.chain(problem.neighbours.iter().map(move |neighbour| (neighbour.at(time), problem.separation)))
}

/// Writes the constraints.
pub fn evaluate(problem: &Problem, node: &[f64], constraints: &mut [f64]) {
    let velocity = std::array::from_fn(|k| Jet::<0>::constant(node[VELOCITY + k]));
    for (constraint, row) in constraints.iter_mut().zip(velocity_rows(problem, velocity)) {
        *constraint = row.value;
    }
    for (constraint, ([position, ..], distance)) in
        constraints[ON_VELOCITY..].iter_mut().zip(avoided(problem, node[CLOCK]))
    {
        *constraint = (node[0] - position[0]).hypot(node[1] - position[1]) - distance;
    }
}

/// Writes the Jacobian and adds the weighted Hessian.
pub fn differentiate(problem: &Problem, node: &[f64], weights: &[f64], derivatives: &mut NodeDerivatives) {
    let at = [VELOCITY, VELOCITY + 1, VELOCITY + 2];
    let velocity = Jet::<3>::variables(std::array::from_fn(|k| node[VELOCITY + k]));
    for (row, jet) in velocity_rows(problem, velocity).into_iter().enumerate() {
        for (&index, slope) in at.iter().zip(jet.gradient) {
            derivatives.path_constraints[row * WIDTH + index] = slope;
        }
        jet.scatter(derivatives.hessian, WIDTH, at, 3, weights[row]);
    }
    let at = [0, 1, CLOCK];
    for (row, ([position, rate, change], _)) in (ON_VELOCITY..).zip(avoided(problem, node[CLOCK])) {
        let (gradient, hessian) = distance_derivatives([node[0] - position[0], node[1] - position[1]], rate, change);
        for i in 0..3 {
            derivatives.path_constraints[row * WIDTH + at[i]] = gradient[i];
            for j in 0..3 {
                derivatives.hessian[at[i] * WIDTH + at[j]] += weights[row] * hessian[i][j];
            }
        }
    }
}

/// Gradient and Hessian with respect to (x, y, σ) of the distance `|p - c(σ)|`, given `p - c`, c' and c''.
fn distance_derivatives(offset: [f64; 2], rate: [f64; 2], change: [f64; 2]) -> ([f64; 3], [[f64; 3]; 3]) {
    let distance = offset[0].hypot(offset[1]).max(f64::MIN_POSITIVE);
    let unit = offset.map(|component| component / distance);
    // columns of the Jacobian of p - c
    let columns = [[1.0, 0.0], [0.0, 1.0], [-rate[0], -rate[1]]];
    let dot = |a: [f64; 2], b: [f64; 2]| a[0] * b[0] + a[1] * b[1];
    let gradient = columns.map(|column| dot(unit, column));
    let mut hessian = [[0.0; 3]; 3];
    for i in 0..3 {
        for j in 0..3 {
            hessian[i][j] = (dot(columns[i], columns[j]) - gradient[i] * gradient[j]) / distance;
        }
    }
    hessian[2][2] -= dot(unit, change);
    (gradient, hessian)
}
