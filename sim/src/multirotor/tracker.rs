use nalgebra::{UnitQuaternion, Vector3, Vector4};
use scenarios::multirotor::{Airframe, GRAVITY_MPS2, Limits, Model};

use super::reference::ReferencePoint;
use crate::quadrotor::{AttitudeState, Rotors, allocation, torque_nm};
use crate::sensors::Measurement;

/// Follows a reference from measured position and velocity.
///
/// ```text
/// u = a_ref + ω² (p_ref - p) + 2 ζ ω (v_ref - v)
/// ```
///
/// It knows the nominal vehicle, not the wind and not the true mass.
#[derive(Clone, Debug)]
pub(super) struct Tracker {
    stiffness: f64,
    damping: f64,
}

impl Tracker {
    pub fn new(gains: &scenarios::Tracker) -> Self {
        let ω = gains.natural_frequency_radps;
        Self { stiffness: ω * ω, damping: 2.0 * gains.damping_ratio * ω }
    }

    /// Acceleration that is asked for, m/s².
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
            + (reference.position_m - measured.position_m) * self.stiffness
            + (reference.velocity_mps - measured.velocity_mps) * self.damping
    }
}

/// So far inside a limit a vector is scaled that rounding leaves it there.
const INSIDE: f64 = 1.0 - 1e-12;
/// Rate with which a quadrotor turns its nose back to the east, per rad of error, rad/s: yaw is the dearest of torques.
const YAW_RATE_PER_RAD: f64 = 0.5;

/// Change of acceleration that a quadrotor is asked for at most, m/s³: plans step from one acceleration to the next, a
/// quadrotor has to tilt in between, some 3 rad/s at this.
const SHARPEST_JERK_MPS3: f64 = 30.0;

/// An acceleration inside the vehicle's limits: no larger than it can be, and none that leads beyond the largest speed
/// within a step.
///
/// - `speed_mps`: velocity as measured; in wind that through the air is not known to the vehicle
pub(super) fn limited_mps2(
    wanted_mps2: &Vector3<f64>,
    velocity_mps: &Vector3<f64>,
    limits: &Limits,
    step_s: f64,
) -> Vector3<f64> {
    let most_mps2 = limits.acceleration_mps2 * INSIDE;
    let cut = wanted_mps2 * (most_mps2 / wanted_mps2.norm().max(most_mps2));
    let next_mps = velocity_mps + cut * step_s;
    let most_mps = limits.speed_mps.max(velocity_mps.norm());
    if next_mps.norm() <= most_mps {
        return cut;
    }
    let held = (next_mps * (most_mps / next_mps.norm()) - velocity_mps) / step_s;
    held * (most_mps2 / held.norm().max(most_mps2))
}

/// The acceleration that a quadrotor is asked for next: towards the wanted one, no faster than it can tilt.
pub(super) fn turned_towards(last_mps2: &Vector3<f64>, wanted_mps2: &Vector3<f64>, step_s: f64) -> Vector3<f64> {
    let (change, most) = (wanted_mps2 - last_mps2, SHARPEST_JERK_MPS3 * step_s);
    last_mps2 + change * (most / change.norm().max(most))
}

/// Turns accelerations into thrusts: the quadrotor's inner loop.
#[derive(Clone, Debug)]
pub(super) struct Autopilot {
    mass_kg: f64,
    airframe: Airframe,
}

impl Autopilot {
    /// Of a quadrotor. Panics without an airframe: validation has seen to that.
    pub fn new(model: &Model) -> Self {
        let airframe = model.airframe.clone().expect("a quadrotor has an airframe");
        Self { mass_kg: model.mass_kg, airframe }
    }

    pub fn airframe(&self) -> &Airframe {
        &self.airframe
    }

    pub fn rotors(&self) -> Rotors {
        Rotors { arm_m: self.airframe.arm_m, torque_per_thrust_m: self.airframe.torque_per_thrust_m }
    }

    /// Thrust of each rotor that hovers, N.
    pub fn hover_n(&self) -> Vector4<f64> {
        Vector4::repeat(self.mass_kg * GRAVITY_MPS2 / 4.0)
    }

    /// Thrusts, N, asked for and inside the rotors' limits.
    ///
    /// - `wanted_mps2`: acceleration that is asked for
    /// - `limited_mps2`: what of it is inside the vehicle's limits
    pub fn thrusts_n(
        &self,
        turning: &AttitudeState,
        wanted_mps2: &Vector3<f64>,
        limited_mps2: &Vector3<f64>,
    ) -> [Vector4<f64>; 2] {
        let (rotors, limits) = (self.rotors(), self.airframe.thrust_n);
        let wanted = self.wrench(turning, wanted_mps2);
        let command_n = allocation::unlimited(&rotors, wanted.0, &wanted.1);
        if wanted_mps2 == limited_mps2 && command_n.iter().all(|thrust| limits.contains(*thrust)) {
            return [command_n; 2];
        }
        let inside = self.wrench(turning, limited_mps2);
        [command_n, allocation::limited(&rotors, inside.0, &inside.1, limits)]
    }

    /// Total thrust, N, and torque, N m, for an acceleration: the thrust axis turns towards the force by the shortest way,
    /// the nose slowly back to the east.
    fn wrench(&self, turning: &AttitudeState, acceleration_mps2: &Vector3<f64>) -> (f64, Vector3<f64>) {
        let force_n = (acceleration_mps2 + Vector3::z() * GRAVITY_MPS2) * self.mass_kg;
        let axis = turning.attitude * Vector3::z();
        let tilt = UnitQuaternion::rotation_between(&axis, &force_n).unwrap_or_else(UnitQuaternion::identity);
        let (_, _, yaw) = turning.attitude.euler_angles();
        let rate_radps = Vector3::z() * (-YAW_RATE_PER_RAD * yaw);
        let wanted = AttitudeState { attitude: tilt * turning.attitude, rate_radps };
        let torque_nm = torque_nm(turning, &wanted, &Vector3::zeros(), &self.airframe.inertia_kgm2.into());
        (force_n.dot(&axis), torque_nm)
    }
}

/// The attitude whose thrust axis points along `force`, by the shortest way from level; level without a force.
pub(super) fn upright_towards(force: &Vector3<f64>) -> UnitQuaternion<f64> {
    UnitQuaternion::rotation_between(&Vector3::z(), force).unwrap_or_else(UnitQuaternion::identity)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_acceleration_is_cut_at_its_limit_and_at_the_largest_speed() {
        let limits = Limits { speed_mps: 3.0, acceleration_mps2: 2.0 };
        let cut = |a: [f64; 3], v: [f64; 3]| limited_mps2(&a.into(), &v.into(), &limits, 0.01);
        assert_eq!(cut([1.0, 1.0, 0.0], [0.0; 3]), Vector3::new(1.0, 1.0, 0.0));
        assert!((cut([30.0, 40.0, 0.0], [0.0; 3]) - Vector3::new(1.2, 1.6, 0.0) * INSIDE).norm() < 1e-12);
        // At full speed nothing speeds up, turning is free, and braking is.
        assert!(cut([2.0, 0.0, 0.0], [3.0, 0.0, 0.0]).norm() < 1e-9);
        let turned = cut([0.0, 2.0, 0.0], [3.0, 0.0, 0.0]);
        assert!((Vector3::new(3.0, 0.0, 0.0) + turned * 0.01).norm() <= 3.0 + 1e-12 && turned.y > 1.9);
        let hardest = [-2.0 * INSIDE, 0.0, 0.0];
        assert_eq!(cut(hardest, [3.0, 0.0, 0.0]), Vector3::from(hardest));
    }
}
