//! Outlines around obstacles in the plane: offset polygons and sampled boundaries.

use std::f64::consts::{FRAC_PI_2, TAU};

use super::Obstacle;

/// Corners of an offset cylinder's polygon.
const CYLINDER_CORNERS: usize = 8;

/// Tolerance on the quarter turn up to which an offset corner stays a single one, in quarter turns.
const QUARTER_TURN_TOLERANCE: f64 = 1e-9;

/// Corners of a polygon around the obstacle whose edges keep `offset_m` from the obstacle's polygon, counterclockwise.
///
/// A corner that turns by a quarter turn or less has one corner in the offset polygon (mitre joint); sharper corners and
/// cylinders are cut off by several.
pub fn offset_polygon(obstacle: &Obstacle, offset_m: f64) -> Vec<[f64; 2]> {
    let edges = obstacle.edges();
    let mut corners = Vec::new();
    for (i, edge) in edges.iter().enumerate() {
        let previous = edges[(i + edges.len() - 1) % edges.len()].normal;
        let first = previous[1].atan2(previous[0]);
        let (turn, pieces) = if obstacle.is_cylinder() {
            (TAU, CYLINDER_CORNERS)
        } else {
            let turn = turn_angle(previous, edge.normal);
            (turn, (turn / FRAC_PI_2 - QUARTER_TURN_TOLERANCE).ceil().max(1.0) as usize)
        };
        let half = 0.5 * turn / pieces as f64;
        for piece in 0..pieces {
            let angle = first + half * (2 * piece + 1) as f64;
            let radius = offset_m / half.cos();
            corners.push([edge.corner[0] + radius * angle.cos(), edge.corner[1] + radius * angle.sin()]);
        }
    }
    corners
}

/// The part of a closed polygon inside a rectangle, with additional points on its edges, at most `spacing_m` apart.
///
/// - `bounds_m`: of the rectangle, [west, east] and [south, north]; an obstacle may be far larger than the map
pub fn subdivided(corners: &[[f64; 2]], spacing_m: f64, bounds_m: [[f64; 2]; 2]) -> Vec<[f64; 2]> {
    let edge = |i: usize| subdivided_edge(corners[i], corners[(i + 1) % corners.len()], spacing_m, bounds_m);
    (0..corners.len()).flat_map(edge).collect()
}

/// Points from `from` (included) to `to` (excluded), equally spaced, at most `spacing_m` apart, as far as they lie within the
/// bounds.
fn subdivided_edge(
    from: [f64; 2],
    to: [f64; 2],
    spacing_m: f64,
    bounds_m: [[f64; 2]; 2],
) -> impl Iterator<Item = [f64; 2]> {
    let pieces = ((to[0] - from[0]).hypot(to[1] - from[1]) / spacing_m).ceil().max(1.0);
    let [enters, leaves] = fractions_within(from, to, bounds_m);
    let (first, end) = ((enters * pieces).floor().max(0.0), (leaves * pieces).floor() + 1.0);
    (first as usize..end.clamp(0.0, pieces) as usize).filter_map(move |piece| {
        let fraction = piece as f64 / pieces;
        let point = [0, 1].map(|axis| from[axis] + fraction * (to[axis] - from[axis]));
        [0, 1].into_iter().all(|axis| (bounds_m[axis][0]..=bounds_m[axis][1]).contains(&point[axis])).then_some(point)
    })
}

/// The fractions of a line at which it enters and leaves a rectangle; the first is larger if it misses it.
fn fractions_within(from: [f64; 2], to: [f64; 2], bounds_m: [[f64; 2]; 2]) -> [f64; 2] {
    let mut within = [0.0_f64, 1.0_f64];
    for axis in 0..2 {
        let along_m = to[axis] - from[axis];
        if along_m != 0.0 {
            let [a, b] = bounds_m[axis].map(|bound_m| (bound_m - from[axis]) / along_m);
            within = [within[0].max(a.min(b)), within[1].min(a.max(b))];
        }
    }
    within
}

/// Counterclockwise angle from `a` to `b`, rad; in [0, π] for the normals at a convex corner.
fn turn_angle(a: [f64; 2], b: [f64; 2]) -> f64 {
    (a[0] * b[1] - a[1] * b[0]).atan2(a[0] * b[0] + a[1] * b[1])
}

#[cfg(test)]
mod tests {
    use super::*;

    const UNBOUNDED: [f64; 2] = [f64::NEG_INFINITY, f64::INFINITY];

    /// The last triangle corner turns by more than a quarter turn.
    fn shapes() -> [Obstacle; 3] {
        [
            Obstacle::prism(&[[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [0.0, 1.0]], UNBOUNDED),
            Obstacle::prism(&[[0.0, 0.0], [5.0, 0.0], [0.0, 1.0]], UNBOUNDED),
            Obstacle::cylinder([1.0, -2.0], 0.0, UNBOUNDED),
        ]
    }

    #[test]
    fn edges_of_an_offset_polygon_keep_the_offset() {
        for obstacle in shapes() {
            let corners = offset_polygon(&obstacle, 0.5);
            for (i, from) in corners.iter().enumerate() {
                let to = corners[(i + 1) % corners.len()];
                let [from, to] = [[from[0], from[1], 0.0], [to[0], to[1], 0.0]];
                let distance_m = obstacle.distance_lower_bound_m(from.into(), to.into());
                assert!((distance_m - 0.5).abs() < 1e-12, "{distance_m}");
            }
        }
    }

    #[test]
    fn only_sharp_corners_are_cut_off() {
        assert_eq!(shapes().map(|obstacle| offset_polygon(&obstacle, 0.5).len()), [4, 5, CYLINDER_CORNERS]);
    }

    #[test]
    fn subdivided_polygons_keep_their_corners_and_the_spacing() {
        let square = [[0.0, 0.0], [2.5, 0.0], [2.5, 1.0], [0.0, 1.0]];
        let points = subdivided(&square, 1.0, [UNBOUNDED; 2]);
        assert_eq!(points.len(), 3 + 1 + 3 + 1);
        assert!(square.iter().all(|corner| points.contains(corner)));
        for (i, from) in points.iter().enumerate() {
            let to = points[(i + 1) % points.len()];
            assert!((to[0] - from[0]).hypot(to[1] - from[1]) <= 1.0 + 1e-12);
        }
    }

    #[test]
    fn only_the_part_within_the_bounds_is_subdivided() {
        let bounds_m = [[-3.0, 4.0], [-5.0, 8.0]];
        let is_inside = |[x, y]: &[f64; 2]| (-3.0..=4.0).contains(x) && (-5.0..=8.0).contains(y);
        let tilted = [[-7.0, -5.0], [6.0, -1.5], [5.0, 9.0], [-9.0, 1.0]];
        let mut all = subdivided(&tilted, 0.25, [UNBOUNDED; 2]);
        all.retain(is_inside);
        assert!(all.len() > 20);
        assert_eq!(subdivided(&tilted, 0.25, bounds_m), all);
        let huge = [[-5e8, -1.0], [5e8, -1.0], [5e8, 1.0], [-5e8, 1.0]];
        let points = subdivided(&huge, 0.25, bounds_m);
        assert!((50..70).contains(&points.len()) && points.iter().all(is_inside), "{}", points.len());
    }
}
