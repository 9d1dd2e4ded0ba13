//! Signed distance between convex shapes and upright prisms.
//!
//! Separated shapes: the point of their Minkowski difference closest to the origin, by the method of Gilbert, Johnson
//! and Keerthi (1988). Every iteration bounds the distance, |v| from above and v·w/|v| from below. The lower bound is
//! returned, so that the result is conservative. Overlapping shapes: their penetration depth, with the sign of an overlap.

use nalgebra::{Matrix2, Matrix3, Vector2, Vector3};
use scenarios::{Prism, Range};

use super::convex_part::ConvexPart;
use super::penetration::smallest_overlap;

/// Difference of the bounds at which the iteration ends, m.
const TOLERANCE_M: f64 = 1e-10;
/// Below this distance the shapes overlap, m.
const OVERLAP_M: f64 = 1e-9;
/// Maximum number of iterations: fewer are needed, but rounding may stall the bounds.
const MAX_ITERATIONS: usize = 200;
/// Length by which an unbounded prism is continued above and below the shape, m. The distance does not depend on it.
pub const OVERHANG_M: f64 = 1.0;

/// A supporting plane of a prism: a shape at signed distance d in front of the plane has at least the signed distance d from
/// the prism.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SeparatingPlane {
    /// Unit normal that points away from the prism, world frame.
    pub normal: Vector3<f64>,
    /// Scalar product of the normal and the support point of the prism, m.
    pub offset_m: f64,
}

/// Signed distance between a shape and a prism, whose corners are counterclockwise, m.
pub(super) fn to_prism_m(shape: &ConvexPart, prism: &Prism) -> f64 {
    to_prism(shape, prism).0
}

/// Signed distance as [`to_prism_m`], and a supporting plane of the prism at that signed distance from the shape. For an
/// unbounded prism the plane is valid for shapes within [`OVERHANG_M`] of this one.
pub(super) fn to_prism(shape: &ConvexPart, prism: &Prism) -> (f64, SeparatingPlane) {
    let z_m = prism.z_m.unwrap_or_else(|| {
        let [low, high] = [-1.0, 1.0].map(|sign| shape.support_m(&(Vector3::z() * sign)).z);
        Range::new(low - OVERHANG_M, high + OVERHANG_M)
    });
    let difference = |direction: &Vector3<f64>| shape.support_m(direction) - prism_support_m(prism, z_m, &-direction);
    let plane = |normal: Vector3<f64>| {
        let offset_m = prism_support_m(prism, z_m, &normal).dot(&normal);
        SeparatingPlane { normal, offset_m }
    };
    match separation(&difference) {
        None => {
            let (depth_m, into_prism) = smallest_overlap(shape, prism, &difference);
            (-depth_m, plane(-into_prism))
        }
        Some((distance_m, normal)) => (distance_m, plane(normal)),
    }
}

/// Signed distance between a point and a prism, whose corners are counterclockwise, m.
pub(super) fn point_to_prism_m(point_m: &Vector3<f64>, prism: &Prism) -> f64 {
    let beside_m = prism.signed_distance_m([point_m.x, point_m.y]);
    let above_m = prism.z_m.map_or(f64::NEG_INFINITY, |z| (point_m.z - z.max).max(z.min - point_m.z));
    if beside_m.is_nan() || point_m.z.is_nan() {
        return f64::NAN;
    }
    if beside_m.max(above_m) <= 0.0 { beside_m.max(above_m) } else { beside_m.max(0.0).hypot(above_m.max(0.0)) }
}

fn prism_support_m(prism: &Prism, z_m: Range, direction: &Vector3<f64>) -> Vector3<f64> {
    let along = |corner: &[f64; 2]| corner[0] * direction.x + corner[1] * direction.y;
    let support = prism.corners_m.iter().max_by(|a, b| along(a).total_cmp(&along(b)));
    let [x, y] = support.copied().expect("a prism has corners");
    Vector3::new(x, y, if direction.z >= 0.0 { z_m.max } else { z_m.min })
}

