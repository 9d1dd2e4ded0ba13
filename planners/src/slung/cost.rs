//! The running cost `l = x^T Q' x + u^T R' u` of Kang, Huang, Wen 2020, of the state itself and not of its distance
//! from the goal.

use super::system::{ALPHA, EULER, LENGTH, ROTORS, SlungLoadSystem};
use crate::pseudospectral::NodeDerivatives;

/// Running cost at a node.
pub fn evaluate(system: &SlungLoadSystem, node: &[f64]) -> f64 {
    let squares: f64 = node.iter().enumerate().map(|(index, value)| weight(system, index) * value * value).sum();
    // 10 ρ^2 is part of the paper's J even where ρ is not a variable
    let constant = if system.coordinates > LENGTH { 0.0 } else { system.problem.vehicle.cable_m.powi(2) };
    squares + system.problem.weights.cable * constant
}

/// Adds the gradient, and `factor` times the Hessian.
#[inline(always)]
pub fn differentiate(system: &SlungLoadSystem, node: &[f64], factor: f64, derivatives: &mut NodeDerivatives) {
    let width = system.width();
    for (index, value) in node.iter().enumerate() {
        let square = 2.0 * weight(system, index);
        derivatives.cost[index] += square * value;
        derivatives.hessian[index * width + index] += factor * square;
    }
}

/// Weight of the square of an entry of the node vector.
#[inline(always)]
fn weight(system: &SlungLoadSystem, index: usize) -> f64 {
    let (weights, nq) = (&system.problem.weights, system.coordinates);
    let rate = index.wrapping_sub(nq);
    match index {
        EULER..ALPHA => weights.euler,
        _ if index >= ALPHA && index < nq => weights.cable,
        _ if (EULER..ALPHA).contains(&rate) => weights.euler_rate,
        _ if rate >= ALPHA && rate < nq => weights.cable_rate,
        _ if rate >= nq && rate < nq + ROTORS => weights.thrust,
        _ => 0.0,
    }
}
