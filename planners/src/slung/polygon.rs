//! Signed distance from a point to a convex polygon, exact, with its derivatives.

/// A convex polygon, counterclockwise.
#[derive(Clone, Debug, PartialEq)]
pub struct Polygon {
    /// Corners, m.
    corners: Vec<[f64; 2]>,
}

/// A signed distance, m, with gradient and Hessian with respect to the point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Distance {
    /// Negative inside.
    pub value: f64,
    /// Unit vector away from the polygon.
    pub gradient: [f64; 2],
    /// (xx, xy, yy), 1/m: that of a circle near a corner, zero near an edge.
    pub hessian: [f64; 3],
}

impl Polygon {
    /// From corners in counterclockwise order; at least three, no three of them on a line.
    pub fn new(corners: Vec<[f64; 2]>) -> Self {
        let polygon = Self { corners };
        assert!(polygon.corners.len() >= 3 && polygon.is_convex(), "a convex polygon, counterclockwise");
        polygon
    }

    /// A rectangle of that size about a centre, turned counterclockwise by `angle_rad`.
    pub fn rectangle(center_m: [f64; 2], size_m: [f64; 2], angle_rad: f64) -> Self {
        let (sin, cos) = angle_rad.sin_cos();
        let corner = |[a, b]: [f64; 2]| {
            let (x, y) = (0.5 * a * size_m[0], 0.5 * b * size_m[1]);
            [center_m[0] + cos * x - sin * y, center_m[1] + sin * x + cos * y]
        };
        Self::new([[1.0, 1.0], [-1.0, 1.0], [-1.0, -1.0], [1.0, -1.0]].map(corner).to_vec())
    }

    /// Corners, counterclockwise.
    pub fn corners(&self) -> &[[f64; 2]] {
        &self.corners
    }

    fn is_convex(&self) -> bool {
        let n = self.corners.len();
        let turn = |i: usize| {
            let (a, b, c) = (self.corners[i], self.corners[(i + 1) % n], self.corners[(i + 2) % n]);
            cross(minus(b, a), minus(c, b))
        };
        (0..n).all(|i| turn(i) > 0.0)
    }

    /// Signed distance from `point`: to the nearest edge or corner outside, to the nearest edge's line inside.
    pub fn distance(&self, point: [f64; 2]) -> Distance {
        let n = self.corners.len();
        let mut nearest: Option<Distance> = None;
        let mut deepest: Option<Distance> = None;
        for i in 0..n {
            let (a, b) = (self.corners[i], self.corners[(i + 1) % n]);
            let (edge, to_point) = (minus(b, a), minus(point, a));
            let length = dot(edge, edge).sqrt();
            let normal = [edge[1] / length, -edge[0] / length];
            let height = dot(normal, to_point);
            let along = dot(edge, to_point) / length;
            let line = Distance { value: height, gradient: normal, hessian: [0.0; 3] };
            if deepest.is_none_or(|deepest| height > deepest.value) {
                deepest = Some(line);
            }
            if height > 0.0 || along < 0.0 {
                let candidate = if along < 0.0 {
                    from_corner(to_point)
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
            _ => nearest.expect("a point outside is nearest to something"),
        }
    }
}

fn from_corner(to_point: [f64; 2]) -> Distance {
    let value = dot(to_point, to_point).sqrt();
    let [x, y] = [to_point[0] / value, to_point[1] / value];
    Distance { value, gradient: [x, y], hessian: [y * y / value, -x * y / value, x * x / value] }
}

fn minus(a: [f64; 2], b: [f64; 2]) -> [f64; 2] {
    [a[0] - b[0], a[1] - b[1]]
}

fn dot(a: [f64; 2], b: [f64; 2]) -> f64 {
    a[0] * b[0] + a[1] * b[1]
}

fn cross(a: [f64; 2], b: [f64; 2]) -> f64 {
    a[0] * b[1] - a[1] * b[0]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn distances_to_a_square_are_the_known_ones() {
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
