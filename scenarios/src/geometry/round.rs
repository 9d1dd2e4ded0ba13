//! Balls, capsules and boxes: distances in closed form, and triangles for drawing.

use super::NearestPoint;

/// Corners of a circle that is drawn.
const MERIDIANS: usize = 24;
const PARALLELS: usize = 6;

/// To the surface of a ball.
pub fn to_ball(point_m: [f64; 3], center_m: [f64; 3], radius_m: f64) -> NearestPoint {
    let from_center_m = difference(point_m, center_m);
    let distance_m = norm(from_center_m);
    // Every direction is as near from the centre.
    let outward = if distance_m > 0.0 { from_center_m.map(|it| it / distance_m) } else { [0.0, 0.0, 1.0] };
    let nearest_m = std::array::from_fn(|axis| center_m[axis] + radius_m * outward[axis]);
    NearestPoint { signed_distance_m: distance_m - radius_m, point_m: nearest_m }
}

/// To the surface of a capsule: to that of the ball about the nearest point of its axis.
pub fn to_capsule(point_m: [f64; 3], [a_m, b_m]: [[f64; 3]; 2], radius_m: f64) -> NearestPoint {
    let (along_m, from_a_m) = (difference(b_m, a_m), difference(point_m, a_m));
    let squared_m2 = dot(along_m, along_m);
    let fraction = if squared_m2 > 0.0 { (dot(from_a_m, along_m) / squared_m2).clamp(0.0, 1.0) } else { 0.0 };
    to_ball(point_m, std::array::from_fn(|axis| a_m[axis] + fraction * along_m[axis]), radius_m)
}

/// To the surface of an axis-aligned box about the origin: outside, to the nearest point of face, edge or corner; inside, to
/// the nearest face.
pub fn to_box(point_m: [f64; 3], half_size_m: [f64; 3]) -> NearestPoint {
    let beyond_m: [f64; 3] = std::array::from_fn(|axis| point_m[axis].abs() - half_size_m[axis]);
    if beyond_m.iter().any(|beyond_m| *beyond_m > 0.0) {
        let nearest_m = std::array::from_fn(|axis| point_m[axis].clamp(-half_size_m[axis], half_size_m[axis]));
        return NearestPoint { signed_distance_m: norm(difference(point_m, nearest_m)), point_m: nearest_m };
    }
    let nearest = (1..3).fold(0, |best, axis| if beyond_m[axis] > beyond_m[best] { axis } else { best });
    let mut nearest_m = point_m;
    nearest_m[nearest] = half_size_m[nearest].copysign(point_m[nearest]);
    NearestPoint { signed_distance_m: beyond_m[nearest], point_m: nearest_m }
}

/// The twelve triangles of an axis-aligned box about the origin, counterclockwise from outside.
pub fn box_triangles(half_size_m: [f64; 3]) -> Vec<[[f64; 3]; 3]> {
    let corner = |bits: usize| std::array::from_fn(|axis| half_size_m[axis] * [-1.0, 1.0][bits >> axis & 1]);
    let faces = [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]];
    faces.into_iter().flat_map(|[a, b, c, d]| [[a, b, c], [a, c, d]]).map(|triangle| triangle.map(corner)).collect()
}

/// Triangles of a polyhedron inscribed in a capsule; a ball has equal ends.
pub fn capsule_triangles([a_m, b_m]: [[f64; 3]; 2], radius_m: f64) -> Vec<[[f64; 3]; 3]> {
    let along_m = difference(b_m, a_m);
    let axis = if norm(along_m) > 0.0 { along_m.map(|it| it / norm(along_m)) } else { [0.0, 0.0, 1.0] };
    let across = perpendicular(axis);
    let other = cross(axis, across);
    // Rings from the pole at a to that at b; the two rings of latitude 0 lie around the ends.
    let ring = |step: usize| {
        let (center_m, latitude) = if step <= PARALLELS { (a_m, step) } else { (b_m, step - 1) };
        let (sin, cos) = ((latitude as f64 / PARALLELS as f64 - 1.0) * std::f64::consts::FRAC_PI_2).sin_cos();
        let point = move |meridian: usize| -> [f64; 3] {
            let (east, north) = (meridian as f64 / MERIDIANS as f64 * std::f64::consts::TAU).sin_cos();
            let outward = |k: usize| sin * axis[k] + cos * (north * across[k] + east * other[k]);
            std::array::from_fn(|k| center_m[k] + radius_m * outward(k))
        };
        (0..=MERIDIANS).map(point).collect::<Vec<_>>()
    };
    let rings: Vec<Vec<[f64; 3]>> = (0..2 * PARALLELS + 2).map(ring).collect();
    let between = |pair: &[Vec<[f64; 3]>]| {
        let quad = |k: usize| {
            let [a, b, c, d] = [pair[0][k], pair[0][k + 1], pair[1][k + 1], pair[1][k]];
            [[a, b, c], [a, c, d]]
        };
        (0..MERIDIANS).flat_map(quad).collect::<Vec<_>>()
    };
    rings.windows(2).flat_map(between).filter(|[a, b, c]| a != b && b != c && a != c).collect()
}

/// A unit vector perpendicular to another.
fn perpendicular(axis: [f64; 3]) -> [f64; 3] {
    let helper = if axis[2].abs() < 0.9 { [0.0, 0.0, 1.0] } else { [1.0, 0.0, 0.0] };
    let across = cross(helper, axis);
    across.map(|it| it / norm(across))
}

pub fn difference(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    std::array::from_fn(|axis| a[axis] - b[axis])
}

pub fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

pub fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

pub fn norm(a: [f64; 3]) -> f64 {
    dot(a, a).sqrt()
}

#[cfg(test)]
mod tests {
    use super::{NearestPoint, to_ball, to_box, to_capsule};

    fn assert_is(found: NearestPoint, distance_m: f64, point_m: [f64; 3]) {
        let error_m = (0..3).map(|axis| (found.point_m[axis] - point_m[axis]).abs()).fold(0.0, f64::max);
        assert!((found.signed_distance_m - distance_m).abs() < 1e-12 && error_m < 1e-12, "{found:?}");
    }

    #[test]
    fn distances_in_closed_form_are_those_of_geometry() {
        assert_is(to_ball([3.0, 0.0, 5.0], [0.0, 0.0, 1.0], 2.0), 3.0, [1.2, 0.0, 2.6]);
        assert_is(to_ball([0.5, 0.0, 0.0], [0.0; 3], 2.0), -1.5, [2.0, 0.0, 0.0]);
        let boom = [[0.0, 0.0, 0.0], [4.0, 0.0, 0.0]];
        assert_is(to_capsule([2.0, 3.0, 0.0], boom, 1.0), 2.0, [2.0, 1.0, 0.0]);
        assert_is(to_capsule([7.0, 4.0, 0.0], boom, 1.0), 4.0, [4.6, 0.8, 0.0]);
        assert_is(to_box([3.0, 4.0, 0.0], [1.0, 1.0, 1.0]), 13.0_f64.sqrt(), [1.0, 1.0, 0.0]);
        assert_is(to_box([0.2, -0.9, 0.0], [1.0, 1.0, 1.0]), -0.1, [0.2, -1.0, 0.0]);
    }
}
