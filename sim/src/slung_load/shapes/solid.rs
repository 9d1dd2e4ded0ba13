//! Signed distance between the parts of a vehicle and obstacles of any shape.
//!
//! The obstacle is taken piece by piece ([`ConvexPiece`]): the triangles of a mesh or a terrain near the part, found by a bounding
//! volume hierarchy, or the one convex shape. The distance of each is bounded from below as for prisms.

use nalgebra::Vector3;
use scenarios::geometry::{ConvexPiece, Solid};

use super::convex_part::ConvexPart;
use super::distance::separation;

/// The overlap that is reported of a part that cuts a surface, m, which has no depth.
const CUT_M: f64 = 1e-3;

/// Signed distance between a part and an obstacle, m: negative if they overlap.
///
/// Where the part is entirely inside, it is the distance from the surface with the sign of an overlap. It changes by no more than
/// the points of the part move, but for the first contact.
pub(super) fn to_solid_m(part: &ConvexPart, solid: &Solid) -> f64 {
    let (center_m, reach_m) = part.ball();
    let at_center_m = solid.signed_distance_m(center_m.into());
    if at_center_m.is_nan() {
        return f64::NAN;
    }
    let pieces = solid.convex_pieces(center_m.into(), at_center_m.abs() + reach_m + CUT_M);
    let to_surface_m = pieces.iter().map(|piece| to_piece_m(part, piece)).fold(at_center_m.abs(), smaller);
    if to_surface_m <= 0.0 { to_surface_m.min(-CUT_M).min(at_center_m) } else { to_surface_m.copysign(at_center_m) }
}

/// A cheap lower bound of the absolute distance: that of the ball around the part, m.
pub(super) fn to_solid_lower_bound_m(part: &ConvexPart, solid: &Solid) -> f64 {
    let (center_m, reach_m) = part.ball();
    solid.signed_distance_m(center_m.into()) - reach_m
}

/// Signed distance between a part and a convex piece, m; negative by its radius if they overlap.
fn to_piece_m(part: &ConvexPart, piece: &ConvexPiece) -> f64 {
    let corners_m: Vec<Vector3<f64>> = piece.corners_m.iter().map(|corner| Vector3::from(*corner)).collect();
    let support_m = |direction: &Vector3<f64>| {
        let farthest = corners_m.iter().max_by(|a, b| a.dot(direction).total_cmp(&b.dot(direction)));
        farthest.copied().unwrap_or_else(Vector3::zeros)
    };
    let difference = |direction: &Vector3<f64>| part.support_m(direction) - support_m(&-direction);
    separation(&difference).map_or(-CUT_M, |(distance_m, _)| distance_m) - piece.radius_m
}

fn smaller(a: f64, b: f64) -> f64 {
    if b < a || b.is_nan() { b } else { a }
}

#[cfg(test)]
mod tests {
    use nalgebra::Vector3;
    use scenarios::{Capsule, Sphere};

    use super::{ConvexPart, to_solid_lower_bound_m, to_solid_m};

    fn disc(x_m: f64, z_m: f64) -> ConvexPart {
        ConvexPart::Disc { center_m: Vector3::new(x_m, 0.0, z_m), axis: Vector3::z(), radius_m: 0.5 }
    }

    #[test]
    fn a_disc_and_a_cable_are_as_far_from_round_shapes_as_geometry_says() {
        let ball = Sphere { name: "ball".into(), center_m: [0.0; 3], radius_m: 1.0 }.solid();
        assert!((to_solid_m(&disc(3.0, 0.0), &ball) - 1.5).abs() < 1e-9);
        assert!((to_solid_m(&disc(0.2, 1.2), &ball) - 0.2).abs() < 1e-9, "above the disc's middle");
        assert!(to_solid_m(&disc(1.4, 0.0), &ball) < 0.0 && to_solid_m(&disc(0.0, 0.9), &ball) < 0.0);
        let boom = Capsule { name: "boom".into(), ends_m: [[-2.0, 0.0, 0.0], [2.0, 0.0, 0.0]], radius_m: 0.1 }.solid();
        let cable = |y_m: f64| ConvexPart::Line { ends_m: [Vector3::new(1.0, y_m, 1.0), Vector3::new(1.0, y_m, -1.0)] };
        assert!((to_solid_m(&cable(0.3), &boom) - 0.2).abs() < 1e-9);
        assert!(to_solid_m(&cable(0.0), &boom) < 0.0, "between the ends of the cable");
        assert!(to_solid_lower_bound_m(&cable(0.3), &boom) <= 0.2 && to_solid_m(&cable(f64::NAN), &boom).is_nan());
    }
}
