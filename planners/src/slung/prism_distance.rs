//! Signed distance of a point from an upright prism, with its derivatives.

use nalgebra::{Matrix3, Vector3};

use super::polygon::Polygon;

/// A signed distance with its derivatives with respect to the point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PrismDistance {
    /// Distance, m; negative inside.
    pub value: f64,
    /// Unit vector away from the prism.
    pub gradient: Vector3<f64>,
    /// Second derivatives, 1/m.
    pub hessian: Matrix3<f64>,
}

/// Signed distance of `point` from the prism over `outline` between two altitudes, m. It is a convex function of the point.
pub fn prism_distance(outline: &Polygon, [low_m, high_m]: [f64; 2], point: Vector3<f64>) -> PrismDistance {
    let beside = outline.distance([point.x, point.y]);
    let ([x, y], [xx, xy, yy]) = (beside.gradient, beside.hessian);
    let horizontal = PrismDistance {
        value: beside.value,
        gradient: Vector3::new(x, y, 0.0),
        hessian: Matrix3::new(xx, xy, 0.0, xy, yy, 0.0, 0.0, 0.0, 0.0),
    };
    let (above_m, below_m) = (point.z - high_m, low_m - point.z);
    let vertical = PrismDistance {
        value: above_m.max(below_m),
        gradient: Vector3::z() * if above_m >= below_m { 1.0 } else { -1.0 },
        hessian: Matrix3::zeros(),
    };
    if horizontal.value > 0.0 && vertical.value > 0.0 {
        beyond_an_edge(&horizontal, &vertical)
    } else if horizontal.value >= vertical.value {
        horizontal
    } else {
        vertical
    }
}

/// `D = √(a² + b²)` of a horizontal and a vertical distance.
fn beyond_an_edge(a: &PrismDistance, b: &PrismDistance) -> PrismDistance {
    let value = a.value.hypot(b.value);
    let gradient = (a.gradient * a.value + b.gradient * b.value) / value;
    let squares = a.gradient * a.gradient.transpose() + b.gradient * b.gradient.transpose();
    let hessian = (squares + a.hessian * a.value - gradient * gradient.transpose()) / value;
    PrismDistance { value, gradient, hessian }
}

#[cfg(test)]
mod tests {
    use nalgebra::Vector3;

    use super::{Polygon, prism_distance};

    #[test]
    fn distances_to_a_cube_are_exact() {
        let square = Polygon::rectangle([0.0, 0.0], [2.0, 2.0], 0.0);
        let at = |x: f64, y: f64, z: f64| prism_distance(&square, [-1.0, 1.0], Vector3::new(x, y, z)).value;
        for (point, expected) in [
            ([0.0, 0.0, 3.0], 2.0),
            ([0.0, 0.0, -1.5], 0.5),
            ([2.0, 0.0, 2.0], 2.0_f64.sqrt()),
            ([2.0, 2.0, 2.0], 3.0_f64.sqrt()),
            ([0.9, 0.0, 0.0], -0.1),
            ([0.5, 0.0, -0.8], -0.2),
        ] {
            let [x, y, z] = point;
            assert!((at(x, y, z) - expected).abs() < 1e-15, "{point:?}");
        }
    }

    #[test]
    fn derivatives_agree_with_differences() {
        let polygon = Polygon::new(vec![[1.0, 0.2], [0.3, 1.4], [-1.2, 0.4], [-0.4, -0.9]]);
        let h = 1e-6;
        for k in 0..200 {
            let k = f64::from(k);
            let point = Vector3::new(3.0 * k.sin(), 3.0 * (1.7 * k).cos(), 2.0 * (0.6 * k).sin());
            let at = |point| prism_distance(&polygon, [-0.7, 0.4], point);
            let here = at(point);
            for axis in 0..3 {
                let step = Vector3::ith(axis, h);
                let (ahead, behind) = (at(point + step), at(point - step));
                assert!((here.gradient[axis] - (ahead.value - behind.value) / (2.0 * h)).abs() < 1e-6, "{point}");
                let change = (ahead.gradient - behind.gradient) / (2.0 * h);
                assert!((here.hessian.column(axis) - change).amax() < 1e-5, "{point}");
            }
        }
    }
}
