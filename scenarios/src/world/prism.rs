use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::Range;

/// A vertical prism over a convex polygon.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Prism {
    /// Name, unique among all obstacles.
    pub name: String,
    /// Corners (x, y) of the polygon, m, in order, clockwise or counterclockwise. Convex, at least three.
    pub corners_m: Vec<[f64; 2]>,
    /// Lowest and highest altitude, m. Absent: unbounded.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub z_m: Option<Range>,
}

/// A box with vertical sides, at any heading.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct BoxObstacle {
    /// Name, unique among all obstacles.
    pub name: String,
    /// Centre (x, y), m.
    pub center_m: [f64; 2],
    /// Length along its own x axis and width along its own y axis, m, each > 0.
    pub size_m: [f64; 2],
    /// Direction of its own x axis, counterclockwise from x (east), deg.
    #[serde(default)]
    pub heading_deg: f64,
    /// Lowest and highest altitude, m. Absent: unbounded.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub z_m: Option<Range>,
}

impl BoxObstacle {
    /// The box as a prism, its corners counterclockwise from the one at (+, +) in its own axes.
    pub fn as_prism(&self) -> Prism {
        let (sin, cos) = self.heading_deg.to_radians().sin_cos();
        let [length, width] = self.size_m.map(|size| size / 2.0);
        let corner = |[x, y]: [f64; 2]| [self.center_m[0] + cos * x - sin * y, self.center_m[1] + sin * x + cos * y];
        let corners = [[length, width], [-length, width], [-length, -width], [length, -width]];
        Prism { name: self.name.clone(), corners_m: corners.map(corner).to_vec(), z_m: self.z_m }
    }
}

impl Prism {
    /// The prism with its corners counterclockwise.
    pub fn counterclockwise(&self) -> Self {
        let mut prism = self.clone();
        if self.doubled_area_m2() < 0.0 {
            prism.corners_m.reverse();
        }
        prism
    }

    /// Whether the corners form a strictly convex polygon, clockwise or counterclockwise.
    pub fn is_convex(&self) -> bool {
        let n = self.corners_m.len();
        if n < 3 {
            return false;
        }
        let orientation = self.doubled_area_m2().signum();
        let turns_left = |i: usize| {
            let [a, b, c] = [i, i + 1, i + 2].map(|k| self.corners_m[k % n]);
            orientation * cross(a, b, c) > 0.0
        };
        // A star polygon also has only left turns, but winds around more than once.
        let total: f64 = (0..n).map(|i| self.exterior_angle(i)).sum();
        (0..n).all(turns_left) && (total.abs() - std::f64::consts::TAU).abs() < 1e-6
    }

    /// Signed distance in the plane from a point to the boundary of the polygon, m; negative inside. The corners must be
    /// convex and counterclockwise.
    pub fn signed_distance_m(&self, point_m: [f64; 2]) -> f64 {
        let n = self.corners_m.len();
        let mut inside = f64::NEG_INFINITY;
        let mut outside = f64::INFINITY;
        for i in 0..n {
            let (a, b) = (self.corners_m[i], self.corners_m[(i + 1) % n]);
            let along = [b[0] - a[0], b[1] - a[1]];
            let from_a = [point_m[0] - a[0], point_m[1] - a[1]];
            let length_m = along[0].hypot(along[1]);
            inside = inside.max((from_a[0] * along[1] - from_a[1] * along[0]) / length_m);
            let fraction = ((from_a[0] * along[0] + from_a[1] * along[1]) / (length_m * length_m)).clamp(0.0, 1.0);
            outside = outside.min((from_a[0] - fraction * along[0]).hypot(from_a[1] - fraction * along[1]));
        }
        if inside > 0.0 { outside } else { inside }
    }

    /// Signed distance in space from a point to the surface, m; negative inside. The corners must be convex and
    /// counterclockwise.
    pub fn signed_distance_in_space_m(&self, [x_m, y_m, z_m]: [f64; 3]) -> f64 {
        extruded(self.signed_distance_m([x_m, y_m]), self.z_m, z_m)
    }

