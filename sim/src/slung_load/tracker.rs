use nalgebra::{UnitQuaternion, Vector3, Vector4};
use scenarios::Range;
use scenarios::slung_load::{Cable, GRAVITY_MPS2};

use super::dynamics::Plant;
use super::gains::Gains;
use super::linear::Errors;
use super::reference::{Reference, ReferencePoint};
use super::state::SlungLoadState;
use crate::kinematics::AttitudeState;
use crate::quadrotor::{allocation, torque_nm};

/// Maximum correction of the acceleration, m/s²: beyond it the linearisation is not valid.
const MAX_CORRECTION_MPS2: f64 = 6.0;
/// Maximum integral of the position error, m s: enough to compensate for a constant disturbance (anti-windup).
const MAX_INTEGRAL_MS: f64 = 0.3;

/// Follows a reference from measurements, through slack and taut phases.
///
/// ```text
/// u = a_ref - K(t) (∫e, e, e', e_load, e_load')                 time-varying linear-quadratic regulator
/// F_des = m_Q (u + g e_3) - λ d                                 tension λ of the measured cable under u
/// ω' = ω'_ref - k_R e_R - k_ω e_ω,   τ = I ω' + ω × I ω         attitude towards F_des, geometric
/// ```
///
/// It knows the nominal plant and the planned state of the cable, but not the wind, the true masses or the tension.
#[derive(Clone, Debug)]
pub(super) struct Tracker {
    plant: Plant,
    gains: Gains,
    limits: Range,
    step_s: f64,
    /// ∫e, m s.
    integral_ms: Vector3<f64>,
}

/// Thrusts, N: commanded, and inside the rotors' limits.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Thrusts {
    pub command_n: Vector4<f64>,
    pub limited_n: Vector4<f64>,
}

impl Tracker {
    /// For a nominal plant whose rotors have these limits, N; a command is held for `step_s`.
    pub fn new(reference: &Reference, plant: &Plant, limits: Range, step_s: f64) -> Self {
        Self { plant: *plant, gains: Gains::about(reference, plant), limits, step_s, integral_ms: Vector3::zeros() }
    }

    /// Thrusts to hold over the coming step.
    ///
    /// - `reference`: now, for the feedback
    /// - `ahead`: half a step ahead, for the feed-forward
    pub fn command(
        &mut self,
        measured: &SlungLoadState,
        reference: &ReferencePoint,
        ahead: &ReferencePoint,
    ) -> Thrusts {
        let correction_mps2 = self.correction_mps2(measured, reference);
        let force_n = self.force_n(measured, ahead, &correction_mps2);
        let torque_nm = self.torque_nm(measured, reference, ahead, &force_n);
        let total_n = force_n.dot(&measured.thrust_axis());
        let command_n = allocation::unlimited(&self.plant.rotors(), total_n, &torque_nm);
        // Rounding may move a thrust at its limit slightly beyond it.
        let fits =
            command_n.iter().all(|thrust| (thrust - thrust.clamp(self.limits.min, self.limits.max)).abs() < 1e-9);
        let limited_n = if fits {
            command_n.map(|thrust| thrust.clamp(self.limits.min, self.limits.max))
        } else {
            allocation::limited(&self.plant.rotors(), total_n, &torque_nm, self.limits)
        };
        Thrusts { command_n: if fits { limited_n } else { command_n }, limited_n }
    }

    fn correction_mps2(&mut self, measured: &SlungLoadState, reference: &ReferencePoint) -> Vector3<f64> {
        let desired = &reference.state;
        let error_m = measured.position_m - desired.position_m;
        self.integral_ms += error_m * self.step_s;
        let norm_ms = self.integral_ms.norm().max(MAX_INTEGRAL_MS);
        self.integral_ms *= MAX_INTEGRAL_MS / norm_ms;
        let mut errors = Errors::zeros();
        errors.fixed_rows_mut::<3>(0).copy_from(&self.integral_ms);
        errors.fixed_rows_mut::<3>(3).copy_from(&error_m);
        errors.fixed_rows_mut::<3>(6).copy_from(&(measured.velocity_mps - desired.velocity_mps));
        errors.fixed_rows_mut::<3>(9).copy_from(&(measured.load_position_m - desired.load_position_m));
        errors.fixed_rows_mut::<3>(12).copy_from(&(measured.load_velocity_mps - desired.load_velocity_mps));
        let correction = -(self.gains.at(reference.t_s) * errors);
        correction * (MAX_CORRECTION_MPS2 / correction.norm().max(MAX_CORRECTION_MPS2))
    }

    /// Desired force of the rotors, world frame, N.
    fn force_n(
        &self,
        measured: &SlungLoadState,
        ahead: &ReferencePoint,
        correction_mps2: &Vector3<f64>,
    ) -> Vector3<f64> {
        let [planned_mps2, _] = self.plant.accelerations_mps2(&ahead.state, ahead.thrust_n.sum(), ahead.cable);
        let acceleration_mps2 = planned_mps2 + correction_mps2;
        let specific_force_mps2 = acceleration_mps2 + Vector3::z() * GRAVITY_MPS2;
        let pull_n = match ahead.cable {
            Cable::Slack => Vector3::zeros(),
            Cable::Taut => {
                // The measured cable, extrapolated by half a step.
                let ahead_m = measured.cable_m() + measured.load_relative_mps() * (self.step_s / 2.0);
                let (d, relative_mps) = (ahead_m.normalize(), measured.load_relative_mps());
                let across_mps = relative_mps - d * d.dot(&relative_mps);
                let pull_mps2 = across_mps.norm_squared() / ahead_m.norm() - d.dot(&specific_force_mps2);
                d * (pull_mps2 * self.plant.load_mass_kg).max(0.0)
            }
        };
        specific_force_mps2 * self.plant.mass_kg - pull_n
    }

    /// Torque in body axes, N m, that turns the thrust axis to `force_n`, and otherwise follows the planned attitude.
    fn torque_nm(
        &self,
        measured: &SlungLoadState,
        reference: &ReferencePoint,
        ahead: &ReferencePoint,
        force_n: &Vector3<f64>,
    ) -> Vector3<f64> {
        let planned_axis = ahead.state.thrust_axis();
        let tilt = UnitQuaternion::rotation_between(&planned_axis, force_n).unwrap_or_else(UnitQuaternion::identity);
        let (_, planned_nm) = self.plant.wrench(&ahead.thrust_n);
        let planned_radps2 = self.plant.angular_acceleration_radps2(&ahead.state.body_rate_radps, &planned_nm);
        let desired =
            AttitudeState { attitude: tilt * reference.state.attitude, rate_radps: reference.state.body_rate_radps };
        torque_nm(&measured.attitude_state(), &desired, &planned_radps2, &self.plant.inertia_kgm2)
    }
}