/// Distance of the origin from a convex set, given by its support function, m, and the direction in which the set is at
/// least that far away; `None` if the set contains the origin. NaN if the set has NaN coordinates.
pub(super) fn separation(support: &impl Fn(&Vector3<f64>) -> Vector3<f64>) -> Option<(f64, Vector3<f64>)> {
    let mut closest = support(&Vector3::x());
    let mut simplex = Simplex::new(closest);
    let (mut lower_m, mut normal) = (f64::NEG_INFINITY, Vector3::zeros());
    for _ in 0..MAX_ITERATIONS {
        let distance_m = closest.norm();
        if distance_m.is_nan() {
            return Some((f64::NAN, normal));
        }
        if distance_m <= OVERLAP_M {
            return None;
        }
        let corner = support(&-closest);
        let bound_m = closest.dot(&corner) / distance_m;
        if bound_m > lower_m {
            (lower_m, normal) = (bound_m, closest / distance_m);
        }
        if distance_m - lower_m <= TOLERANCE_M {
            break;
        }
        (closest, simplex) = simplex.with(corner).closest();
    }
    // Without a separating plane the shapes count as overlapping.
    (lower_m > 0.0).then_some((lower_m, normal))
}

/// Up to four corners of a simplex.
#[derive(Clone, Copy, Debug)]
struct Simplex {
    corners: [Vector3<f64>; 4],
    count: usize,
}

impl Simplex {
    fn new(corner: Vector3<f64>) -> Self {
        Self { corners: [corner; 4], count: 1 }
    }

    /// With one more corner. A simplex with four corners contains the origin, and is never extended.
    fn with(mut self, corner: Vector3<f64>) -> Self {
        self.corners[self.count.min(3)] = corner;
        self.count = (self.count + 1).min(4);
        self
    }

    /// The point of the simplex closest to the origin, and the face that contains it: of all faces that contain the
    /// closest point of their own plane, the closest one.
    fn closest(&self) -> (Vector3<f64>, Self) {
        let mut best = (self.corners[0], Self::new(self.corners[0]));
        let mut min_m2 = f64::INFINITY;
        for chosen in 1_u32..(1 << self.count) {
            let mut face = Self { count: 0, ..*self };
            for index in (0..self.count).filter(|index| chosen & (1 << index) != 0) {
                face = face.with(self.corners[index]);
            }
            let Some(point) = face.closest_of_plane() else { continue };
            if point.norm_squared() < min_m2 {
                (best, min_m2) = ((point, face), point.norm_squared());
            }
        }
        best
    }

