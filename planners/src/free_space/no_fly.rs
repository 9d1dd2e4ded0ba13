//! Geofences as obstacles: what is not allowed in the plane, in convex pieces.

use nalgebra::Vector2;
use scenarios::{Geofence, GeofenceKind, Map};
use spade::{ConstrainedDelaunayTriangulation, Point2, Triangulation};

use super::Obstacle;
use super::world::altitude_range_m;

/// By how much the triangulated region reaches beyond map and fence, as a fraction of its size, so that its border is no edge of
/// either.
const BORDER: f64 = 0.1;

/// The forbidden side of a geofence on the map, with names: what a keep-out polygon holds, or what surrounds a stay-in polygon at
/// any altitude. Lowest and highest altitude of stay-in volumes are bounds, not obstacles.
pub(super) fn obstacles(fence: &Geofence, map: &Map) -> Vec<(String, Obstacle)> {
    let is_keep_out = fence.kind == GeofenceKind::KeepOut;
    let altitude_m = altitude_range_m(fence.z_m.filter(|_| is_keep_out));
    let corners = triangles(fence, map).into_iter().filter(|corners| {
        let centre = corners.iter().fold(Vector2::zeros(), |sum, it| sum + Vector2::from(*it)) / 3.0;
        fence.encloses_in_plane(centre.into()) == is_keep_out
    });
    let named = corners.enumerate().map(|(piece, corners)| {
        (format!("{} (geofence, piece {})", fence.name, piece + 1), Obstacle::prism(&corners, altitude_m))
    });
    named.collect()
}

/// Counterclockwise triangles that cover the map and the fence, none of which crosses a boundary of the fence.
fn triangles(fence: &Geofence, map: &Map) -> Vec<[[f64; 2]; 3]> {
    let mut triangulation = ConstrainedDelaunayTriangulation::<Point2<f64>>::new();
    let mut insert = |[x, y]: [f64; 2]| triangulation.insert(Point2::new(x, y)).expect("corners of a valid geofence");
    for corner in border(fence, map) {
        insert(corner);
    }
    let rings: Vec<Vec<_>> = fence.rings().map(|ring| ring.iter().map(|it| insert(*it)).collect()).collect();
    for ring in &rings {
        for (corner, next) in ring.iter().zip(ring.iter().cycle().skip(1)) {
            triangulation.add_constraint(*corner, *next);
        }
    }
    let corners = triangulation.inner_faces().map(|face| face.positions().map(|corner| [corner.x, corner.y]));
    corners.collect()
}

/// Corners of a rectangle around map and fence.
fn border(fence: &Geofence, map: &Map) -> [[f64; 2]; 4] {
    let axes = [(0, map.x_m), (1, map.y_m)].map(|(axis, range)| {
        let coordinates = || fence.rings().flatten().map(move |corner| corner[axis]);
        let [min, max] = [coordinates().fold(range.min, f64::min), coordinates().fold(range.max, f64::max)];
        let border = BORDER * (max - min);
        [min - border, max + border]
    });
    let [[west, east], [south, north]] = axes;
    [[west, south], [east, south], [east, north], [west, north]]
}

#[cfg(test)]
mod tests {
    use rand::RngExt;
    use scenarios::{Geofence, GeofenceKind, Map, Range, stream};

    use super::super::Point;
    use super::obstacles;

    /// An L with a hole in it, and a part beside it.
    fn site(kind: GeofenceKind) -> Geofence {
        Geofence {
            name: "site".into(),
            kind,
            polygon_m: vec![[-8.0, -8.0], [8.0, -8.0], [8.0, 0.0], [0.0, 0.0], [0.0, 8.0], [-8.0, 8.0]],
            rings_m: vec![vec![[-6.0, -6.0], [-2.0, -6.0], [-4.0, -2.0]], vec![[3.0, 3.0], [9.0, 3.0], [9.0, 12.0]]],
            z_m: None,
        }
    }

    #[test]
    fn distances_from_the_pieces_are_those_from_the_fence() {
        let map = Map { x_m: Range::new(-10.0, 10.0), y_m: Range::new(-10.0, 10.0), z_m: Range::new(0.0, 5.0) };
        let mut random = stream(3, "no-fly pieces");
        for kind in [GeofenceKind::StayIn, GeofenceKind::KeepOut] {
            let fence = site(kind);
            let pieces = obstacles(&fence, &map);
            for _ in 0..2_000 {
                let point = Point::new(random.random_range(-10.0..10.0), random.random_range(-10.0..10.0), 1.0);
                let nearest_m = pieces.iter().map(|(_, it)| it.distance_m(point)).fold(f64::INFINITY, f64::min);
                let margin_m = fence.margin_m(point.into());
                assert_eq!(nearest_m > 0.0, margin_m > 0.0, "{kind:?} {point}");
                assert!(margin_m < 0.0 || (nearest_m - margin_m).abs() < 1e-9, "{kind:?} {point}: {nearest_m}");
            }
        }
    }
}
