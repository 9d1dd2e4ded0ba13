use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::prism::{cross, extruded_by};
use crate::Range;

/// A volume over a polygon that the bodies of vehicles and loads may not leave, or may not enter.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Geofence {
    /// Name, unique among the geofences.
    pub name: String,
    /// On which side of the boundary flight is allowed.
    pub kind: GeofenceKind,
    /// Corners (x, y) of the polygon, m, in order, clockwise or counterclockwise. At least three; the edges may not cross or
    /// touch, but the polygon need not be convex.
    pub polygon_m: Vec<[f64; 2]>,
    /// Further boundaries of the same volume, each as `polygon_m`: a ring inside the polygon is a hole in it, a ring beside it
    /// another part. A point is inside if it is inside an odd number of them. Rings may not cross or touch each other.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub rings_m: Vec<Vec<[f64; 2]>>,
    /// Lowest and highest altitude of the volume, m. Absent: unbounded.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub z_m: Option<Range>,
}

/// The allowed side of a geofence.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum GeofenceKind {
    /// Inside the volume. With several of these, inside every one.
    StayIn,
    /// Outside the volume.
    KeepOut,
}

impl Geofence {
    /// Distance from a point to the boundary, m, positive where flight is allowed. NaN if the point is NaN.
    pub fn margin_m(&self, point_m: [f64; 3]) -> f64 {
        self.margin_of(self.signed_distance_m(point_m))
    }

    /// Bounds of [`margin_m`](Self::margin_m) over the convex hull of points, m: the lower end is not above any margin there,
    /// the upper end not below. They meet as the hull shrinks, and close to an edge as it becomes flat and parallel to it.
    pub fn margin_bounds_m(&self, hull_m: &[[f64; 3]]) -> Range {
        let Range { min, max } = self.distance_bounds_m(hull_m);
        let (one, other) = (self.margin_of(min), self.margin_of(max));
        Range::new(one.min(other), one.max(other))
    }

    /// Whether a point is over or under the volume.
    pub fn encloses_in_plane(&self, point_m: [f64; 2]) -> bool {
        is_inside(self.rings(), point_m)
    }

    /// Whether every boundary is a polygon whose edges neither cross nor touch, apart from neighbours at their common corner, and
    /// no two boundaries meet.
    pub fn is_simple(&self) -> bool {
        let rings: Vec<&[[f64; 2]]> = self.rings().collect();
        let meet = |one: &[[f64; 2]], other: &[[f64; 2]]| edges(one).any(|edge| edges(other).any(|it| touch(edge, it)));
        rings.iter().all(|ring| is_simple(ring))
            && rings.iter().enumerate().all(|(i, one)| rings[i + 1..].iter().all(|other| !meet(one, other)))
    }

    /// All boundaries: the polygon, then the further rings.
    pub fn rings(&self) -> impl Iterator<Item = &[[f64; 2]]> {
        std::iter::once(&self.polygon_m).chain(&self.rings_m).map(Vec::as_slice)
    }

    fn margin_of(&self, signed_distance_m: f64) -> f64 {
        match self.kind {
            GeofenceKind::StayIn => -signed_distance_m,
            GeofenceKind::KeepOut => signed_distance_m,
        }
    }

    /// Signed distance from a point to the surface of the volume, m; negative inside.
    fn signed_distance_m(&self, [x_m, y_m, z_m]: [f64; 3]) -> f64 {
        let in_plane_m = self.in_plane_m([x_m, y_m]);
        self.z_m.map_or(in_plane_m, |range| extruded_by(in_plane_m, -range.margin(z_m)))
    }

    /// Bounds of the signed distance over the convex hull of points, m: it grows with the distances in the plane and above.
    fn distance_bounds_m(&self, hull_m: &[[f64; 3]]) -> Range {
        let in_plane = self.in_plane_bounds_m(hull_m);
        let Some(range) = self.z_m else { return in_plane };
        let above = above_bounds_m(range, hull_m);
        Range::new(extruded_by(in_plane.min, above.min), extruded_by(in_plane.max, above.max))
    }

    /// Signed distance in the plane from a point to the polygon, m; negative inside.
    fn in_plane_m(&self, point_m: [f64; 2]) -> f64 {
        let (mut distance_m, mut is_inside) = (f64::INFINITY, false);
        for edge in self.edges() {
            let to_edge_m = distance_to_edge_m(edge, point_m);
            distance_m = if to_edge_m < distance_m || to_edge_m.is_nan() { to_edge_m } else { distance_m };
            is_inside ^= crosses_eastward_ray(edge, point_m);
        }
        if is_inside { -distance_m } else { distance_m }
    }

