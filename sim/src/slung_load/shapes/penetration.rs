//! Depth of an overlap: the smallest displacement that separates a shape from a prism.
//!
//! It is the minimum over all directions n of the overlap h(n) of the two along n. The minimum lies where a face of one meets
//! the other or where two edges cross, so that a finite number of directions suffices; for the rim of a disc and an edge of the
//! prism it is the minimum of a function of one angle.

use std::f64::consts::TAU;

use nalgebra::Vector3;
use scenarios::Prism;

use super::convex_part::ConvexPart;
use super::golden_section;

/// Directions around an edge from which minima are bracketed.
const BRACKETS: usize = 16;

/// The smallest overlap, m, and its direction, in which the shape reaches into the prism.
///
/// - `difference`: support function of the shape minus the prism
pub fn smallest_overlap(
    shape: &ConvexPart,
    prism: &Prism,
    difference: &impl Fn(&Vector3<f64>) -> Vector3<f64>,
) -> (f64, Vector3<f64>) {
    let overlap_m = |normal: &Vector3<f64>| difference(normal).dot(normal);
    let candidates = directions(shape, prism).into_iter().map(|normal| (overlap_m(&normal).max(0.0), normal));
    candidates.reduce(|best, next| if next.0 < best.0 { next } else { best }).expect("a prism has faces")
}

/// Directions that contain the one of the smallest overlap. An unbounded prism can be left sideways only.
fn directions(shape: &ConvexPart, prism: &Prism) -> Vec<Vector3<f64>> {
    let count = prism.corners_m.len();
    let corner = |index: usize| Vector3::new(prism.corners_m[index % count][0], prism.corners_m[index % count][1], 0.0);
    let mut normals = Vec::new();
    for index in 0..count {
        let edge = corner(index + 1) - corner(index);
        normals.push(Vector3::new(edge.y, -edge.x, 0.0).normalize());
        shape.normals_at(&Vector3::z(), &corner(index), &mut normals);
        if let Some(z_m) = prism.z_m {
            for height_m in [z_m.min, z_m.max] {
                shape.normals_at(&edge, &(corner(index) + Vector3::z() * height_m), &mut normals);
            }
        }
    }
    if prism.z_m.is_some() {
        normals.push(Vector3::z());
        normals.extend(shape.face_normal());
    }
    normals.iter().flat_map(|normal| [*normal, -normal]).collect()
}

impl ConvexPart {
    /// Normals of contacts between the shape and an edge of this direction through this point.
    fn normals_at(&self, edge: &Vector3<f64>, point_m: &Vector3<f64>, normals: &mut Vec<Vector3<f64>>) {
        match self {
            Self::Line { ends_m: [a, b] } => normals.extend(edge.cross(&(b - a)).try_normalize(1e-9)),
            Self::Disc { center_m, axis, radius_m } => {
                normals.extend(rim_normals(&(center_m - point_m), axis, *radius_m, edge));
            }
        }
    }

    fn face_normal(&self) -> Option<Vector3<f64>> {
        match self {
            Self::Line { .. } => None,
            Self::Disc { axis, .. } => Some(*axis),
        }
    }
}

/// Normals at which the overlap of a disc's rim and an edge is smallest:
///
/// ```text
/// f(n) = r·n + R sqrt(1 - (a·n)²),   n perpendicular to the edge
/// ```
///
/// - `relative_m`: the disc's centre relative to a point of the edge, r
fn rim_normals(
    relative_m: &Vector3<f64>,
    axis: &Vector3<f64>,
    radius_m: f64,
    edge: &Vector3<f64>,
) -> impl Iterator<Item = Vector3<f64>> {
    let side = Vector3::ith(edge.iamin(), 1.0);
    let across = edge.cross(&side).normalize();
    let basis = [across, edge.cross(&across).normalize()];
    let normal = move |angle: f64| basis[0] * angle.cos() + basis[1] * angle.sin();
    let (relative_m, axis) = (*relative_m, *axis);
    let overlap_m = move |angle: f64| {
        let normal = normal(angle);
        relative_m.dot(&normal) + radius_m * (1.0 - axis.dot(&normal).powi(2)).max(0.0).sqrt()
    };
    let step = TAU / BRACKETS as f64;
    let sampled_m: [f64; BRACKETS] = std::array::from_fn(|index| overlap_m(index as f64 * step));
    let minima = (0..BRACKETS).filter(move |index| {
        let [before, after] = [index + BRACKETS - 1, index + 1].map(|neighbour| sampled_m[neighbour % BRACKETS]);
        sampled_m[*index] <= before && sampled_m[*index] <= after
    });
    minima.map(move |index| {
        let middle = index as f64 * step;
        normal(golden_section::argmin(overlap_m, [middle - step, middle + step]))
    })
}

