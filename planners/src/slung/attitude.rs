//! Rotation of the quadrotor in Z-Y-X Euler angles η = (ψ, θ, φ): yaw, pitch, roll.
//!
//! ```text
//! b3 = R_zyx e3                    ω = W(θ, φ) η'               I ω' + ω x I ω = τ        (ω, τ in body axes)
//! η'' = W^-1 (I^-1 (τ - ω x I ω) - W' η')
//! ```
//!
//! The paper approximates generalised torques by body torques (Kang, Huang, Wen 2020, eq. 5; small angles). Here the
//! torques are body torques without approximation, as on the vehicle.

use super::jet::Jet;

/// Thrust axis b3 as a function of (ψ, θ, φ).
#[inline(always)]
pub fn thrust_axis<const N: usize>([yaw, pitch, roll]: [Jet<N>; 3]) -> [Jet<N>; 3] {
    let ((s_yaw, c_yaw), (s_pitch, c_pitch), (s_roll, c_roll)) = (yaw.sin_cos(), pitch.sin_cos(), roll.sin_cos());
    let forward = s_pitch * c_roll;
    [c_yaw * forward + s_yaw * s_roll, s_yaw * forward - c_yaw * s_roll, c_pitch * c_roll]
}

/// η'' and its derivative with respect to the body's angular acceleration.
#[derive(Clone, Copy, Debug)]
pub struct EulerAcceleration<const N: usize> {
    /// (ψ'', θ'', φ''), rad/s^2.
    pub acceleration: [Jet<N>; 3],
    /// W^-1: rows (ψ, θ, φ), columns body axes.
    pub inverse: [[Jet<N>; 3]; 3],
}

/// η'' at (θ, φ, ψ', θ', φ').
///
/// - `inertia`: principal moments of inertia, kg m^2
/// - `angular`: `I^-1 τ` in body axes, rad/s^2
#[inline(always)]
pub fn euler_acceleration<const N: usize>(
    [pitch, roll, yaw_rate, pitch_rate, roll_rate]: [Jet<N>; 5],
    inertia: [f64; 3],
    angular: [f64; 3],
) -> EulerAcceleration<N> {
    let ((s_pitch, c_pitch), (s_roll, c_roll)) = (pitch.sin_cos(), roll.sin_cos());
    let level = yaw_rate * c_pitch;
    let ω =
        [roll_rate - yaw_rate * s_pitch, pitch_rate * c_roll + level * s_roll, level * c_roll - pitch_rate * s_roll];
    let gyroscopic = |i: usize| {
        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
        ω[j] * ω[k] * ((inertia[j] - inertia[k]) / inertia[i])
    };
    // W' η' by the product rule: (ψ' cos θ)' at constant rates is -ψ' θ' sin θ
    let level_change = -(yaw_rate * pitch_rate * s_pitch);
    let convective =
        [-(pitch_rate * level), roll_rate * ω[2] + level_change * s_roll, level_change * c_roll - roll_rate * ω[1]];
    let b: [Jet<N>; 3] = std::array::from_fn(|i| gyroscopic(i) + Jet::constant(angular[i]) - convective[i]);
    let secant = c_pitch.recip();
    let zero = Jet::constant(0.0);
    let yaw = [zero, s_roll * secant, c_roll * secant];
    let inverse = [yaw, [zero, c_roll, -s_roll], [Jet::constant(1.0), yaw[1] * s_pitch, yaw[2] * s_pitch]];
    let yaw_acceleration = yaw[1] * b[1] + yaw[2] * b[2];
    let acceleration = [yaw_acceleration, c_roll * b[1] - s_roll * b[2], b[0] + yaw_acceleration * s_pitch];
    EulerAcceleration { acceleration, inverse }
}

/// Body rates ω = W η', rad/s, at (ψ, θ, φ) and (ψ', θ', φ').
pub fn body_rate([_, pitch, roll]: [f64; 3], [yaw_rate, pitch_rate, roll_rate]: [f64; 3]) -> [f64; 3] {
    let ((s_pitch, c_pitch), (s_roll, c_roll)) = (pitch.sin_cos(), roll.sin_cos());
    [
        roll_rate - yaw_rate * s_pitch,
        pitch_rate * c_roll + yaw_rate * c_pitch * s_roll,
        yaw_rate * c_pitch * c_roll - pitch_rate * s_roll,
    ]
}
