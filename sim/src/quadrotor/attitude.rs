use nalgebra::Vector3;

use crate::kinematics::AttitudeState;

/// Natural frequency, rad/s, and damping ratio of the attitude error.
const NATURAL_FREQUENCY_RADPS: f64 = 25.0;
const DAMPING_RATIO: f64 = 0.8;

/// Torque in body axes, N m, that drives a measured attitude to a desired one.
///
/// ```text
/// ω' = ω'_ff - k_R e_R - k_ω e_ω,   τ = I ω' + ω × I ω
/// ```
///
/// - `feed_forward_radps2`: angular acceleration of the desired motion, in its own body axes, rad/s²
/// - `inertia_kgm2`: moments of inertia about the body axes, kg m²
pub(crate) fn torque_nm(
    measured: &AttitudeState,
    desired: &AttitudeState,
    feed_forward_radps2: &Vector3<f64>,
    inertia_kgm2: &Vector3<f64>,
) -> Vector3<f64> {
    let body_from_desired = measured.attitude.inverse() * desired.attitude;
    let attitude_error = -body_from_desired.scaled_axis();
    let rate_error = measured.rate_radps - body_from_desired * desired.rate_radps;
    let angular_acceleration = body_from_desired * feed_forward_radps2
        - attitude_error * NATURAL_FREQUENCY_RADPS.powi(2)
        - rate_error * (2.0 * DAMPING_RATIO * NATURAL_FREQUENCY_RADPS);
    let momentum = inertia_kgm2.component_mul(&measured.rate_radps);
    inertia_kgm2.component_mul(&angular_acceleration) + measured.rate_radps.cross(&momentum)
}
