use nalgebra::Vector3;
use scenarios::fixed_wing::{Control, GRAVITY_MPS2};

/// Below this a direction is undefined: a speed in m/s, or a sine.
const DEGENERATE: f64 = 1e-9;

/// Acceleration of gravity in the world frame, m/s².
pub fn gravity_mps2() -> Vector3<f64> {
    Vector3::new(0.0, 0.0, -GRAVITY_MPS2)
}

/// The axes in which load factors act: unit vectors in the world frame, right-handed.
///
/// ```text
/// e_V along the velocity relative to the air,   e_h horizontal to the left,   e_n = e_V x e_h
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AirPath {
    /// e_V, along the velocity relative to the air.
    pub forward: Vector3<f64>,
    /// e_h, horizontal, to the left: a force along it increases the heading.
    pub left: Vector3<f64>,
    /// e_n, perpendicular to the other two; upwards in level flight.
    pub up: Vector3<f64>,
}

impl AirPath {
    /// The axes of a velocity relative to the air, m/s.
    ///
    /// Where a direction is undefined (no airspeed, vertical flight), `forward` is x and `left` is y: a vehicle in such
    /// a state has violated its limits long before, and its log stays finite.
    pub fn new(air_velocity_mps: &Vector3<f64>) -> Self {
        let speed_mps = air_velocity_mps.norm();
        let forward = if speed_mps > DEGENERATE { air_velocity_mps * (1.0 / speed_mps) } else { Vector3::x() };
        let horizontal = (forward.x * forward.x + forward.y * forward.y).sqrt();
        let left = if horizontal > DEGENERATE {
            Vector3::new(-forward.y / horizontal, forward.x / horizontal, 0.0)
        } else {
            Vector3::y()
        };
        Self { forward, left, up: forward.cross(&left) }
    }

    /// Specific force f = g (n_x e_V + n_y e_h + n_z e_n) in the world frame, m/s²: all forces except gravity, over the
    /// nominal mass.
    pub fn specific_force_mps2(&self, control: Control) -> Vector3<f64> {
        (self.forward * control.n_x + self.left * control.n_y + self.up * control.n_z) * GRAVITY_MPS2
    }

    /// The load factors of a specific force (world frame, m/s²): the inverse of
    /// [`specific_force_mps2`](Self::specific_force_mps2).
    pub fn load_factors(&self, specific_force_mps2: &Vector3<f64>) -> Control {
        Control {
            n_x: self.forward.dot(specific_force_mps2) / GRAVITY_MPS2,
            n_y: self.left.dot(specific_force_mps2) / GRAVITY_MPS2,
            n_z: self.up.dot(specific_force_mps2) / GRAVITY_MPS2,
        }
    }

    /// Heading χ, counterclockwise from x (east), rad, in (-π, π].
    pub fn heading_rad(&self) -> f64 {
        // From e_h = (-sin χ, cos χ, 0), which is defined in vertical flight, too.
        (-self.left.x).atan2(self.left.y)
    }

    /// Flight-path angle γ above the horizontal, rad, in [-π/2, π/2].
    pub fn flight_path_rad(&self) -> f64 {
        self.forward.z.atan2(self.forward.x.hypot(self.forward.y))
    }
}

/// Acceleration of the nominal vehicle in air at rest, world frame, m/s²: load factors and gravity.
pub fn acceleration_mps2(velocity_mps: &Vector3<f64>, control: Control) -> Vector3<f64> {
    AirPath::new(velocity_mps).specific_force_mps2(control) + gravity_mps2()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn axes_are_right_handed_and_orthonormal() {
        for velocity in [Vector3::new(30.0, -20.0, 7.0), Vector3::new(-3.0, 0.1, -40.0), Vector3::z(), Vector3::zeros()]
        {
            let AirPath { forward, left, up } = AirPath::new(&velocity);
            for (axis, other) in [(forward, left), (left, up), (up, forward)] {
                assert!((axis.norm() - 1.0).abs() < 1e-15 && axis.dot(&other).abs() < 1e-15);
            }
            assert!((forward.cross(&left) - up).norm() < 1e-15);
        }
    }

    #[test]
    fn level_flight_has_left_to_the_left_and_up_upwards() {
        let path = AirPath::new(&Vector3::new(0.0, 35.0, 0.0));
        assert_eq!((path.left, path.up), (-Vector3::x(), Vector3::z()));
    }

    #[test]
    fn angles_are_those_of_the_state() {
        for (heading, flight_path) in [(0.3, 0.1), (-3.0, -1.2), (2.9, 0.0), (-1.6, 1.5)] {
            let state = scenarios::fixed_wing::State {
                x_m: 0.0,
                y_m: 0.0,
                z_m: 0.0,
                speed_mps: 33.0,
                heading_rad: heading,
                flight_path_rad: flight_path,
            };
            let path = AirPath::new(&Vector3::from(state.velocity_mps()));
            assert!((path.heading_rad() - heading).abs() < 1e-14);
            assert!((path.flight_path_rad() - flight_path).abs() < 1e-14);
        }
    }

    #[test]
    fn load_factors_invert_the_specific_force() {
        let path = AirPath::new(&Vector3::new(21.0, -30.0, 3.0));
        let control = Control { n_x: 0.17, n_y: -0.4, n_z: 1.3 };
        let back = path.load_factors(&path.specific_force_mps2(control));
        for (a, b) in back.to_array().into_iter().zip(control.to_array()) {
            assert!((a - b).abs() < 1e-15);
        }
    }

    #[test]
    fn cruise_is_unaccelerated() {
        let level = Vector3::new(-12.0, 31.0, 0.0);
        assert!(acceleration_mps2(&level, Control::CRUISE).norm() < 1e-14);
    }
}
