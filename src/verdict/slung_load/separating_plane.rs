//! The distance of a part from a plane that separates it from an obstacle.
//!
//! The plane separates the two best at the middle of an interval of time. Elsewhere in the interval its distance from the part
//! is below the true distance by a term of second order in time, while the bound by the largest speed is of first order.

use sim::slung_load::{Part, Parts, SeparatingPlane};

use super::motion::SlungLoadMotion;

/// Smallest signed distance of any point of a part from the plane over a part of a segment, m; negative behind the plane.
///
/// - `fraction`: beginning and end within the segment, in [0, 1]
pub fn in_front_m(
    plane: &SeparatingPlane,
    parts: &Parts,
    part: Part,
    motion: &SlungLoadMotion,
    segment: usize,
    fraction: [f64; 2],
) -> f64 {
    let [quadrotor, load] = motion.along(segment, fraction, &plane.normal);
    let nearest_m = match part {
        Part::Body => nearest_of_disc_m(plane, parts, motion, segment, fraction, quadrotor),
        Part::Cable => smallest(&quadrotor).min(smallest(&load)),
        Part::Load => smallest(&load) - parts.load_radius_m(),
    };
    nearest_m - plane.offset_m
}

/// Smallest dot product of the plane's normal n with a point of the body's disc (axis a, radius R, centre c):
///
/// ```text
/// n·c - R f,   f = sqrt(1 - x²),   x = a·n
/// f <= f_0 - x_0/f_0 (x - x_0)                             f is concave
/// |x - x_0 - x_0' s| <= |ω|²s²/2                           for a rotation at the constant rate ω
/// f <= f_0 + |ω s|                                         for a disc nearly parallel to the plane
/// ```
fn nearest_of_disc_m(
    plane: &SeparatingPlane,
    parts: &Parts,
    motion: &SlungLoadMotion,
    segment: usize,
    fraction: [f64; 2],
    center: [f64; 4],
) -> f64 {
    let (radius_m, half) = (parts.body_radius_m(), (fraction[1] - fraction[0]) / 2.0);
    let axis = motion.at(segment, f64::midpoint(fraction[0], fraction[1])).thrust_axis();
    let turn_rad = motion.turn_rad(segment);
    let turned_rad = turn_rad.norm() * half;
    let x = axis.dot(&plane.normal);
    let reach = (1.0 - x * x).max(0.0).sqrt();
    let lying_m = smallest(&center) - radius_m * (reach + turned_rad);
    let ratio = x / reach;
    if !ratio.is_finite() {
        return lying_m;
    }
    let slope_m = radius_m * ratio * turn_rad.cross(&axis).dot(&plane.normal) * half;
    let tilted: [f64; 4] = std::array::from_fn(|i| center[i] + slope_m * (i as f64 * 2.0 / 3.0 - 1.0));
    let tilted_m = smallest(&tilted) - radius_m * (reach + ratio.abs() * turned_rad * turned_rad / 2.0);
    lying_m.max(tilted_m)
}

fn smallest(coefficients: &[f64; 4]) -> f64 {
    coefficients.iter().copied().fold(f64::INFINITY, f64::min)
}
