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

    /// Rates (ψ', θ', φ') of the Z-Y-X Euler angles, rad/s: `W^-1 ω`; infinite or NaN at a pitch of 90 degrees.
    pub fn euler_rates_radps(&self) -> [f64; 3] {
        let ([roll, pitch, _], [x, y, z]) = (self.roll_pitch_yaw_rad, self.body_rate_radps);
        let ((sin, cos), yaw_cos) = (roll.sin_cos(), pitch.cos());
        let yaw_rate = (y * sin + z * cos) / yaw_cos;
        [yaw_rate, y * cos - z * sin, x + yaw_rate * pitch.sin()]
    }

    /// Cable angles α and β, rad, and length ρ, m: the load is at `ρ (-cos α sin β, sin α, -cos α cos β)` from the quadrotor.
    pub fn polar_cable(&self) -> [f64; 3] {
        let length_m = self.cable_length_m();
        let [x, y, z] = self.cable_m();
        [(y / length_m).clamp(-1.0, 1.0).asin(), (-x).atan2(-z), length_m]
    }

    /// Distance ρ between the ends of the cable, m.
    pub fn cable_length_m(&self) -> f64 {
        self.cable_m().iter().map(|x| x * x).sum::<f64>().sqrt()
    }
}

#[cfg(test)]
mod tests {
    use super::State;

    /// The angles of a known attitude and cable come back; the Euler rates are those of finite differences.
    #[test]
    fn derived_columns_are_the_inverse_of_the_definitions() {
        let (alpha, beta, length_m) = (0.3_f64, -0.7_f64, 0.65);
        let along = [-alpha.cos() * beta.sin(), alpha.sin(), -alpha.cos() * beta.cos()];
        let mut numbers = [0.0; 18];
        numbers[..3].copy_from_slice(&[1.0, -2.0, 3.0]);
        (0..3).for_each(|axis| numbers[12 + axis] = numbers[axis] + length_m * along[axis]);
        let (roll, pitch, rates) = (0.4_f64, -0.5_f64, [0.2, -0.6, 0.9]);
        let [yaw_rate, pitch_rate, roll_rate] = rates;
        numbers[6..8].copy_from_slice(&[roll, pitch]);
        // ω = W η'
        numbers[9] = roll_rate - yaw_rate * pitch.sin();
        numbers[10] = pitch_rate * roll.cos() + yaw_rate * pitch.cos() * roll.sin();
        numbers[11] = yaw_rate * pitch.cos() * roll.cos() - pitch_rate * roll.sin();
        let state = State::from_array(numbers);
        for (found, expected) in state.euler_rates_radps().into_iter().zip(rates) {
            assert!((found - expected).abs() < 1e-14, "{found} for {expected}");
        }
        for (found, expected) in state.polar_cable().into_iter().zip([alpha, beta, length_m]) {
            assert!((found - expected).abs() < 1e-14, "{found} for {expected}");
        }
    }
}
