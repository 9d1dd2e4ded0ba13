use nalgebra::{UnitQuaternion, Vector3};

/// Natural frequency, rad/s, and damping ratio of the attitude error.
const NATURAL_FREQUENCY_RADPS: f64 = 25.0;
const DAMPING_RATIO: f64 = 0.8;

/// How a body is turned and turns. World from body; rates in body axes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct AttitudeState {
    /// World from body.
    pub attitude: UnitQuaternion<f64>,
    /// Angular velocity, rad/s.
    pub rate_radps: Vector3<f64>,
}

/// Torque in body axes, N m, that brings a measured attitude to a wanted one.
///
/// ```text
/// ω' = ω'_ff - k_R e_R - k_ω e_ω,   τ = I ω' + ω × I ω
/// ```
///
/// - `feed_forward_radps2`: angular acceleration of the wanted motion, in its own body axes, rad/s²
/// - `inertia_kgm2`: moments of inertia about the body axes, kg m²
pub(crate) fn torque_nm(
    measured: &AttitudeState,
    wanted: &AttitudeState,
    feed_forward_radps2: &Vector3<f64>,
    inertia_kgm2: &Vector3<f64>,
) -> Vector3<f64> {
    let body_from_wanted = measured.attitude.inverse() * wanted.attitude;
    let attitude_error = -body_from_wanted.scaled_axis();
    let rate_error = measured.rate_radps - body_from_wanted * wanted.rate_radps;
    let angular_acceleration = body_from_wanted * feed_forward_radps2
        - attitude_error * NATURAL_FREQUENCY_RADPS.powi(2)
        - rate_error * (2.0 * DAMPING_RATIO * NATURAL_FREQUENCY_RADPS);
    let momentum = inertia_kgm2.component_mul(&measured.rate_radps);
    inertia_kgm2.component_mul(&angular_acceleration) + measured.rate_radps.cross(&momentum)
}
