//! Convex polygons: exact signed distance with its derivatives, offset corners.

use nalgebra::Vector2;

/// A convex polygon with counterclockwise corners.
#[derive(Clone, Debug, PartialEq)]
pub struct Polygon {
    /// Corners, m.
    corners: Vec<Vector2<f64>>,
}

/// A signed distance with its derivatives with respect to the point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Distance {
    /// Distance, m; negative inside.
    pub value: f64,
    /// Unit vector away from the polygon.
    pub gradient: [f64; 2],
    /// (xx, xy, yy), 1/m: that of a circle next to a corner, zero next to an edge.
    pub hessian: [f64; 3],
}

impl Distance {
    /// Adds the weighted second derivatives to a Hessian whose first two variables are the point.
    ///
    /// - `width`: length of a row of the Hessian
    pub fn add_hessian(&self, hessian: &mut [f64], width: usize, weight: f64) {
        let [xx, xy, yy] = self.hessian;
        for (at, value) in [(0, xx), (1, xy), (width, xy), (width + 1, yy)] {
            hessian[at] += weight * value;
        }
    }
}

impl Polygon {
    /// The polygon with these corners, m.
    ///
    /// # Panics
    ///
    /// Panics unless there are at least three corners, in counterclockwise order, no three of them on a line.
    pub fn new(corners: Vec<[f64; 2]>) -> Self {
        let polygon = Self { corners: corners.into_iter().map(Vector2::from).collect() };
        assert!(polygon.corners.len() >= 3 && polygon.is_convex(), "a convex polygon, counterclockwise");
        polygon
    }

    /// A rectangle of this size about a centre, rotated counterclockwise by `angle_rad`.
    pub fn rectangle(center_m: [f64; 2], size_m: [f64; 2], angle_rad: f64) -> Self {
        let (sin, cos) = angle_rad.sin_cos();
        let corner = |[a, b]: [f64; 2]| {
            let (x, y) = (0.5 * a * size_m[0], 0.5 * b * size_m[1]);
            [center_m[0] + cos * x - sin * y, center_m[1] + sin * x + cos * y]
        };
        Self::new([[1.0, 1.0], [-1.0, 1.0], [-1.0, -1.0], [1.0, -1.0]].map(corner).to_vec())
    }

    /// Edges, from corner to corner.
    fn edges(&self) -> impl Iterator<Item = (Vector2<f64>, Vector2<f64>)> {
        let n = self.corners.len();
        (0..n).map(move |i| (self.corners[i], self.corners[(i + 1) % n]))
    }

    fn is_convex(&self) -> bool {
        let n = self.corners.len();
        let turn = |i: usize| {
            let (a, b, c) = (self.corners[i], self.corners[(i + 1) % n], self.corners[(i + 2) % n]);
            (b - a).perp(&(c - b))
        };
        (0..n).all(|i| turn(i) > 0.0)
    }

    /// Mean of the corners, m.
    pub fn center(&self) -> Vector2<f64> {
        self.corners.iter().fold(Vector2::zeros(), |sum, corner| sum + corner) / self.corners.len() as f64
    }

    /// Corners of the polygon whose edges are `distance_m` further out, m.
    pub fn offset_corners(&self, distance_m: f64) -> Vec<Vector2<f64>> {
        let n = self.corners.len();
        let normal = |i: usize| {
            let edge = self.corners[(i + 1) % n] - self.corners[i];
            Vector2::new(edge.y / edge.x.hypot(edge.y), -edge.x / edge.x.hypot(edge.y))
        };
        let corner = |i: usize| {
            let (a, b) = (normal((i + n - 1) % n), normal(i));
            let stretch = distance_m / (1.0 + a.x * b.x + a.y * b.y);
            self.corners[i] + stretch * (a + b)
        };
        (0..n).map(corner).collect()
    }

