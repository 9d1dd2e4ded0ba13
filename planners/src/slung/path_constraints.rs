//! Path constraints, each to be >= 0: the tension or the complementarity of slack and taut (Kang, Huang, Wen 2020, eq.
//! 2 to 4), the floor, and the clearance of the envelope circle.
//!
//! The circle's radius is the largest of r_2, `√2 ρ |cos α sin β|` and `√2 ρ |sin α|` (eq. 19, 20). The paper's
//! R-functions have kinks; five smooth constraints per obstacle are equivalent, with the signed distance δ from the
//! obstacle:
//!
//! ```text
//! δ - r' - r_2 >= 0,    δ - r' ± √2 ρ d_x >= 0,    δ - r' ± √2 ρ d_y >= 0
//! ```

use super::cable::CableGeometry;
use super::jet::Jet;
use super::problem::CableMode;
use super::system::{LENGTH, SlungLoadSystem};
use crate::pseudospectral::NodeDerivatives;

/// Envelope constraints per obstacle.
const PER_OBSTACLE: usize = 5;

/// Numbers of constraints on the cable and of constraints on the load's altitude.
fn counts(system: &SlungLoadSystem, mode: CableMode) -> [usize; 2] {
    let on_cable = match mode {
        CableMode::Taut => 1 + usize::from(system.has_tension_limit()),
        CableMode::Complementarity { .. } => 1,
        CableMode::Slack | CableMode::OnGround => 0,
    };
    [on_cable, usize::from(system.problem.limits.floor_m.is_some() && mode != CableMode::OnGround)]
}

/// Number of path constraints.
pub fn count(system: &SlungLoadSystem, mode: CableMode) -> usize {
    counts(system, mode).iter().sum::<usize>() + PER_OBSTACLE * system.problem.obstacles.len()
}

/// `√2 ρ d_x` and `√2 ρ d_y`, m.
#[inline(always)]
fn reaches<const N: usize>(cable: &CableGeometry<N>, length: Jet<N>) -> [Jet<N>; 2] {
    [cable.direction[0], cable.direction[1]].map(|d| d * length * std::f64::consts::SQRT_2)
}

/// Writes the constraints.
pub fn evaluate(
    system: &SlungLoadSystem,
    mode: CableMode,
    node: &[f64],
    cable: &CableGeometry<0>,
    tension_n: f64,
    constraints: &mut [f64],
) {
    let (limits, vehicle) = (&system.problem.limits, &system.problem.vehicle);
    let length_m = system.length_m(mode, node);
    let [on_cable, on_floor] = counts(system, mode);
    match mode {
        CableMode::Taut => {
            constraints[0] = tension_n;
            if on_cable > 1 {
                constraints[1] = limits.tension_n - tension_n;
            }
        }
        CableMode::Complementarity { epsilon } => constraints[0] = epsilon - tension_n * (vehicle.cable_m - length_m),
        CableMode::Slack | CableMode::OnGround => {}
    }
    if let (Some(floor_m), 1) = (limits.floor_m, on_floor) {
        constraints[on_cable] = node[2] + length_m * cable.direction[2].value - floor_m;
    }
    let reaches = reaches(cable, Jet::constant(length_m)).map(|reach| reach.value);
    let by_obstacle = constraints[on_cable + on_floor..].chunks_exact_mut(PER_OBSTACLE);
    for (constraints, obstacle) in by_obstacle.zip(&system.problem.obstacles) {
        let gap_m = obstacle.distance([node[0], node[1]]).value - limits.clearance_m;
        constraints[0] = gap_m - vehicle.radius_m;
        for (pair, reach) in constraints[1..].chunks_exact_mut(2).zip(reaches) {
            (pair[0], pair[1]) = (gap_m - reach, gap_m + reach);
        }
    }
}

/// Writes the Jacobian and adds the weighted Hessian, except those of the taut cable's tension: see
/// [`Translation`](super::translation::Translation).
#[inline(always)]
pub fn differentiate(
    system: &SlungLoadSystem,
    mode: CableMode,
    node: &[f64],
    weights: &[f64],
    derivatives: &mut NodeDerivatives,
) {
    let arguments = system.cable_arguments(mode, node);
    let cable = CableGeometry::at(arguments);
    let [on_cable, on_floor] = counts(system, mode);
    if let CableMode::Complementarity { .. } = mode {
        differentiate_complementarity(system, node, weights[0], derivatives);
    }
    if on_floor > 0 {
        let height = cable.direction[2] * arguments[2];
        differentiate_floor(system, mode, height, (on_cable, weights[on_cable]), derivatives);
    }
    let first = on_cable + on_floor;
    let reaches = reaches(&cable, arguments[2]);
    differentiate_envelope(system, mode, node, reaches, (first, &weights[first..]), derivatives);
}

/// Derivatives of `ε - λ (l_0 - ρ)`.
#[inline(always)]
fn differentiate_complementarity(
    system: &SlungLoadSystem,
    node: &[f64],
    weight: f64,
    derivatives: &mut NodeDerivatives,
) {
    let (width, tension) = (system.width(), system.tension());
    derivatives.path_constraints[tension] = node[LENGTH] - system.problem.vehicle.cable_m;
    derivatives.path_constraints[LENGTH] = node[tension];
    derivatives.hessian[tension * width + LENGTH] += weight;
    derivatives.hessian[LENGTH * width + tension] += weight;
}

/// Derivatives of the load's altitude, with its height above the quadrotor given as a jet.
#[inline(always)]
fn differentiate_floor(
    system: &SlungLoadSystem,
    mode: CableMode,
    height: Jet<3>,
    (at, weight): (usize, f64),
    derivatives: &mut NodeDerivatives,
) {
    let (width, count, cable_at) = (system.width(), system.cable_count(mode), system.cable_indices());
    let row = &mut derivatives.path_constraints[at * width..][..width];
    row[2] = 1.0;
    for (index, slope) in cable_at.into_iter().zip(height.gradient).take(count) {
        row[index] = slope;
    }
    height.scatter(derivatives.hessian, width, cable_at, count, weight);
}

/// Derivatives of the envelope constraints, the first of which is number `first`.
#[inline(always)]
fn differentiate_envelope(
    system: &SlungLoadSystem,
    mode: CableMode,
    node: &[f64],
    reaches: [Jet<3>; 2],
    (first, weights): (usize, &[f64]),
    derivatives: &mut NodeDerivatives,
) {
    let (width, count, cable_at) = (system.width(), system.cable_count(mode), system.cable_indices());
    let mut reach_weights = [0.0; 2];
    let rows = derivatives.path_constraints[first * width..].chunks_exact_mut(PER_OBSTACLE * width);
    for ((rows, weights), obstacle) in rows.zip(weights.chunks_exact(PER_OBSTACLE)).zip(&system.problem.obstacles) {
        let distance = obstacle.distance([node[0], node[1]]);
        for row in rows.chunks_exact_mut(width) {
            row[..2].copy_from_slice(&distance.gradient);
        }
        for (k, reach) in reaches.iter().enumerate() {
            for (index, slope) in cable_at.into_iter().zip(reach.gradient).take(count) {
                rows[(1 + 2 * k) * width + index] = -slope;
                rows[(2 + 2 * k) * width + index] = slope;
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
        reach.scatter(derivatives.hessian, width, cable_at, count, weight);
    }
}
