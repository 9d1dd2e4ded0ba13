use nalgebra::Vector3;

/// Position, velocity and acceleration at one instant, in any frame, m, m/s, m/s².
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Jet {
    pub position_m: Vector3<f64>,
    pub velocity_mps: Vector3<f64>,
    pub acceleration_mps2: Vector3<f64>,
}

impl Jet {
    pub const ZERO: Self = Self {
        position_m: Vector3::new(0.0, 0.0, 0.0),
        velocity_mps: Vector3::new(0.0, 0.0, 0.0),
        acceleration_mps2: Vector3::new(0.0, 0.0, 0.0),
    };
}

impl std::ops::Add for Jet {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self {
            position_m: self.position_m + other.position_m,
            velocity_mps: self.velocity_mps + other.velocity_mps,
            acceleration_mps2: self.acceleration_mps2 + other.acceleration_mps2,
        }
    }
}

/// The polynomial of degree 5 with given position, velocity and acceleration at both ends of an interval.
#[derive(Clone, Debug)]
pub(super) struct Quintic {
    /// Coefficients of 1, t, ..., t⁵ with t in s since the beginning of the interval.
    coefficients: [Vector3<f64>; 6],
}

impl Quintic {
    /// From `first` at t = 0 to `last` at t = `duration_s` > 0.
    pub fn between(first: &Jet, last: &Jet, duration_s: f64) -> Self {
        let h = duration_s;
        let (p, v, a) = (first.position_m, first.velocity_mps, first.acceleration_mps2);
        // Differences from constant acceleration at the end, each in m.
        let δp = last.position_m - p - (v + a * (h / 2.0)) * h;
        let δv = (last.velocity_mps - v - a * h) * h;
        let δa = (last.acceleration_mps2 - a) * (h * h);
        let c3 = (δp * 10.0 - δv * 4.0 + δa * 0.5) / h.powi(3);
        let c4 = (δp * -15.0 + δv * 7.0 - δa) / h.powi(4);
        let c5 = (δp * 6.0 - δv * 3.0 + δa * 0.5) / h.powi(5);
        Self { coefficients: [p, v, a / 2.0, c3, c4, c5] }
    }

    /// The polynomial and its first two derivatives at `t_s` after the interval's beginning.
    pub fn at(&self, t_s: f64) -> Jet {
        let [c0, c1, c2, c3, c4, c5] = self.coefficients;
        let t = t_s;
        Jet {
            position_m: c0 + (c1 + (c2 + (c3 + (c4 + c5 * t) * t) * t) * t) * t,
            velocity_mps: c1 + (c2 * 2.0 + (c3 * 3.0 + (c4 * 4.0 + c5 * (5.0 * t)) * t) * t) * t,
            acceleration_mps2: c2 * 2.0 + (c3 * 6.0 + (c4 * 12.0 + c5 * (20.0 * t)) * t) * t,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn both_ends_are_interpolated() {
        let first = Jet {
            position_m: Vector3::new(1.0, -2.0, 3.0),
            velocity_mps: Vector3::new(30.0, 1.0, 0.5),
            acceleration_mps2: Vector3::new(0.1, 2.0, -0.3),
        };
        let last = Jet {
            position_m: Vector3::new(70.0, 4.0, 3.5),
            velocity_mps: Vector3::new(33.0, 3.0, 0.0),
            acceleration_mps2: Vector3::new(-1.0, 0.0, 0.7),
        };
        let quintic = Quintic::between(&first, &last, 2.3);
        for (jet, expected) in [(quintic.at(0.0), first), (quintic.at(2.3), last)] {
            assert!((jet.position_m - expected.position_m).norm() < 1e-12);
            assert!((jet.velocity_mps - expected.velocity_mps).norm() < 1e-12);
            assert!((jet.acceleration_mps2 - expected.acceleration_mps2).norm() < 1e-12);
        }
    }
}