    /// The distance changes by no more than the point moves; it is no larger than that to any one edge; and a hull that no
    /// edge reaches is on one side of the boundary, at least as far from it as from the nearest edge.
    fn in_plane_bounds_m(&self, hull_m: &[[f64; 3]]) -> Range {
        let n = hull_m.len() as f64;
        let centre_m = [0, 1].map(|axis| hull_m.iter().map(|point| point[axis]).sum::<f64>() / n);
        let at_centre_m = self.in_plane_m(centre_m);
        let offsets_m = hull_m.iter().map(|point| (point[0] - centre_m[0]).hypot(point[1] - centre_m[1]));
        let radius_m = offsets_m.fold(0.0, f64::max);
        let (gap_m, reach_m) = self.edge_distance_bounds_m(hull_m);
        let bounds = Range::new((at_centre_m - radius_m).max(-reach_m), (at_centre_m + radius_m).min(reach_m));
        if gap_m == 0.0 {
            bounds
        } else if at_centre_m > 0.0 {
            Range::new(bounds.min.max(gap_m), bounds.max)
        } else {
            Range::new(bounds.min, bounds.max.min(-gap_m))
        }
    }

    /// Lower and upper bound of the distance to the nearest edge over the convex hull of points, m. The distance to an edge is
    /// convex, so that it is largest at one of the points.
    fn edge_distance_bounds_m(&self, hull_m: &[[f64; 3]]) -> (f64, f64) {
        let (mut gap_m, mut reach_m) = (f64::INFINITY, f64::INFINITY);
        for edge in self.edges() {
            let distances_m = hull_m.iter().map(|point| distance_to_edge_m(edge, [point[0], point[1]]));
            reach_m = reach_m.min(distances_m.fold(0.0, f64::max));
            gap_m = gap_m.min(gap_to_edge_m(edge, hull_m));
        }
        (gap_m, reach_m)
    }

    /// The edges of all boundaries.
    fn edges(&self) -> impl Iterator<Item = [[f64; 2]; 2]> {
        self.rings().flat_map(edges)
    }
}

/// The edges of a ring, from every corner to the next.
fn edges(ring_m: &[[f64; 2]]) -> impl Iterator<Item = [[f64; 2]; 2]> {
    (0..ring_m.len()).map(|i| [ring_m[i], ring_m[(i + 1) % ring_m.len()]])
}

/// Whether the edges of a ring neither cross nor touch, apart from neighbours at their common corner.
pub(crate) fn is_simple(ring_m: &[[f64; 2]]) -> bool {
    let edges: Vec<[[f64; 2]; 2]> = edges(ring_m).collect();
    let n = edges.len();
    let is_far = |i: usize, j: usize| j != i + 1 && !(i == 0 && j == n - 1);
    n >= 3
        && (0..n).all(|i| !folds_back(edges[i], edges[(i + 1) % n]))
        && (0..n).all(|i| (i + 1..n).filter(|&j| is_far(i, j)).all(|j| !touch(edges[i], edges[j])))
}

/// Whether a point is inside an odd number of rings.
pub(crate) fn is_inside<'r>(rings_m: impl Iterator<Item = &'r [[f64; 2]]>, point_m: [f64; 2]) -> bool {
    rings_m.flat_map(edges).filter(|edge| crosses_eastward_ray(*edge, point_m)).count() % 2 == 1
}

/// Bounds of the signed distance to a range of altitudes over the convex hull of points, m; negative inside. The smaller of
/// two linear functions is smallest at a point, the larger of two is at least the smallest value of each.
fn above_bounds_m(range: Range, hull_m: &[[f64; 3]]) -> Range {
    let smallest =
        |value: &dyn Fn(f64) -> f64| hull_m.iter().map(|point| value(point[2])).fold(f64::INFINITY, f64::min);
    let above = smallest(&|z_m| z_m - range.max);
    let below = smallest(&|z_m| range.min - z_m);
    let depth = smallest(&|z_m| range.margin(z_m));
    Range::new(above.max(below), -depth)
}

/// Position of a point relative to an edge, m: along it from its beginning, and to its left. Then the edge's length.
fn in_edge_frame([a, b]: [[f64; 2]; 2], [x_m, y_m]: [f64; 2]) -> ([f64; 2], f64) {
    let (along, from_a) = ([b[0] - a[0], b[1] - a[1]], [x_m - a[0], y_m - a[1]]);
    let length_m = along[0].hypot(along[1]);
    let along_m = (along[0] * from_a[0] + along[1] * from_a[1]) / length_m;
    ([along_m, (along[0] * from_a[1] - along[1] * from_a[0]) / length_m], length_m)
}

