use nalgebra::{Quaternion, SVector, UnitQuaternion, Vector3};
use scenarios::slung_load::State;

use crate::kinematics::{AttitudeState, PointState};
use crate::sensors::Sensors;

/// State of quadrotor and load: the plan's [`State`] with the attitude as a rotation. World frame ENU; body axes x
/// forward, y left, z up.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SlungLoadState {
    /// Position of the quadrotor, m.
    pub position_m: Vector3<f64>,
    /// Velocity of the quadrotor, m/s.
    pub velocity_mps: Vector3<f64>,
    /// World from body.
    pub attitude: UnitQuaternion<f64>,
    /// Angular velocity in body axes, rad/s.
    pub body_rate_radps: Vector3<f64>,
    /// Position of the load, m.
    pub load_position_m: Vector3<f64>,
    /// Velocity of the load, m/s.
    pub load_velocity_mps: Vector3<f64>,
}

/// The numbers of a [`SlungLoadState`] in the order of its fields, the quaternion as (x, y, z, w).
pub(super) type Numbers = SVector<f64, 19>;

impl SlungLoadState {
    /// Thrust direction, the body's z axis, world frame.
    pub fn thrust_axis(&self) -> Vector3<f64> {
        self.attitude * Vector3::z()
    }

    /// From the quadrotor to the load, m.
    pub fn cable_m(&self) -> Vector3<f64> {
        self.load_position_m - self.position_m
    }

    /// Velocity of the load relative to the quadrotor, m/s.
    pub fn load_relative_mps(&self) -> Vector3<f64> {
        self.load_velocity_mps - self.velocity_mps
    }

    /// Cable angles α and β, rad: relative to the quadrotor the load is at ρ (-cos α sin β, sin α, -cos α cos β).
    pub fn cable_angles_rad(&self) -> [f64; 2] {
        let d = self.cable_m().normalize();
        [d.y.clamp(-1.0, 1.0).asin(), (-d.x).atan2(-d.z)]
    }

    /// Position and velocity of the quadrotor.
    pub(super) fn quadrotor(&self) -> PointState {
        PointState { position_m: self.position_m, velocity_mps: self.velocity_mps }
    }

    /// Attitude and angular velocity of the quadrotor.
    pub(super) fn attitude_state(&self) -> AttitudeState {
        AttitudeState { attitude: self.attitude, rate_radps: self.body_rate_radps }
    }

    /// The state as the sensors measure it.
    pub(super) fn measured_by(&self, sensors: &mut Sensors) -> Self {
        let quadrotor = sensors.measure(self.position_m, self.velocity_mps);
        let AttitudeState { attitude, rate_radps } = sensors.measure_attitude(&self.attitude_state());
        let load = sensors.measure_load(self.load_position_m, self.load_velocity_mps);
        Self {
            position_m: quadrotor.position_m,
            velocity_mps: quadrotor.velocity_mps,
            attitude,
            body_rate_radps: rate_radps,
            load_position_m: load.position_m,
            load_velocity_mps: load.velocity_mps,
        }
    }

    pub(super) fn to_numbers(self) -> Numbers {
        let mut numbers = Numbers::zeros();
        numbers.fixed_rows_mut::<3>(0).copy_from(&self.position_m);
        numbers.fixed_rows_mut::<3>(3).copy_from(&self.velocity_mps);
        numbers.fixed_rows_mut::<4>(6).copy_from(&self.attitude.coords);
        numbers.fixed_rows_mut::<3>(10).copy_from(&self.body_rate_radps);
        numbers.fixed_rows_mut::<3>(13).copy_from(&self.load_position_m);
        numbers.fixed_rows_mut::<3>(16).copy_from(&self.load_velocity_mps);
        numbers
    }

    /// Inverse of [`to_numbers`](Self::to_numbers), with the quaternion normalised.
    pub(super) fn from_numbers(numbers: &Numbers) -> Self {
        let part = |first: usize| numbers.fixed_rows::<3>(first).into_owned();
        Self {
            position_m: part(0),
            velocity_mps: part(3),
            attitude: UnitQuaternion::from_quaternion(Quaternion::from(numbers.fixed_rows::<4>(6).into_owned())),
            body_rate_radps: part(10),
            load_position_m: part(13),
            load_velocity_mps: part(16),
        }
    }
}

impl From<&State> for SlungLoadState {
    fn from(state: &State) -> Self {
        let [roll, pitch, yaw] = state.roll_pitch_yaw_rad;
        Self {
            position_m: state.position_m.into(),
            velocity_mps: state.velocity_mps.into(),
            attitude: UnitQuaternion::from_euler_angles(roll, pitch, yaw),
            body_rate_radps: state.body_rate_radps.into(),
            load_position_m: state.load_position_m.into(),
            load_velocity_mps: state.load_velocity_mps.into(),
        }
    }
}

impl From<&SlungLoadState> for State {
    fn from(state: &SlungLoadState) -> Self {
        let (roll, pitch, yaw) = state.attitude.euler_angles();
        Self {
            position_m: state.position_m.into(),
            velocity_mps: state.velocity_mps.into(),
            roll_pitch_yaw_rad: [roll, pitch, yaw],
            body_rate_radps: state.body_rate_radps.into(),
            load_position_m: state.load_position_m.into(),
            load_velocity_mps: state.load_velocity_mps.into(),
        }
    }
}