    /// The point closest to the origin of the plane through all corners, if it lies between them.
    ///
    /// Its barycentric coordinates λ_j with respect to all corners but p_0 solve (p_i - p_0)·(p_j - p_0) λ_j = -(p_i -
    /// p_0)·p_0.
    fn closest_of_plane(&self) -> Option<Vector3<f64>> {
        let base = self.corners[0];
        let edge = |i: usize| self.corners[i + 1] - base;
        let barycentric = match self.count {
            1 => Vector3::zeros(),
            2 => {
                let a = edge(0);
                Vector3::new(-a.dot(&base) / a.norm_squared(), 0.0, 0.0)
            }
            3 => {
                let (a, b) = (edge(0), edge(1));
                let gram = Matrix2::new(a.dot(&a), a.dot(&b), b.dot(&a), b.dot(&b));
                let solution = gram.lu().solve(&-Vector2::new(a.dot(&base), b.dot(&base)))?;
                Vector3::new(solution.x, solution.y, 0.0)
            }
            _ => {
                // Three edges span space: the origin itself is the closest point.
                Matrix3::from_columns(&[edge(0), edge(1), edge(2)]).lu().solve(&-base)?
            }
        };
        let lies_between = barycentric.sum() <= 1.0 && barycentric.iter().all(|coordinate| *coordinate >= 0.0);
        let offset = |i: usize| edge(i) * barycentric[i];
        lies_between.then(|| (0..self.count - 1).fold(base, |point, i| point + offset(i)))
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::UnitQuaternion;

    use super::*;

    fn prism(z_m: Option<Range>) -> Prism {
        Prism { name: "wall".into(), corners_m: vec![[0.05, 0.4], [-0.05, 0.4], [-0.05, -0.4], [0.05, -0.4]], z_m }
    }

    fn disc(center_m: [f64; 3], roll: f64, pitch: f64) -> ConvexPart {
        let axis = UnitQuaternion::from_euler_angles(roll, pitch, 0.0) * Vector3::z();
        ConvexPart::Disc { center_m: center_m.into(), axis, radius_m: 0.352 }
    }

    #[test]
    fn distance_of_a_disc_from_a_wall_is_closed_form() {
        for step in 0..500 {
            let (angle, x_m) = (f64::from(step) * 0.11, 0.04 * (f64::from(step) * 0.37).sin());
            let (roll, pitch) = (0.6 * angle.sin(), 0.5 * (1.7 * angle).cos());
            let shape = disc([x_m, -0.8, 1.3], roll, pitch);
            let ConvexPart::Disc { axis, radius_m, .. } = shape else { unreachable!() };
            let reach_m = radius_m * (1.0 - axis.y * axis.y).sqrt();
            let touch = shape.support_m(&Vector3::y());
            let distance_m = to_prism_m(&shape, &prism(None));
            if touch.x.abs() <= 0.05 {
                assert!((distance_m - (0.4 - reach_m)).abs() < 1e-8, "{distance_m} {}", 0.4 - reach_m);
            } else {
                assert!(distance_m > 0.4 - reach_m);
            }
        }
    }

    /// The distance of many points of the shape is an upper bound.
    #[test]
    fn distances_agree_with_those_of_many_points() {
        let (mut seen_apart, mut seen_overlapping) = (0, 0);
        for step in 0..400 {
            let angle = f64::from(step) * 0.61;
            let center_m = [0.5 * angle.sin(), 0.75 * (1.3 * angle).cos(), 1.0 + 0.3 * (0.7 * angle).sin()];
            let z_m = (step % 2 == 0).then_some(Range::new(0.2, 1.0));
            let (shape, prism) = (disc(center_m, 0.4 * angle.cos(), 0.3 * angle.sin()), prism(z_m));
            let ConvexPart::Disc { center_m, axis, radius_m } = shape else { unreachable!() };
            let [u, v] = [axis.cross(&Vector3::x()).normalize(), axis.cross(&axis.cross(&Vector3::x()).normalize())];
            let rings = (0..=60).flat_map(|ring| (0..240).map(move |spoke| (f64::from(ring) / 60.0, f64::from(spoke))));
            let points = rings.map(|(fraction, spoke)| {
                let (sin, cos) = (spoke * std::f64::consts::TAU / 240.0).sin_cos();
                center_m + (u * cos + v * sin) * (radius_m * fraction)
            });
            let sampled_m = points.map(|point| point_to_prism_m(&point, &prism)).fold(f64::INFINITY, f64::min);
            let distance_m = to_prism_m(&shape, &prism);
            if distance_m > 0.0 {
                seen_apart += 1;
                assert!(distance_m <= sampled_m + 1e-9 && sampled_m - distance_m < 0.006, "{distance_m} {sampled_m}");
            } else {
                seen_overlapping += 1;
                assert!(sampled_m < 0.006, "{distance_m} {sampled_m}");
            }
        }
        assert!(seen_apart > 100 && seen_overlapping > 30, "{seen_apart} {seen_overlapping}");
    }

    #[test]
    fn a_line_is_separated_down_to_a_micrometre() {
        let line = |x_m: f64| ConvexPart::Line { ends_m: [Vector3::new(x_m, -1.0, 2.0), Vector3::new(x_m, 1.0, 0.5)] };
        for gap_m in [1.0, 1e-3, 1e-6] {
            assert!((to_prism_m(&line(0.05 + gap_m), &prism(None)) - gap_m).abs() < 1e-9);
            assert!((to_prism_m(&line(0.05 - gap_m * 0.01), &prism(None)) + gap_m * 0.01).abs() < 1e-9);
        }
        assert!(to_prism_m(&line(f64::NAN), &prism(None)).is_nan());
    }
}
