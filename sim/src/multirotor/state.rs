use nalgebra::Vector3;

use crate::kinematics::AttitudeState;

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
