//! Body, cable and load, each kept clear of every obstacle:
//!
//! ```text
//! δ(p) - r' - r_2 >= 0,    δ(p + ρ d) - r' - r_load >= 0,    min { δ(p + s ρ d) : 0 <= s <= 1 } - r' >= 0
//! ```
//!
//! with the signed distance δ from the prism. The body is the ball around its disc, whatever its attitude. δ is convex, so
//! the least distance along the cable has one minimum, which bisection of its slope finds. Outside the obstacles this is the
//! distance of the segment (GJK); where the cable cuts an obstacle, it is the depth of its deepest point, which has the sign
//! of the penetration depth (EPA) and reaches zero with it.

use nalgebra::{Matrix3, SMatrix, SVector, Vector3};

use super::cable::CableGeometry;
use super::jet::Jet;
use super::prism_distance::{PrismDistance, prism_distance};
use super::problem::{CableMode, Problem};
use super::system::SlungLoadSystem;
use crate::pseudospectral::NodeDerivatives;

/// Constraints per obstacle: of the body, of the load, of the cable.
pub const PER_OBSTACLE: usize = 3;

/// Bisections of the slope along the cable.
const BISECTIONS: usize = 50;

/// Curvature along the cable below which its closest point does not move, m.
const MIN_CURVATURE_M: f64 = 1e-9;

/// Quadrotor and cable at a node: position and vector to the load, m.
#[derive(Clone, Copy)]
struct Line {
    start: Vector3<f64>,
    along: Vector3<f64>,
}

impl Line {
    fn at(node: &[f64], along: [f64; 3]) -> Self {
        Self { start: Vector3::new(node[0], node[1], node[2]), along: along.into() }
    }

    fn distance(&self, problem: &Problem, obstacle: usize, fraction: f64) -> PrismDistance {
        let point = self.start + self.along * fraction;
        prism_distance(&problem.obstacles[obstacle], problem.altitudes_m(obstacle), point)
    }

    /// Fraction of the cable at which it is closest to an obstacle.
    fn closest(&self, problem: &Problem, obstacle: usize) -> f64 {
        let slope = |fraction: f64| self.distance(problem, obstacle, fraction).gradient.dot(&self.along);
        if slope(0.0) >= 0.0 {
            return 0.0;
        }
        if slope(1.0) <= 0.0 {
            return 1.0;
        }
        let (mut before, mut after) = (0.0, 1.0);
        for _ in 0..BISECTIONS {
            let middle = 0.5 * (before + after);
            *(if slope(middle) < 0.0 { &mut before } else { &mut after }) = middle;
        }
        0.5 * (before + after)
    }
}

/// Fraction along the cable and radius of each part, m; in the order of the constraints.
fn parts(problem: &Problem, line: &Line, obstacle: usize) -> [(f64, f64); PER_OBSTACLE] {
    let vehicle = &problem.vehicle;
    [(0.0, vehicle.radius_m), (1.0, vehicle.load_radius_m), (line.closest(problem, obstacle), 0.0)]
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
    let line = Line::at(node, cable.direction.map(|d| length_m * d.value));
    for (obstacle, constraints) in constraints.chunks_exact_mut(PER_OBSTACLE).enumerate() {
        for (constraint, (fraction, radius_m)) in constraints.iter_mut().zip(parts(problem, &line, obstacle)) {
            *constraint = line.distance(problem, obstacle, fraction).value - radius_m - problem.limits.clearance_m;
        }
    }
}

/// Writes the Jacobian and adds the weighted Hessian; the first constraint is number `first`.
pub fn differentiate(
    system: &SlungLoadSystem,
    mode: CableMode,
    node: &[f64],
    (cable, length): (&CableGeometry<3>, Jet<3>),
    (first, weights): (usize, &[f64]),
    derivatives: &mut NodeDerivatives,
) {
    let problem = system.problem;
    let (width, count) = (system.width(), 3 + system.cable_count(mode));
    let [alpha, beta, rho] = system.cable_indices();
    let at = [0, 1, 2, alpha, beta, rho];
    let along = cable.direction.map(|d| d * length);
    let line = Line::at(node, along.map(|component| component.value));
    let rows = derivatives.path_constraints[first * width..].chunks_exact_mut(PER_OBSTACLE * width);
    let by_obstacle = rows.zip(weights.chunks_exact(PER_OBSTACLE)).take(problem.obstacles.len());
    for (obstacle, (rows, weights)) in by_obstacle.enumerate() {
        let parts = parts(problem, &line, obstacle);
        for ((row, weight), (fraction, _)) in rows.chunks_exact_mut(width).zip(weights).zip(parts) {
            let distance = line.distance(problem, obstacle, fraction);
            let (gradient, hessian) = at_fraction(&distance, &line, &along, fraction);
            for i in 0..count {
                row[at[i]] = gradient[i];
                for j in 0..count {
                    derivatives.hessian[at[i] * width + at[j]] += weight * hessian[(i, j)];
                }
            }
        }
    }
}

/// Gradient and Hessian with respect to (p, α, β, ρ) of the distance at a fraction s of the cable. Between its ends, the
/// closest point moves along: with `f(x, s)` that distance, the Hessian is `f_xx - f_xs f_sx/f_ss`.
fn at_fraction(
    distance: &PrismDistance,
    line: &Line,
    along: &[Jet<3>; 3],
    fraction: f64,
) -> (SVector<f64, 6>, SMatrix<f64, 6, 6>) {
    let cable_jacobian = Matrix3::from_fn(|k, i| along[k].gradient[i]);
    let mut jacobian = SMatrix::<f64, 3, 6>::zeros();
    jacobian.fixed_columns_mut::<3>(0).copy_from(&Matrix3::identity());
    jacobian.fixed_columns_mut::<3>(3).copy_from(&(cable_jacobian * fraction));
    let gradient = jacobian.transpose() * distance.gradient;
    let mut hessian = jacobian.transpose() * distance.hessian * jacobian;
    for (i, j) in (0..3).flat_map(|i| (0..3).map(move |j| (i, j))) {
        let curvature: f64 = (0..3).map(|k| distance.gradient[k] * along[k].hessian[i][j]).sum();
        hessian[(3 + i, 3 + j)] += fraction * curvature;
    }
    let along_curvature = line.along.dot(&(distance.hessian * line.along));
    if fraction > 0.0 && fraction < 1.0 && along_curvature > MIN_CURVATURE_M {
        let mut mixed: SVector<f64, 6> = jacobian.transpose() * distance.hessian * line.along;
        let turning = cable_jacobian.transpose() * distance.gradient;
        (0..3).for_each(|i| mixed[3 + i] += turning[i]);
        hessian -= mixed * mixed.transpose() / along_curvature;
    }
    (gradient, hessian)
}