fn distance_to_edge_m(edge: [[f64; 2]; 2], point_m: [f64; 2]) -> f64 {
    let ([along_m, left_m], length_m) = in_edge_frame(edge, point_m);
    (along_m - along_m.max(0.0).min(length_m)).hypot(left_m)
}

/// Lower bound of the distance from an edge to the convex hull of points, m, along the edge and across it; 0 if they may touch.
fn gap_to_edge_m(edge: [[f64; 2]; 2], hull_m: &[[f64; 3]]) -> f64 {
    let empty = Range::new(f64::INFINITY, f64::NEG_INFINITY);
    let (mut along, mut left, mut length_m) = (empty, empty, 0.0);
    for point in hull_m {
        let ([along_m, left_m], edge_m) = in_edge_frame(edge, [point[0], point[1]]);
        along = Range::new(along.min.min(along_m), along.max.max(along_m));
        left = Range::new(left.min.min(left_m), left.max.max(left_m));
        length_m = edge_m;
    }
    let beyond_m = (along.min - length_m).max(-along.max).max(0.0);
    let beside_m = left.min.max(-left.max).max(0.0);
    beyond_m.hypot(beside_m)
}

/// Whether the ray from a point to the east crosses an edge; of its ends only the lower one belongs to it.
fn crosses_eastward_ray([a, b]: [[f64; 2]; 2], [x_m, y_m]: [f64; 2]) -> bool {
    (a[1] > y_m) != (b[1] > y_m) && x_m < a[0] + (b[0] - a[0]) * (y_m - a[1]) / (b[1] - a[1])
}

/// Whether an edge has no length, or the `next` one returns along it.
fn folds_back([a, b]: [[f64; 2]; 2], [_, c]: [[f64; 2]; 2]) -> bool {
    let forward = (b[0] - a[0]) * (c[0] - b[0]) + (b[1] - a[1]) * (c[1] - b[1]);
    a == b || (cross(a, b, c) == 0.0 && forward < 0.0)
}

/// Whether two edges have a point in common.
fn touch([a, b]: [[f64; 2]; 2], [c, d]: [[f64; 2]; 2]) -> bool {
    let overlap =
        |axis: usize| a[axis].max(b[axis]) >= c[axis].min(d[axis]) && c[axis].max(d[axis]) >= a[axis].min(b[axis]);
    let straddles = |[a, b]: [[f64; 2]; 2], [c, d]: [[f64; 2]; 2]| cross(a, b, c) * cross(a, b, d) <= 0.0;
    overlap(0) && overlap(1) && straddles([a, b], [c, d]) && straddles([c, d], [a, b])
}

#[cfg(test)]
mod tests {
    use rand::RngExt;

    use super::{Geofence, GeofenceKind};
    use crate::{Range, stream};

    /// An L: the square of 4 m without its north-eastern quarter, up to 3 m.
    fn corner_plot(kind: GeofenceKind) -> Geofence {
        let polygon_m = vec![[0.0, 0.0], [4.0, 0.0], [4.0, 2.0], [2.0, 2.0], [2.0, 4.0], [0.0, 4.0]];
        Geofence { name: "plot".into(), kind, polygon_m, rings_m: Vec::new(), z_m: Some(Range::new(0.0, 3.0)) }
    }

    #[test]
    fn margins_are_positive_where_flight_is_allowed() {
        for (point_m, inside_m) in [
            ([1.0, 3.0, 1.5], 1.0),
            ([1.0, 3.0, 2.75], 0.25),
            ([3.0, 3.0, 1.5], -1.0),
            ([1.5, 1.5, 1.5], 0.5_f64.sqrt()),
            ([-3.0, 0.0, 7.0], -5.0),
            ([1.0, 1.0, -2.0], -2.0),
        ] {
            let margin_m = |kind| corner_plot(kind).margin_m(point_m);
            assert!((margin_m(GeofenceKind::StayIn) - inside_m).abs() < 1e-12, "{point_m:?}");
            assert!((margin_m(GeofenceKind::KeepOut) + inside_m).abs() < 1e-12, "{point_m:?}");
        }
        assert!(corner_plot(GeofenceKind::KeepOut).margin_m([f64::NAN, 0.0, 0.0]).is_nan());
        assert!(corner_plot(GeofenceKind::StayIn).margin_m([1.0, 1.0, f64::NAN]).is_nan());
    }

