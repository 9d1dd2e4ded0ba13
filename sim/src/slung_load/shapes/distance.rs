//! Signed distance between convex shapes and upright prisms.
//!
//! Separated shapes: the point nearest to the origin of their difference, by the method of Gilbert, Johnson and Keerthi
//! (1988). Every iteration bounds the distance from both sides, |v| from above and v·w/|v| from below, and the bound from
//! below is what is returned: the result never flatters. Overlapping shapes: the least gap along the normals of the prism's
//! faces and of its edges against the shape's, which is the depth, or more.

use nalgebra::{Matrix2, Matrix3, Vector2, Vector3};
use scenarios::{Prism, Range};

/// Distance between the bounds at which the search ends, m.
const TOLERANCE_M: f64 = 1e-10;
/// Below this distance shapes overlap, m.
const OVERLAP_M: f64 = 1e-9;
/// A direction that has less than this share across the axis is along it.
const ALONG: f64 = 1e-12;
/// More iterations are not needed, but rounding might let the last bounds stand still.
const MAX_ITERATIONS: usize = 200;
/// How far a prism without bottom or top reaches beyond the shape, m: any length says the same.
pub const OVERHANG_M: f64 = 1.0;

/// A flat disc or a straight line.
#[derive(Clone, Copy, Debug)]
pub(super) enum ConvexPart {
    Disc { center_m: Vector3<f64>, axis: Vector3<f64>, radius_m: f64 },
    Line { ends_m: [Vector3<f64>; 2] },
}

impl ConvexPart {
    /// The point that lies farthest in a direction.
    fn support_m(&self, direction: &Vector3<f64>) -> Vector3<f64> {
        match self {
            Self::Disc { center_m, axis, radius_m } => {
                let in_plane = |vector: &Vector3<f64>| vector - axis * axis.dot(vector);
                // Of a direction along the axis rounding would leave noise, which points out of the plane: once more.
                let across = in_plane(direction).try_normalize(ALONG * direction.norm());
                center_m + across.map_or_else(Vector3::zeros, |across| in_plane(&across).normalize() * *radius_m)
            }
            Self::Line { ends_m: [a, b] } => {
                if direction.dot(a) >= direction.dot(b) {
                    *a
                } else {
                    *b
                }
            }
        }
    }

    /// Normals for which the shape may touch an edge of this direction.
    fn normals_against(&self, edge: &Vector3<f64>) -> Option<Vector3<f64>> {
        match self {
            Self::Disc { axis, .. } => edge.cross(&axis.cross(edge)).try_normalize(1e-9),
            Self::Line { ends_m: [a, b] } => edge.cross(&(b - a)).try_normalize(1e-9),
        }
    }
}

/// A plane with a prism behind it: what is in front by d is farther away from the prism than d.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SeparatingPlane {
    /// Away from the prism, of unit length, world frame.
    pub normal: Vector3<f64>,
    /// What the normal gives, as a product, for the foremost point of the prism, m.
    pub offset_m: f64,
}

/// Signed distance between a shape and a prism with its corners counterclockwise, m.
pub(super) fn to_prism_m(shape: &ConvexPart, prism: &Prism) -> f64 {
    to_prism(shape, prism).0
}

/// The same with a plane between the two that is as far from the shape, if they do not overlap. Of a prism without bottom or
/// top it is one for shapes within [`OVERHANG_M`] of this one.
pub(super) fn to_prism(shape: &ConvexPart, prism: &Prism) -> (f64, Option<SeparatingPlane>) {
    let z_m = prism.z_m.unwrap_or_else(|| {
        let [low, high] = [-1.0, 1.0].map(|sign| shape.support_m(&(Vector3::z() * sign)).z);
        Range::new(low - OVERHANG_M, high + OVERHANG_M)
    });
    let difference = |direction: &Vector3<f64>| shape.support_m(direction) - prism_support_m(prism, z_m, &-direction);
    match separation(&difference) {
        None => (-depth_m(&difference, &normals(shape, prism)), None),
        Some((distance_m, normal)) => {
            let offset_m = prism_support_m(prism, z_m, &normal).dot(&normal);
            (distance_m, Some(SeparatingPlane { normal, offset_m }))
        }
    }
}

/// Signed distance between a point and a prism with its corners counterclockwise, m.
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
    let farthest = prism.corners_m.iter().max_by(|a, b| along(a).total_cmp(&along(b)));
    let [x, y] = farthest.copied().expect("a prism has corners");
    Vector3::new(x, y, if direction.z >= 0.0 { z_m.max } else { z_m.min })
}

/// Directions along which prism and shape may part.
fn normals(shape: &ConvexPart, prism: &Prism) -> Vec<Vector3<f64>> {
    let n = prism.corners_m.len();
    let mut normals = Vec::new();
    let edges = (0..n).map(|i| {
        let ([x0, y0], [x1, y1]) = (prism.corners_m[i], prism.corners_m[(i + 1) % n]);
        Vector3::new(x1 - x0, y1 - y0, 0.0)
    });
    for edge in edges {
        normals.push(Vector3::new(edge.y, -edge.x, 0.0).normalize());
        if prism.z_m.is_some() {
            normals.extend(shape.normals_against(&edge));
        }
    }
    if prism.z_m.is_some() {
        normals.push(Vector3::z());
    }
    normals.extend(shape.normals_against(&Vector3::z()));
    normals.iter().flat_map(|normal| [*normal, -normal]).collect()
}

