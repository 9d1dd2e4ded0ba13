//! Four rotors on a rigid body: what every quadrotor has, with a load or without.

pub(crate) mod allocation;
mod attitude;

use nalgebra::{Vector3, Vector4};

pub(crate) use attitude::{AttitudeState, torque_nm};

/// Where the rotors sit and how they turn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Rotors {
    /// Lever arm about x and y, m.
    pub arm_m: f64,
    /// Torque about z for each newton of a rotor's thrust, m.
    pub torque_per_thrust_m: f64,
}

impl Rotors {
    /// Total thrust, N, and torque in body axes, N m, of four rotors with these thrusts, N.        [Kang 2020, eq. 5]
    pub fn wrench(&self, thrust_n: &Vector4<f64>) -> (f64, Vector3<f64>) {
        let [f1, f2, f3, f4] = [thrust_n[0], thrust_n[1], thrust_n[2], thrust_n[3]];
        let torque_nm = Vector3::new(
            self.arm_m * (-f1 + f2 + f3 - f4),
            self.arm_m * (-f1 - f2 + f3 + f4),
            self.torque_per_thrust_m * (f1 - f2 + f3 - f4),
        );
        (thrust_n.sum(), torque_nm)
    }
}