    #[test]
    fn a_ring_inside_is_a_hole_and_a_ring_beside_is_another_part() {
        let hole = vec![[0.5, 0.5], [0.5, 1.5], [1.5, 1.5], [1.5, 0.5]];
        let part = vec![[5.0, 5.0], [9.0, 5.0], [9.0, 9.0]];
        let rings_m = vec![hole, part];
        let fence = Geofence { rings_m, z_m: None, ..corner_plot(GeofenceKind::StayIn) };
        assert!(fence.is_simple());
        for (point_m, margin_m) in [([1.0, 1.25, 0.0], -0.25), ([8.75, 6.0, 0.0], 0.25), ([1.75, 1.0, 9.0], 0.25)] {
            assert!((fence.margin_m(point_m) - margin_m).abs() < 1e-12, "{point_m:?}");
        }
        let over_the_hole = [[0.25, 1.0, 0.0], [0.75, 1.0, 0.0], [1.0, 1.0, 0.0], [1.75, 1.0, 0.0]];
        assert!(fence.margin_bounds_m(&over_the_hole).min <= -0.5);
        let crossing = Geofence { rings_m: vec![vec![[1.0, 1.0], [5.0, 1.0], [5.0, 1.5]]], ..fence };
        assert!(!crossing.is_simple());
    }

    #[test]
    fn no_sample_of_a_hull_is_outside_its_bounds() {
        let mut random = stream(7, "geofence hulls");
        for sample in 0..200_000 {
            let size_m = 4.0 * random.random::<f64>().powi(3);
            let corner_m: [f64; 3] = std::array::from_fn(|_| random.random_range(-2.0..6.0));
            let hull_m: [[f64; 3]; 4] =
                std::array::from_fn(|_| corner_m.map(|coordinate| coordinate + size_m * random.random::<f64>()));
            let weights: [f64; 4] = std::array::from_fn(|_| random.random::<f64>());
            let total: f64 = weights.iter().sum();
            let point_m =
                [0, 1, 2].map(|axis| (0..4).map(|corner| weights[corner] / total * hull_m[corner][axis]).sum::<f64>());
            for kind in [GeofenceKind::StayIn, GeofenceKind::KeepOut] {
                let fence = corner_plot(kind);
                let (Range { min, max }, margin_m) = (fence.margin_bounds_m(&hull_m), fence.margin_m(point_m));
                assert!(min - 1e-12 <= margin_m && margin_m <= max + 1e-12, "{sample}: {min} {margin_m} {max}");
            }
        }
    }

    #[test]
    fn bounds_are_tight_along_an_edge() {
        let along_m = [[0.1, -0.5, 1.0], [1.0, -0.5, 1.0], [2.0, -0.5, 1.0], [3.9, -0.5, 1.0]];
        assert_eq!(corner_plot(GeofenceKind::KeepOut).margin_bounds_m(&along_m).min, 0.5);
        let inside_m = along_m.map(|[x, y, z]| [x, y + 0.75, z]);
        assert_eq!(corner_plot(GeofenceKind::KeepOut).margin_bounds_m(&inside_m[1..3]).min, -0.25);
    }

    #[test]
    fn polygons_that_cross_touch_or_fold_are_not_simple() {
        let is_simple = |polygon_m: &[[f64; 2]]| {
            Geofence { polygon_m: polygon_m.to_vec(), ..corner_plot(GeofenceKind::StayIn) }.is_simple()
        };
        assert!(corner_plot(GeofenceKind::StayIn).is_simple());
        assert!(is_simple(&[[0.0, 0.0], [0.0, 1.0], [1.0, 0.0]]), "clockwise");
        assert!(!is_simple(&[[0.0, 0.0], [1.0, 0.0]]), "two corners");
        assert!(!is_simple(&[[0.0, 0.0], [1.0, 1.0], [1.0, 0.0], [0.0, 1.0]]), "crossed");
        assert!(!is_simple(&[[0.0, 0.0], [1.0, 0.0], [2.0, 0.0]]), "flat");
        assert!(!is_simple(&[[0.0, 0.0], [1.0, 0.0], [1.0, 0.0], [0.0, 1.0]]), "repeated corner");
        assert!(!is_simple(&[[0.0, 0.0], [4.0, 0.0], [4.0, 2.0], [2.0, 0.0], [0.0, 2.0]]), "touching");
    }
}
