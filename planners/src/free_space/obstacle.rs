use super::Point;

/// An upright prism over a rounded convex polygon: all points between two altitudes whose horizontal distance from the
/// polygon is at most `rounding_radius_m`. A polygon of one corner makes a cylinder.
#[derive(Clone, Debug, PartialEq)]
pub struct Obstacle {
    edges: Vec<Edge>,
    rounding_radius_m: f64,
    altitude_m: [f64; 2],
    /// Centre and radius of a circle in the plane that encloses the obstacle, m.
    bounding_circle: ([f64; 2], f64),
}

/// An edge of the polygon, counterclockwise from its corner.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Edge {
    /// Its first corner, m.
    pub corner: [f64; 2],
    /// Outward unit normal.
    pub normal: [f64; 2],
    /// Length, m; zero for the single corner of a cylinder.
    pub length_m: f64,
}

impl Obstacle {
    /// A prism over a convex polygon.
    ///
    /// - `corners`: counterclockwise, at least three, m
    /// - `altitude_m`: lowest and highest altitude, infinite where unbounded, m
    ///
    /// # Panics
    ///
    /// If there are fewer than three corners.
    pub fn prism(corners: &[[f64; 2]], altitude_m: [f64; 2]) -> Self {
        assert!(corners.len() >= 3, "a polygon has at least three corners");
        let edge = |i: usize| {
            let (corner, next) = (corners[i], corners[(i + 1) % corners.len()]);
            let along = [next[0] - corner[0], next[1] - corner[1]];
            let length_m = along[0].hypot(along[1]);
            Edge { corner, normal: [along[1] / length_m, -along[0] / length_m], length_m }
        };
        Self::new((0..corners.len()).map(edge).collect(), 0.0, altitude_m)
    }

    /// An upright cylinder with its axis at `center`, m.
    pub fn cylinder(center: [f64; 2], radius_m: f64, altitude_m: [f64; 2]) -> Self {
        Self::new(vec![Edge { corner: center, normal: [1.0, 0.0], length_m: 0.0 }], radius_m, altitude_m)
    }

    fn new(edges: Vec<Edge>, rounding_radius_m: f64, altitude_m: [f64; 2]) -> Self {
        let count = edges.len() as f64;
        let center = [0, 1].map(|axis| edges.iter().map(|edge| edge.corner[axis]).sum::<f64>() / count);
        let distance = |edge: &Edge| (edge.corner[0] - center[0]).hypot(edge.corner[1] - center[1]);
        let radius_m = edges.iter().map(distance).fold(0.0, f64::max) + rounding_radius_m;
        Self { edges, rounding_radius_m, altitude_m, bounding_circle: (center, radius_m) }
    }

    /// Edges of the polygon, counterclockwise.
    pub fn edges(&self) -> &[Edge] {
        &self.edges
    }

    /// Is the polygon a single corner?
    pub fn is_cylinder(&self) -> bool {
        self.edges.len() == 1
    }

    /// Horizontal distance by which the obstacle extends beyond its polygon, m.
    pub fn rounding_radius_m(&self) -> f64 {
        self.rounding_radius_m
    }

    /// Lowest and highest altitude, m.
    pub fn altitude_m(&self) -> [f64; 2] {
        self.altitude_m
    }

    /// Centre and radius of a circle in the plane that encloses the obstacle, m.
    pub fn bounding_circle(&self) -> ([f64; 2], f64) {
        self.bounding_circle
    }

    /// Signed distance from a point, m: negative inside.
    pub fn distance_m(&self, point: Point) -> f64 {
        self.distance_lower_bound_m(point, point)
    }

    /// May the segment from `p` to `q` come nearer than `distance_m`? A test against the bounding circle: false is certain,
    /// true is not.
    pub fn may_be_within(&self, p: Point, q: Point, distance_m: f64) -> bool {
        let ([x, y], radius_m) = self.bounding_circle;
        let (d, to_p) = ([q[0] - p[0], q[1] - p[1]], [p[0] - x, p[1] - y]);
        let length2 = dot(d, d);
        let fraction = if length2 > 0.0 { (-dot(to_p, d) / length2).clamp(0.0, 1.0) } else { 0.0 };
        let nearest = [to_p[0] + fraction * d[0], to_p[1] + fraction * d[1]];
        let limit_m = radius_m + distance_m;
        limit_m > 0.0 && dot(nearest, nearest) < limit_m * limit_m
    }

    /// Lower bound of the distance between the obstacle and the segment from `p` to `q`, m. It is the distance itself if
    /// the segment is level or a point, and minus the penetration depth if they intersect.
    ///
    /// The bound combines the horizontal distance of the two with their vertical distance, each a minimum over the
    /// segment.
    pub fn distance_lower_bound_m(&self, p: Point, q: Point) -> f64 {
        let horizontal_m = self.planar_distance_m([p[0], p[1]], [q[0], q[1]]) - self.rounding_radius_m;
        let [low, high] = self.altitude_m;
        let vertical_m = (low - p[2].max(q[2])).max(p[2].min(q[2]) - high);
        if horizontal_m > 0.0 && vertical_m > 0.0 {
            horizontal_m.hypot(vertical_m)
        } else {
            horizontal_m.max(vertical_m)
        }
    }

    /// Distance between polygon and segment in the plane, m. Where they intersect, minus the penetration depth along the
    /// separating axis (an edge normal or the segment's normal) on which it is smallest.
    fn planar_distance_m(&self, p: [f64; 2], q: [f64; 2]) -> f64 {
        let d = [q[0] - p[0], q[1] - p[1]];
        let length2 = dot(d, d);
        let inverse_length2 = if length2 > 0.0 { 1.0 / length2 } else { 0.0 };
        let mut nearest2 = f64::INFINITY;
        let mut separation = if self.is_cylinder() { f64::INFINITY } else { f64::NEG_INFINITY };
        let (mut max_offset, mut min_offset) = (f64::NEG_INFINITY, f64::INFINITY);
        for edge in &self.edges {
            let [to_p, to_q] = [p, q].map(|end| [end[0] - edge.corner[0], end[1] - edge.corner[1]]);
            let heights = [dot(edge.normal, to_p), dot(edge.normal, to_q)];
            separation = separation.max(heights[0].min(heights[1]));
            for (end, height) in [to_p, to_q].into_iter().zip(heights) {
                let along = edge.normal[0] * end[1] - edge.normal[1] * end[0];
                let beyond = along - along.clamp(0.0, edge.length_m);
                nearest2 = nearest2.min(height * height + beyond * beyond);
            }
            let fraction = (-dot(to_p, d) * inverse_length2).clamp(0.0, 1.0);
            let from_corner = [to_p[0] + fraction * d[0], to_p[1] + fraction * d[1]];
            nearest2 = nearest2.min(dot(from_corner, from_corner));
            let offset = d[1] * to_p[0] - d[0] * to_p[1];
            (max_offset, min_offset) = (max_offset.max(offset), min_offset.min(offset));
        }
        if length2 > 0.0 {
            separation = separation.max(min_offset.max(-max_offset) * inverse_length2.sqrt());
        }
        if separation > 0.0 { nearest2.sqrt() } else { separation }
    }
}

fn dot(a: [f64; 2], b: [f64; 2]) -> f64 {
    a[0] * b[0] + a[1] * b[1]
}
