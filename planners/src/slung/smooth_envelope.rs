//! The envelope circle by smooth constraints.
//!
//! The circle's radius is the largest of r_2, `√2 ρ |cos α sin β|` and `√2 ρ |sin α|` (Kang, Huang, Wen 2020, eq. 19,
//! 20). The paper's [R-functions](super::r_function) have kinks; five smooth constraints per obstacle are equivalent, with
//! the signed distance δ from the obstacle:
//!
//! ```text
//! δ - r' - r_2 >= 0,    δ - r' ± √2 ρ d_x >= 0,    δ - r' ± √2 ρ d_y >= 0
//! ```

use super::cable::CableGeometry;
use super::jet::Jet;
use super::problem::CableMode;
use super::system::SlungLoadSystem;
use crate::pseudospectral::NodeDerivatives;

/// Constraints per obstacle.
pub const PER_OBSTACLE: usize = 5;

/// `√2 ρ d_x` and `√2 ρ d_y`, m.
#[inline(always)]
fn reaches<const N: usize>(cable: &CableGeometry<N>, length: Jet<N>) -> [Jet<N>; 2] {
    [cable.direction[0], cable.direction[1]].map(|d| d * length * std::f64::consts::SQRT_2)
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
    let reaches = reaches(cable, Jet::constant(length_m)).map(|reach| reach.value);
    for (constraints, obstacle) in constraints.chunks_exact_mut(PER_OBSTACLE).zip(&problem.obstacles) {
        let gap_m = obstacle.distance([node[0], node[1]]).value - problem.limits.clearance_m;
        constraints[0] = gap_m - problem.vehicle.radius_m;
        for (pair, reach) in constraints[1..].chunks_exact_mut(2).zip(reaches) {
            (pair[0], pair[1]) = (gap_m - reach, gap_m + reach);
        }
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
    let reaches = reaches(cable, length);
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
        distance.add_hessian(derivatives.hessian, width, weights.iter().sum());
    }
    for (reach, weight) in reaches.iter().zip(reach_weights) {
        reach.scatter(derivatives.hessian, width, cable_at, count, weight);
    }
}