/// The least overlap along these directions, m.
fn depth_m(difference: &impl Fn(&Vector3<f64>) -> Vector3<f64>, normals: &[Vector3<f64>]) -> f64 {
    let overlap_m = |normal: &Vector3<f64>| difference(normal).dot(normal);
    normals.iter().map(overlap_m).fold(f64::INFINITY, |least, overlap_m| least.min(overlap_m.max(0.0)))
}

/// Distance of the origin from a convex set, given by its farthest points, m, and the direction in which the set is at least so
/// far away; `None` if it holds the origin. NaN if it is made of such.
fn separation(farthest: &impl Fn(&Vector3<f64>) -> Vector3<f64>) -> Option<(f64, Vector3<f64>)> {
    let mut nearest = farthest(&Vector3::x());
    let mut simplex = Simplex::of(nearest);
    let (mut lower_m, mut normal) = (f64::NEG_INFINITY, Vector3::zeros());
    for _ in 0..MAX_ITERATIONS {
        let distance_m = nearest.norm();
        if distance_m.is_nan() {
            return Some((f64::NAN, normal));
        }
        if distance_m <= OVERLAP_M {
            return None;
        }
        let corner = farthest(&-nearest);
        let bound_m = nearest.dot(&corner) / distance_m;
        if bound_m > lower_m {
            (lower_m, normal) = (bound_m, nearest / distance_m);
        }
        if distance_m - lower_m <= TOLERANCE_M {
            break;
        }
        (nearest, simplex) = simplex.with(corner).nearest();
    }
    // Without a plane between them, they have not been told apart: then they overlap.
    (lower_m > 0.0).then_some((lower_m, normal))
}

/// Up to four corners of a simplex.
#[derive(Clone, Copy, Debug)]
struct Simplex {
    corners: [Vector3<f64>; 4],
    count: usize,
}

impl Simplex {
    fn of(corner: Vector3<f64>) -> Self {
        Self { corners: [corner; 4], count: 1 }
    }

    /// With one more corner; one that has four already holds the origin, and never asks for more.
    fn with(mut self, corner: Vector3<f64>) -> Self {
        self.corners[self.count.min(3)] = corner;
        self.count = (self.count + 1).min(4);
        self
    }

    /// The point of it nearest to the origin, and the face that this lies in: of all faces that hold their own plane's
    /// nearest point, the nearest.
    fn nearest(&self) -> (Vector3<f64>, Self) {
        let mut best = (self.corners[0], Self::of(self.corners[0]));
        let mut least_m2 = f64::INFINITY;
        for chosen in 1_u32..(1 << self.count) {
            let mut face = Self { count: 0, ..*self };
            for index in (0..self.count).filter(|index| chosen & (1 << index) != 0) {
                face = face.with(self.corners[index]);
            }
            let Some(nearest) = face.nearest_of_plane() else { continue };
            if nearest.norm_squared() < least_m2 {
                (best, least_m2) = ((nearest, face), nearest.norm_squared());
            }
        }
        best
    }

    /// The point nearest to the origin of the plane through all corners, if it lies between them.
    ///
    /// With p_0 as the base, Σ λ_i = 1: the others' shares solve (p_i - p_0)·(p_j - p_0) λ_j = -(p_i - p_0)·p_0.
    fn nearest_of_plane(&self) -> Option<Vector3<f64>> {
        let base = self.corners[0];
        let edge = |i: usize| self.corners[i + 1] - base;
        let shares = match self.count {
            1 => Vector3::zeros(),
            2 => {
                let a = edge(0);
                Vector3::new(-a.dot(&base) / a.norm_squared(), 0.0, 0.0)
            }
            3 => {
                let (a, b) = (edge(0), edge(1));
                let gram = Matrix2::new(a.dot(&a), a.dot(&b), b.dot(&a), b.dot(&b));
                let shares = gram.lu().solve(&-Vector2::new(a.dot(&base), b.dot(&base)))?;
                Vector3::new(shares.x, shares.y, 0.0)
            }
            _ => {
                // Three edges span space: the origin itself is the nearest point.
                Matrix3::from_columns(&[edge(0), edge(1), edge(2)]).lu().solve(&-base)?
            }
        };
        let lies_between = shares.sum() <= 1.0 && shares.iter().all(|share| *share >= 0.0);
        let offset = |i: usize| edge(i) * shares[i];
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
    fn a_disc_before_a_wall_is_as_far_as_it_reaches() {
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

    /// Against the distance of many points of the shape, which is never smaller.
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
            let points = rings.map(|(share, spoke)| {
                let (sin, cos) = (spoke * std::f64::consts::TAU / 240.0).sin_cos();
                center_m + (u * cos + v * sin) * (radius_m * share)
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
    fn a_line_is_told_apart_to_the_last_micrometre() {
        let line = |x_m: f64| ConvexPart::Line { ends_m: [Vector3::new(x_m, -1.0, 2.0), Vector3::new(x_m, 1.0, 0.5)] };
        for gap_m in [1.0, 1e-3, 1e-6] {
            assert!((to_prism_m(&line(0.05 + gap_m), &prism(None)) - gap_m).abs() < 1e-9);
            assert!((to_prism_m(&line(0.05 - gap_m * 0.01), &prism(None)) + gap_m * 0.01).abs() < 1e-9);
        }
        assert!(to_prism_m(&line(f64::NAN), &prism(None)).is_nan());
    }
}
