use nalgebra::{UnitQuaternion, Vector3, Vector4};

use crate::kinematics::AttitudeState;

/// Positions and directions of rotation of the rotors.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct RotorGeometry {
    /// Lever arm about x and y, m.
    pub arm_m: f64,
    /// Torque about z for each newton of a rotor's thrust, m.
    pub torque_per_thrust_m: f64,
}

impl RotorGeometry {
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

/// Thrusts of four rotors that follow their command with a lag of first order, or at once.
///
/// ```text
/// T' = (T_c - T)/τ   =>   T(t + h) = T_c + (T(t) - T_c) exp(-h/τ)
/// ```
#[derive(Clone, Copy, Debug)]
pub(crate) struct LaggedRotors {
    thrust_n: Vector4<f64>,
    time_constant_s: Option<f64>,
}

impl LaggedRotors {
    /// Rotors with these thrusts, N. `time_constant_s`: τ; without it they follow at once.
    pub fn new(thrust_n: Vector4<f64>, time_constant_s: Option<f64>) -> Self {
        Self { thrust_n, time_constant_s }
    }

    /// Advances the rotors by a step of `step_s` under a command, N. Returns the thrusts in the middle of the step, N:
    /// the mean of those at its two ends.
    pub fn advance(&mut self, command_n: &Vector4<f64>, step_s: f64) -> Vector4<f64> {
        let Some(time_constant_s) = self.time_constant_s else {
            self.thrust_n = *command_n;
            return self.thrust_n;
        };
        let next_n = command_n + (self.thrust_n - command_n) * (-step_s / time_constant_s).exp();
        let middle_n = (self.thrust_n + next_n) / 2.0;
        self.thrust_n = next_n;
        middle_n
    }
}

/// Force, N, and torque, N m, of the rotors on the body in the middle of a step, world frame.
///
/// - `thrust_n`: of each rotor in the middle of the step
/// - `start`: attitude at the beginning of the step, extrapolated at its angular velocity
pub(crate) fn mid_step_wrench(
    rotors: &RotorGeometry,
    thrust_n: &Vector4<f64>,
    start: &AttitudeState,
    step_s: f64,
) -> [Vector3<f64>; 2] {
    let (total_n, torque_nm) = rotors.wrench(thrust_n);
    let attitude = start.attitude * UnitQuaternion::from_scaled_axis(start.rate_radps * (step_s / 2.0));
    [attitude * Vector3::z() * total_n, attitude * torque_nm]
}
