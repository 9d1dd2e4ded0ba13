use nalgebra::{UnitQuaternion, Vector3, Vector4};
use scenarios::multirotor::{Airframe, GRAVITY_MPS2, Limits, Model};

use super::reference::ReferencePoint;
use crate::kinematics::AttitudeState;
use crate::quadrotor::{RotorGeometry, allocation, torque_nm};
use crate::sensors::Measurement;

/// Follows a reference from measured position and velocity.
///
/// ```text
/// u = a_ref + ω² (p_ref - p) + 2 ζ ω (v_ref - v)
/// ```
///
/// It knows the nominal vehicle, but neither the wind nor the true mass.
#[derive(Clone, Debug)]
pub(super) struct Tracker {
    /// ω², 1/s².
    position_gain: f64,
    /// 2 ζ ω, 1/s.
    velocity_gain: f64,
}

impl Tracker {
    pub fn new(gains: &scenarios::Tracker) -> Self {
        let ω = gains.natural_frequency_radps;
        Self { position_gain: ω * ω, velocity_gain: 2.0 * gains.damping_ratio * ω }
    }

    /// Desired acceleration, m/s².
    ///
    /// - `reference`: now, for the feedback
    /// - `ahead`: half a step ahead, for the feed-forward
    pub fn acceleration_mps2(
        &self,
        measured: &Measurement,
        reference: &ReferencePoint,
        ahead: &ReferencePoint,
    ) -> Vector3<f64> {
        ahead.acceleration_mps2
            + (reference.position_m - measured.position_m) * self.position_gain
            + (reference.velocity_mps - measured.velocity_mps) * self.velocity_gain
    }
}

/// Factor that keeps a scaled vector inside its limit in spite of rounding.
const ROUNDING_MARGIN: f64 = 1.0 - 1e-12;
/// Yaw rate of a quadrotor per rad of yaw error, rad/s: low, since rotors have little torque about the vertical axis.
const YAW_RATE_PER_RAD: f64 = 0.5;

/// Maximum jerk of the acceleration that a quadrotor is commanded, m/s³. Plans step from one acceleration to the next,
/// but a quadrotor has to tilt in between, at some 3 rad/s for this jerk.
const MAX_JERK_MPS3: f64 = 30.0;

/// An acceleration inside the vehicle's limits: it neither exceeds the maximum acceleration, nor leads beyond the
/// maximum speed within a step.
///
/// - `velocity_mps`: measured velocity over ground; the vehicle does not know the wind
pub(super) fn limited_mps2(
    desired_mps2: &Vector3<f64>,
    velocity_mps: &Vector3<f64>,
    limits: &Limits,
    step_s: f64,
) -> Vector3<f64> {
    let max_mps2 = limits.acceleration_mps2 * ROUNDING_MARGIN;
    let limited_mps2 = desired_mps2 * (max_mps2 / desired_mps2.norm().max(max_mps2));
    let next_mps = velocity_mps + limited_mps2 * step_s;
    let max_mps = limits.speed_mps.max(velocity_mps.norm());
    if next_mps.norm() <= max_mps {
        return limited_mps2;
    }
    let at_max_speed_mps2 = (next_mps * (max_mps / next_mps.norm()) - velocity_mps) / step_s;
    at_max_speed_mps2 * (max_mps2 / at_max_speed_mps2.norm().max(max_mps2))
}

/// The desired acceleration of a quadrotor with its jerk limited: it changes no faster than the quadrotor can tilt.
pub(super) fn jerk_limited_mps2(last_mps2: &Vector3<f64>, desired_mps2: &Vector3<f64>, step_s: f64) -> Vector3<f64> {
    let (change_mps2, max_mps2) = (desired_mps2 - last_mps2, MAX_JERK_MPS3 * step_s);
    last_mps2 + change_mps2 * (max_mps2 / change_mps2.norm().max(max_mps2))
}

/// The quadrotor's inner loop: computes thrusts for an acceleration.
#[derive(Clone, Debug)]
pub(super) struct Autopilot {
    mass_kg: f64,
    airframe: Airframe,
}

impl Autopilot {
    /// Of a quadrotor. Panics without an airframe, which validation requires.
    pub fn new(model: &Model) -> Self {
        let airframe = model.airframe.clone().expect("a quadrotor has an airframe");
        Self { mass_kg: model.mass_kg, airframe }
    }

