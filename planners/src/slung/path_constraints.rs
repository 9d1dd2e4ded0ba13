//! Path constraints, each to be >= 0: the tension or the complementarity of slack and taut (Kang, Huang, Wen 2020, eq.
//! 2 to 4), the floor, and the [clearance from the obstacles](super::obstacle_rows).

use super::cable::CableGeometry;
use super::jet::Jet;
use super::obstacle_rows;
use super::problem::CableMode;
use super::system::{LENGTH, SlungLoadSystem};
use crate::pseudospectral::NodeDerivatives;

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
    counts(system, mode).iter().sum::<usize>() + obstacle_rows::count(system)
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
    obstacle_rows::evaluate(system, node, cable, length_m, &mut constraints[on_cable + on_floor..]);
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
    obstacle_rows::differentiate(system, mode, node, (&cable, arguments[2]), (first, &weights[first..]), derivatives);
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