    /// Signed distance from `point`, m: outside to the nearest edge or corner, inside to the line of the nearest edge.
    pub fn distance(&self, point: [f64; 2]) -> Distance {
        let point = Vector2::from(point);
        let mut nearest: Option<Distance> = None;
        let mut deepest: Option<Distance> = None;
        for (a, b) in self.edges() {
            let (edge, to_point) = (b - a, point - a);
            let length = edge.dot(&edge).sqrt();
            let normal = Vector2::new(edge.y / length, -edge.x / length);
            let height = normal.dot(&to_point);
            let along = edge.dot(&to_point) / length;
            let line = Distance { value: height, gradient: normal.into(), hessian: [0.0; 3] };
            if deepest.is_none_or(|deepest| height > deepest.value) {
                deepest = Some(line);
            }
            if height > 0.0 || along < 0.0 {
                let candidate = if along < 0.0 {
                    distance_to_corner(to_point)
                } else if along <= length {
                    line
                } else {
                    continue;
                };
                if nearest.is_none_or(|nearest| candidate.value < nearest.value) {
                    nearest = Some(candidate);
                }
            }
        }
        match deepest {
            Some(inside) if inside.value <= 0.0 => inside,
            _ => nearest.expect("a point outside has a nearest edge or corner"),
        }
    }

    /// Distance from the line segment from `a` to `b`, m; zero where they intersect.
    pub fn distance_to_segment(&self, a: Vector2<f64>, b: Vector2<f64>) -> f64 {
        let (mut nearest, mut intersects) = (f64::INFINITY, false);
        for (c, d) in self.edges() {
            let separates = |p: Vector2<f64>, q: Vector2<f64>, r: Vector2<f64>, s: Vector2<f64>| {
                (q - p).perp(&(r - p)) * (q - p).perp(&(s - p)) < 0.0
            };
            intersects |= separates(a, b, c, d) && separates(c, d, a, b);
            nearest = nearest.min(point_to_segment(c, a, b));
        }
        let ends = self.distance(a.into()).value.min(self.distance(b.into()).value);
        if intersects { 0.0 } else { nearest.min(ends).max(0.0) }
    }
}

fn distance_to_corner(to_point: Vector2<f64>) -> Distance {
    let value = to_point.dot(&to_point).sqrt();
    let [x, y] = [to_point.x / value, to_point.y / value];
    Distance { value, gradient: [x, y], hessian: [y * y / value, -x * y / value, x * x / value] }
}

fn point_to_segment(point: Vector2<f64>, a: Vector2<f64>, b: Vector2<f64>) -> f64 {
    let (segment, to_point) = (b - a, point - a);
    let fraction = segment.dot(&to_point) / segment.dot(&segment).max(f64::MIN_POSITIVE);
    let offset = to_point - fraction.clamp(0.0, 1.0) * segment;
    offset.x.hypot(offset.y)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn distances_to_a_square_are_exact() {
        let square = Polygon::rectangle([0.0, 0.0], [2.0, 2.0], 0.0);
        let at = |x: f64, y: f64| square.distance([x, y]).value;
        assert!((at(3.0, 0.5) - 2.0).abs() < 1e-15);
        assert!((at(-2.0, -2.0) - 2.0_f64.sqrt()).abs() < 1e-15);
        assert!((at(0.25, 0.0) + 0.75).abs() < 1e-15);
        assert!(at(1.0, 0.3).abs() < 1e-15);
    }

    #[test]
    fn derivatives_agree_with_differences() {
        let polygon = Polygon::new(vec![[1.0, 0.2], [0.3, 1.4], [-1.2, 0.4], [-0.4, -0.9]]);
        let h = 1e-6;
        for k in 0..200 {
            let point = [3.0 * f64::from(k).sin(), 3.0 * (1.7 * f64::from(k)).cos()];
            let here = polygon.distance(point);
            let along = |axis: usize, sign: f64| {
                let mut moved = point;
                moved[axis] += sign * h;
                polygon.distance(moved)
            };
            for axis in 0..2 {
                let (ahead, behind) = (along(axis, 1.0), along(axis, -1.0));
                assert!((here.gradient[axis] - (ahead.value - behind.value) / (2.0 * h)).abs() < 1e-6);
                for other in 0..2 {
                    let difference = (ahead.gradient[other] - behind.gradient[other]) / (2.0 * h);
                    let exact = here.hessian[axis + other];
                    assert!((exact - difference).abs() < 1e-5, "at {point:?}: {exact} for {difference}");
                }
            }
        }
    }
}
