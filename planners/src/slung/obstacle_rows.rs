//! Constraints, each to be >= 0, that keep the vehicle clear of the obstacles, in the form of [`Avoidance`].

use super::cable::CableGeometry;
use super::jet::Jet;
use super::problem::{Avoidance, CableMode};
use super::system::SlungLoadSystem;
use super::{parts, r_function, smooth_envelope};
use crate::pseudospectral::NodeDerivatives;

/// Number of constraints.
pub fn count(system: &SlungLoadSystem) -> usize {
    let per_obstacle = match system.problem.avoidance {
        Avoidance::SmoothEnvelope => smooth_envelope::PER_OBSTACLE,
        Avoidance::RFunction => 1,
        Avoidance::Parts => parts::PER_OBSTACLE,
    };
    per_obstacle * system.problem.obstacles.len()
}

/// Writes the constraints.
///
/// - `length_m`: length ρ of the cable
pub fn evaluate(
    system: &SlungLoadSystem,
    node: &[f64],
    cable: &CableGeometry<0>,
    length_m: f64,
    constraints: &mut [f64],
) {
    match system.problem.avoidance {
        Avoidance::SmoothEnvelope => smooth_envelope::evaluate(system, node, cable, length_m, constraints),
        Avoidance::RFunction => r_function::evaluate(system, node, cable, length_m, constraints),
        Avoidance::Parts => parts::evaluate(system, node, cable, length_m, constraints),
    }
}

/// Writes the Jacobian and adds the weighted Hessian.
///
/// - `cable`, `length`: geometry of the cable and its length, as jets of (α, β, ρ)
/// - `first`: number of the first of these constraints among the path constraints
/// - `weights`: those of the Hessian, from the first constraint on
#[inline(always)]
pub fn differentiate(
    system: &SlungLoadSystem,
    mode: CableMode,
    node: &[f64],
    (cable, length): (&CableGeometry<3>, Jet<3>),
    (first, weights): (usize, &[f64]),
    derivatives: &mut NodeDerivatives,
) {
    let rows = (first, weights);
    match system.problem.avoidance {
        Avoidance::SmoothEnvelope => {
            smooth_envelope::differentiate(system, mode, node, (cable, length), rows, derivatives);
        }
        Avoidance::RFunction => r_function::differentiate(system, mode, node, (cable, length), rows, derivatives),
        Avoidance::Parts => parts::differentiate(system, mode, node, (cable, length), rows, derivatives),
    }
}
