use nalgebra::{UnitQuaternion, Vector3};

use crate::kinematics::AttitudeState;
use crate::sensors::Measurement;

/// True state of a multirotor.
#[derive(Clone, Copy, Debug)]
pub(super) struct MultirotorState {
    /// Position in the world frame, m.
    pub position_m: Vector3<f64>,
    /// Velocity over ground in the world frame, m/s.
    pub velocity_mps: Vector3<f64>,
    /// Attitude of a quadrotor; that of a point mass has no meaning.
    pub attitude_state: AttitudeState,
}

/// What the controller of a multirotor knows of its motion.
#[derive(Clone, Copy, Debug)]
pub(super) struct NavigationState {
    /// Position and velocity.
    pub measured: Measurement,
    /// Acceleration that was commanded for the previous step, m/s².
    pub acceleration_mps2: Vector3<f64>,
    /// Attitude as it was measured for the previous step; that of a point mass points its thrust.
    pub world_from_body: UnitQuaternion<f64>,
}
