use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::{LoadPoint, Waypoint};

/// State of the quadrotor and its load. World frame ENU; body axes x forward, y left, z up.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct State {
    /// Position of the quadrotor, m.
    pub position_m: [f64; 3],
    /// Velocity of the quadrotor, world frame, m/s.
    pub velocity_mps: [f64; 3],
    /// Roll φ, pitch θ, yaw ψ, rad: world from body is R_z(ψ) R_y(θ) R_x(φ).
    pub roll_pitch_yaw_rad: [f64; 3],
    /// Angular velocity in body axes, rad/s.
    pub body_rate_radps: [f64; 3],
    /// Position of the load, m.
    pub load_position_m: [f64; 3],
    /// Velocity of the load, world frame, m/s.
    pub load_velocity_mps: [f64; 3],
}

/// Thrusts of the four rotors, N.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Control {
    /// F_1 ... F_4.
    pub thrust_n: [f64; 4],
}

/// State of the cable.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Cable {
    /// At its full length, under tension.
    Taut,
    /// Without tension; the load falls freely or rests on the ground.
    Slack,
}

impl State {
    /// The level state at a waypoint, for a cable of length `cable_length_m`.
    pub fn at(waypoint: &Waypoint, cable_length_m: f64) -> Self {
        let position_m = waypoint.position_m();
        let [x, y, z] = position_m;
        let velocity_mps = waypoint.velocity_mps();
        Self {
            position_m,
            velocity_mps,
            roll_pitch_yaw_rad: [0.0; 3],
            body_rate_radps: [0.0; 3],
            load_position_m: waypoint.load.map_or([x, y, z - cable_length_m], |load: LoadPoint| load.position_m()),
            load_velocity_mps: velocity_mps,
        }
    }

    /// The 18 components, in the order of the fields.
    pub fn to_array(self) -> [f64; 18] {
        let parts = [
            self.position_m,
            self.velocity_mps,
            self.roll_pitch_yaw_rad,
            self.body_rate_radps,
            self.load_position_m,
            self.load_velocity_mps,
        ];
        std::array::from_fn(|i| parts[i / 3][i % 3])
    }

    /// From the 18 components, in the order of the fields.
    pub fn from_array(numbers: [f64; 18]) -> Self {
        let part = |index: usize| std::array::from_fn(|axis| numbers[3 * index + axis]);
        Self {
            position_m: part(0),
            velocity_mps: part(1),
            roll_pitch_yaw_rad: part(2),
            body_rate_radps: part(3),
            load_position_m: part(4),
            load_velocity_mps: part(5),
        }
    }

    /// Vector from the quadrotor to the load, m.
    pub fn cable_m(&self) -> [f64; 3] {
        std::array::from_fn(|axis| self.load_position_m[axis] - self.position_m[axis])
    }

    /// Distance ρ between the ends of the cable, m.
    pub fn cable_length_m(&self) -> f64 {
        self.cable_m().iter().map(|x| x * x).sum::<f64>().sqrt()
    }
}
