use super::vector::Point;

/// An upright prism over a convex polygon, rounded in the plane: all points within `round_m` of the polygon, between two
/// altitudes. A polygon of one corner makes a cylinder.
#[derive(Clone, Debug, PartialEq)]
pub struct Obstacle {
    edges: Vec<Edge>,
    round_m: f64,
    altitude_m: [f64; 2],
    /// Centre and radius of a circle around all of it, m.
    circle: ([f64; 2], f64),
}

/// An edge of the polygon, from its corner counterclockwise.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Edge {
    /// Where it begins, m.
    pub corner: [f64; 2],
    /// Unit normal, outwards.
    pub normal: [f64; 2],
    /// Length, m; zero for the single corner of a cylinder.
    pub length_m: f64,
}

impl Obstacle {
    /// From corners, convex and counterclockwise, at least three, and altitudes (infinite: without bottom or top), m.
    pub fn prism(corners: &[[f64; 2]], altitude_m: [f64; 2]) -> Self {
        assert!(corners.len() >= 3, "a polygon has three corners at least");
        let edge = |i: usize| {
            let (corner, next) = (corners[i], corners[(i + 1) % corners.len()]);
            let along = [next[0] - corner[0], next[1] - corner[1]];
            let length_m = along[0].hypot(along[1]);
            Edge { corner, normal: [along[1] / length_m, -along[0] / length_m], length_m }
        };
        Self::rounded((0..corners.len()).map(edge).collect(), 0.0, altitude_m)
    }

    /// An upright cylinder about `center`, m.
    pub fn cylinder(center: [f64; 2], radius_m: f64, altitude_m: [f64; 2]) -> Self {
        Self::rounded(vec![Edge { corner: center, normal: [1.0, 0.0], length_m: 0.0 }], radius_m, altitude_m)
    }

    fn rounded(edges: Vec<Edge>, round_m: f64, altitude_m: [f64; 2]) -> Self {
        let count = edges.len() as f64;
        let center = [0, 1].map(|axis| edges.iter().map(|edge| edge.corner[axis]).sum::<f64>() / count);
        let reach = |edge: &Edge| (edge.corner[0] - center[0]).hypot(edge.corner[1] - center[1]);
        let radius_m = edges.iter().map(reach).fold(0.0, f64::max) + round_m;
        Self { edges, round_m, altitude_m, circle: (center, radius_m) }
    }

    /// Edges of the polygon, counterclockwise.
    pub fn edges(&self) -> &[Edge] {
        &self.edges
    }

    /// Does it have no edges, one corner only?
    pub fn is_cylinder(&self) -> bool {
        self.edges.len() == 1
    }

    /// How far it reaches beyond its polygon, m.
    pub fn round_m(&self) -> f64 {
        self.round_m
    }

    /// Lowest and highest altitude, m.
    pub fn altitude_m(&self) -> [f64; 2] {
        self.altitude_m
    }

    /// Centre and radius of a circle around all of it, m.
    pub fn circle(&self) -> ([f64; 2], f64) {
        self.circle
    }

    /// Signed distance from a point, m: negative inside.
    pub fn distance_m(&self, point: Point) -> f64 {
        self.least_distance_m(point, point)
    }

    /// Could the segment from `p` to `q` come nearer than `distance_m`? Asks the circle around the obstacle.
    pub fn may_be_within(&self, p: Point, q: Point, distance_m: f64) -> bool {
        let ([x, y], radius_m) = self.circle;
        let (d, to_p) = ([q[0] - p[0], q[1] - p[1]], [p[0] - x, p[1] - y]);
        let length2 = dot(d, d);
        let share = if length2 > 0.0 { (-dot(to_p, d) / length2).clamp(0.0, 1.0) } else { 0.0 };
        let nearest = [to_p[0] + share * d[0], to_p[1] + share * d[1]];
        let reach_m = radius_m + distance_m;
        reach_m > 0.0 && dot(nearest, nearest) < reach_m * reach_m
    }

    /// Bound from below of the distance between the obstacle and the segment from `p` to `q`, m; the distance itself
    /// where the segment is level or a point. Inside, minus a depth.
    ///
    /// Any point of the segment is at least as far away in the plane as the segment is there, and at least as far above
    /// or below.
    pub fn least_distance_m(&self, p: Point, q: Point) -> f64 {
        let beside = self.planar_distance_m([p[0], p[1]], [q[0], q[1]]) - self.round_m;
        let [low, high] = self.altitude_m;
        let above = (low - p[2].max(q[2])).max(p[2].min(q[2]) - high);
        if beside > 0.0 && above > 0.0 { beside.hypot(above) } else { beside.max(above) }
    }

    /// Distance between polygon and segment in the plane, m; minus the depth of penetration by separating axes where
    /// they meet.
    fn planar_distance_m(&self, p: [f64; 2], q: [f64; 2]) -> f64 {
        let d = [q[0] - p[0], q[1] - p[1]];
        let length2 = dot(d, d);
        let per_length2 = if length2 > 0.0 { 1.0 / length2 } else { 0.0 };
        let mut nearest2 = f64::INFINITY;
        let mut apart = if self.is_cylinder() { f64::INFINITY } else { f64::NEG_INFINITY };
        let (mut leftmost, mut rightmost) = (f64::NEG_INFINITY, f64::INFINITY);
        for edge in &self.edges {
            let [to_p, to_q] = [p, q].map(|end| [end[0] - edge.corner[0], end[1] - edge.corner[1]]);
            let heights = [dot(edge.normal, to_p), dot(edge.normal, to_q)];
            apart = apart.max(heights[0].min(heights[1]));
            for (end, height) in [to_p, to_q].into_iter().zip(heights) {
                let along = edge.normal[0] * end[1] - edge.normal[1] * end[0];
                let beyond = along - along.clamp(0.0, edge.length_m);
                nearest2 = nearest2.min(height * height + beyond * beyond);
            }
            let share = (-dot(to_p, d) * per_length2).clamp(0.0, 1.0);
            let from_corner = [to_p[0] + share * d[0], to_p[1] + share * d[1]];
            nearest2 = nearest2.min(dot(from_corner, from_corner));
            let side = d[1] * to_p[0] - d[0] * to_p[1];
            (leftmost, rightmost) = (leftmost.max(side), rightmost.min(side));
        }
        if length2 > 0.0 {
            apart = apart.max(rightmost.max(-leftmost) * per_length2.sqrt());
        }
        if apart > 0.0 { nearest2.sqrt() } else { apart }
    }
}

fn dot(a: [f64; 2], b: [f64; 2]) -> f64 {
    a[0] * b[0] + a[1] * b[1]
}
