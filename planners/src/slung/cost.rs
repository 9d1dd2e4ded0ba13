//! The paper's running cost `x^T Q' x + u^T R' u`, on the state itself.

use super::model::{ALPHA, EULER, LENGTH, Model, ROTORS};
use crate::pseudospectral::NodeDerivatives;

/// At a node.
pub fn value(model: &Model, node: &[f64]) -> f64 {
    let squares: f64 = node.iter().enumerate().map(|(index, value)| weight(model, index) * value * value).sum();
    // 10 ρ^2 is part of the paper's J also where ρ is no variable
    let constant = if model.coordinates > LENGTH { 0.0 } else { model.problem.body.cable_m.powi(2) };
    squares + model.problem.weights.cable * constant
}

/// Adds the gradient, and `factor` times the Hessian.
#[inline(always)]
pub fn differentiate(model: &Model, node: &[f64], factor: f64, derivatives: &mut NodeDerivatives) {
    let width = model.width();
    for (index, value) in node.iter().enumerate() {
        let square = 2.0 * weight(model, index);
        derivatives.cost[index] += square * value;
        derivatives.hessian[index * width + index] += factor * square;
    }
}

/// Weight of the square of an entry of the node vector.
#[inline(always)]
fn weight(model: &Model, index: usize) -> f64 {
    let (weights, nq) = (&model.problem.weights, model.coordinates);
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