    pub fn airframe(&self) -> &Airframe {
        &self.airframe
    }

    pub fn rotors(&self) -> RotorGeometry {
        RotorGeometry { arm_m: self.airframe.arm_m, torque_per_thrust_m: self.airframe.torque_per_thrust_m }
    }

    /// Thrust of each rotor in hover, N.
    pub fn hover_n(&self) -> Vector4<f64> {
        Vector4::repeat(self.mass_kg * GRAVITY_MPS2 / 4.0)
    }

    /// Thrusts, N: commanded, and inside the rotors' limits.
    ///
    /// - `desired_mps2`: acceleration before the vehicle's limits
    /// - `limited_mps2`: the same inside the vehicle's limits
    pub fn thrusts_n(
        &self,
        measured: &AttitudeState,
        desired_mps2: &Vector3<f64>,
        limited_mps2: &Vector3<f64>,
    ) -> [Vector4<f64>; 2] {
        let (rotors, limits) = (self.rotors(), self.airframe.thrust_n);
        let desired = self.wrench(measured, desired_mps2);
        let command_n = allocation::unlimited(&rotors, desired.0, &desired.1);
        if desired_mps2 == limited_mps2 && command_n.iter().all(|thrust| limits.contains(*thrust)) {
            return [command_n; 2];
        }
        let inside = self.wrench(measured, limited_mps2);
        [command_n, allocation::limited(&rotors, inside.0, &inside.1, limits)]
    }

    /// Total thrust, N, and torque, N m, for an acceleration: the thrust axis turns to the force by the smallest
    /// rotation, and the yaw angle slowly returns to 0 (east).
    fn wrench(&self, measured: &AttitudeState, acceleration_mps2: &Vector3<f64>) -> (f64, Vector3<f64>) {
        let force_n = (acceleration_mps2 + Vector3::z() * GRAVITY_MPS2) * self.mass_kg;
        let axis = measured.attitude * Vector3::z();
        let tilt = UnitQuaternion::rotation_between(&axis, &force_n).unwrap_or_else(UnitQuaternion::identity);
        let (_, _, yaw) = measured.attitude.euler_angles();
        let rate_radps = Vector3::z() * (-YAW_RATE_PER_RAD * yaw);
        let desired = AttitudeState { attitude: tilt * measured.attitude, rate_radps };
        let torque_nm = torque_nm(measured, &desired, &Vector3::zeros(), &self.airframe.inertia_kgm2.into());
        (force_n.dot(&axis), torque_nm)
    }
}

/// The attitude whose thrust axis points along `force`, by the smallest rotation from level; level without a force.
pub(super) fn upright_towards(force: &Vector3<f64>) -> UnitQuaternion<f64> {
    UnitQuaternion::rotation_between(&Vector3::z(), force).unwrap_or_else(UnitQuaternion::identity)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_acceleration_is_limited_by_its_maximum_and_by_the_maximum_speed() {
        let limits = Limits { speed_mps: 3.0, acceleration_mps2: 2.0 };
        let cut = |a: [f64; 3], v: [f64; 3]| limited_mps2(&a.into(), &v.into(), &limits, 0.01);
        assert_eq!(cut([1.0, 1.0, 0.0], [0.0; 3]), Vector3::new(1.0, 1.0, 0.0));
        assert!((cut([30.0, 40.0, 0.0], [0.0; 3]) - Vector3::new(1.2, 1.6, 0.0) * ROUNDING_MARGIN).norm() < 1e-12);
        // At full speed nothing speeds up, but turning and braking are free.
        assert!(cut([2.0, 0.0, 0.0], [3.0, 0.0, 0.0]).norm() < 1e-9);
        let turned = cut([0.0, 2.0, 0.0], [3.0, 0.0, 0.0]);
        assert!((Vector3::new(3.0, 0.0, 0.0) + turned * 0.01).norm() <= 3.0 + 1e-12 && turned.y > 1.9);
        let hardest = [-2.0 * ROUNDING_MARGIN, 0.0, 0.0];
        assert_eq!(cut(hardest, [3.0, 0.0, 0.0]), Vector3::from(hardest));
    }
}