#[cfg(test)]
mod tests {
    use nalgebra::UnitQuaternion;
    use scenarios::Range;

    use super::super::distance::to_prism;
    use super::*;

    const RADIUS_M: f64 = 0.352;

    fn block(z_m: Option<Range>) -> Prism {
        let corners_m = vec![[0.5, 0.4], [-0.5, 0.4], [-0.5, -0.4], [0.5, -0.4]];
        Prism { name: "block".into(), corners_m, z_m }
    }

    fn disc(center_m: [f64; 3], roll: f64, pitch: f64) -> ConvexPart {
        let axis = UnitQuaternion::from_euler_angles(roll, pitch, 0.0) * Vector3::z();
        ConvexPart::Disc { center_m: center_m.into(), axis, radius_m: RADIUS_M }
    }

    fn moved(shape: ConvexPart, by_m: Vector3<f64>) -> ConvexPart {
        match shape {
            ConvexPart::Disc { center_m, axis, radius_m } => {
                ConvexPart::Disc { center_m: center_m + by_m, axis, radius_m }
            }
            ConvexPart::Line { ends_m } => ConvexPart::Line { ends_m: ends_m.map(|end_m| end_m + by_m) },
        }
    }

    #[test]
    fn a_level_disc_at_a_corner_overlaps_by_what_its_centre_is_too_near() {
        for (x_m, y_m) in [(0.6, 0.5), (0.7, 0.45), (-0.52, 0.55)] {
            let apart_m = f64::hypot(f64::abs(x_m) - 0.5, y_m - 0.4);
            let (distance_m, _) = to_prism(&disc([x_m, y_m, 1.0], 0.0, 0.0), &block(None));
            assert!((distance_m - (apart_m - RADIUS_M)).abs() < 1e-10, "({x_m}, {y_m}): {distance_m}");
        }
    }

    /// A displacement by the depth separates, and none that is shorter does, in any of many directions.
    #[test]
    fn the_depth_is_the_smallest_displacement_that_separates() {
        let mut overlapping = 0;
        for step in 0..300 {
            let angle = f64::from(step) * 0.61;
            let center_m = [0.7 * angle.sin(), 0.6 * (1.3 * angle).cos(), 1.0 + 0.3 * (0.7 * angle).sin()];
            let end_m = [0.6 * (2.1 * angle).cos(), 0.5 * (0.9 * angle).sin(), 1.0 - 0.4 * (1.7 * angle).cos()];
            let shape = if step % 3 == 0 {
                ConvexPart::Line { ends_m: [center_m.into(), end_m.into()] }
            } else {
                disc(center_m, 0.9 * angle.cos(), 0.7 * (2.0 * angle).sin())
            };
            let prism = block((step % 2 == 0).then_some(Range::new(0.6, 1.2)));
            let (distance_m, plane) = to_prism(&shape, &prism);
            if distance_m >= 0.0 {
                continue;
            }
            overlapping += 1;
            let depth_m = -distance_m;
            assert!(to_prism(&moved(shape, plane.normal * (depth_m + 1e-7)), &prism).0 > 0.0, "{step}: {depth_m}");
            for direction in 0..400 {
                // Directions of a spherical spiral; an unbounded prism is left sideways.
                let z = if prism.z_m.is_some() { 1.0 - (f64::from(direction) + 0.5) / 200.0 } else { 0.0 };
                let (sin, cos) = (f64::from(direction) * 2.399_963).sin_cos();
                let level = (1.0 - z * z).sqrt();
                let shorter = Vector3::new(level * cos, level * sin, z) * (depth_m - 1e-7);
                assert!(to_prism(&moved(shape, shorter), &prism).0 < 0.0, "{step}: {depth_m} along {shorter:?}");
            }
        }
        assert!(overlapping > 60, "{overlapping}");
    }
}