    fn doubled_area_m2(&self) -> f64 {
        let n = self.corners_m.len();
        (0..n).map(|i| cross([0.0, 0.0], self.corners_m[i], self.corners_m[(i + 1) % n])).sum()
    }

    /// Angle from the edge that begins at corner `i` to the next edge, rad, positive counterclockwise.
    fn exterior_angle(&self, i: usize) -> f64 {
        let n = self.corners_m.len();
        let [a, b, c] = [i, i + 1, i + 2].map(|k| self.corners_m[k % n]);
        let (u, v) = ([b[0] - a[0], b[1] - a[1]], [c[0] - b[0], c[1] - b[1]]);
        (u[0] * v[1] - u[1] * v[0]).atan2(u[0] * v[0] + u[1] * v[1])
    }
}

/// Signed distance to a vertical extrusion, m, from the signed distance to its outline in the plane and its range of
/// altitudes: outside both, to the edge between side and top or bottom; inside, to the nearer of the two.
pub(crate) fn extruded(in_plane_m: f64, range: Option<Range>, z_m: f64) -> f64 {
    let Some(range) = range else { return in_plane_m };
    extruded_by(in_plane_m, -range.margin(z_m))
}

/// [`extruded`], from the signed distances to the outline in the plane and to the range of altitudes, m. It decreases with
/// neither.
pub(super) fn extruded_by(in_plane_m: f64, above_m: f64) -> f64 {
    if in_plane_m.is_nan() || above_m.is_nan() {
        return f64::NAN;
    }
    if in_plane_m > 0.0 && above_m > 0.0 { in_plane_m.hypot(above_m) } else { in_plane_m.max(above_m) }
}

/// Twice the area of the triangle a, b, c, positive counterclockwise.
pub(super) fn cross(a: [f64; 2], b: [f64; 2], c: [f64; 2]) -> f64 {
    (b[0] - a[0]) * (c[1] - b[1]) - (b[1] - a[1]) * (c[0] - b[0])
}

#[cfg(test)]
mod tests {
    use super::{BoxObstacle, Prism};

    fn prism(corners_m: &[[f64; 2]]) -> Prism {
        Prism { name: "p".into(), corners_m: corners_m.to_vec(), z_m: None }
    }

    #[test]
    fn convexity_of_polygons() {
        let square = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
        assert!(prism(&square).is_convex());
        assert!(prism(&[square[3], square[2], square[1], square[0]]).is_convex());
        assert!(!prism(&[square[0], square[2], square[1], square[3]]).is_convex(), "crossed");
        assert!(!prism(&[[0.0, 0.0], [1.0, 0.0], [0.2, 0.2], [0.0, 1.0]]).is_convex(), "dented");
        assert!(!prism(&[[0.0, 0.0], [1.0, 0.0], [2.0, 0.0]]).is_convex(), "flat");
        assert!(!prism(&square[..2]).is_convex(), "two corners");
        let star: Vec<[f64; 2]> =
            (0..5).map(|i| f64::from(i) * 0.8 * std::f64::consts::PI).map(|a| [a.cos(), a.sin()]).collect();
        assert!(!prism(&star).is_convex(), "star");
    }

    #[test]
    fn distances_to_a_rotated_box() {
        let turned =
            BoxObstacle { name: "b".into(), center_m: [1.0, 2.0], size_m: [4.0, 2.0], heading_deg: 90.0, z_m: None };
        let prism = turned.as_prism();
        assert!(prism.is_convex());
        for (point, distance_m) in
            [([1.0, 2.0], -1.0), ([1.5, 2.0], -0.5), ([3.0, 2.0], 1.0), ([1.0, 5.0], 1.0), ([5.0, 7.0], 18f64.sqrt())]
        {
            assert!((prism.signed_distance_m(point) - distance_m).abs() < 1e-12, "{point:?}");
        }
    }

    #[test]
    fn clockwise_corners_are_reversed() {
        let clockwise = prism(&[[0.0, 0.0], [0.0, 1.0], [1.0, 1.0]]).counterclockwise();
        assert!(clockwise.signed_distance_m([0.4, 0.6]) < 0.0);
    }
}
