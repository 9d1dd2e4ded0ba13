//! The envelope circle by the paper's R-functions, `max(a, b) = (a + b + |a - b|)/2` (Kang, Huang, Wen 2020, eq. 19, 20):
//!
//! ```text
//! w_1 = |cos α sin β|,   w_2 = |sin α|,   r_1 = √2/2 ρ (w_1 + w_2 + |w_1 - w_2|)
//! r_max = (r_1 + r_2 + |r_1 - r_2|)/2,    δ - r' - r_max >= 0
//! ```
//!
//! One constraint per obstacle, with kinks where the radius switches and where the load crosses an axis or a diagonal.

use super::cable::CableGeometry;
use super::jet::Jet;
use super::problem::CableMode;
use super::system::SlungLoadSystem;
use crate::pseudospectral::NodeDerivatives;

/// Radius r_1 of the load's reach, m (eq. 19): at least its horizontal distance, and at most √2 times as much.
#[inline(always)]
pub fn load_reach<const N: usize>(cable: &CableGeometry<N>, length: Jet<N>) -> Jet<N> {
    let [w_1, w_2] = [cable.direction[0].abs(), cable.direction[1].abs()];
    length * (w_1 + w_2 + (w_1 - w_2).abs()) * std::f64::consts::FRAC_1_SQRT_2
}

/// Radius r_max of the envelope circle, m (eq. 20).
#[inline(always)]
fn envelope_radius<const N: usize>(cable: &CableGeometry<N>, length: Jet<N>, body_radius_m: f64) -> Jet<N> {
    let (reach, body) = (load_reach(cable, length), Jet::constant(body_radius_m));
    (reach + body + (reach - body).abs()) * 0.5
}

/// Writes the constraints.
pub fn evaluate(
    system: &SlungLoadSystem,
    node: &[f64],
    cable: &CableGeometry<0>,
    length_m: f64,
    constraints: &mut [f64],
) {
    let problem = system.problem;
    let radius_m = envelope_radius(cable, Jet::constant(length_m), problem.vehicle.radius_m).value;
    for (constraint, obstacle) in constraints.iter_mut().zip(&problem.obstacles) {
        *constraint = obstacle.distance([node[0], node[1]]).value - problem.limits.clearance_m - radius_m;
    }
}

/// Writes the Jacobian and adds the weighted Hessian; the first constraint is number `first`.
#[inline(always)]
pub fn differentiate(
    system: &SlungLoadSystem,
    mode: CableMode,
    node: &[f64],
    (cable, length): (&CableGeometry<3>, Jet<3>),
    (first, weights): (usize, &[f64]),
    derivatives: &mut NodeDerivatives,
) {
    let (width, count, cable_at) = (system.width(), system.cable_count(mode), system.cable_indices());
    let radius = envelope_radius(cable, length, system.problem.vehicle.radius_m);
    let rows = derivatives.path_constraints[first * width..].chunks_exact_mut(width);
    for ((row, weight), obstacle) in rows.zip(weights).zip(&system.problem.obstacles) {
        let distance = obstacle.distance([node[0], node[1]]);
        row[..2].copy_from_slice(&distance.gradient);
        for (index, slope) in cable_at.into_iter().zip(radius.gradient).take(count) {
            row[index] = -slope;
        }
        distance.add_hessian(derivatives.hessian, width, *weight);
        radius.scatter(derivatives.hessian, width, cable_at, count, -weight);
    }
}
