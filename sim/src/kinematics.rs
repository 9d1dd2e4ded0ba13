//! Position, attitude and their rates of one body.

use nalgebra::{UnitQuaternion, Vector3};

/// Position, m, and velocity, m/s, of a body's centre of mass, world frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct PointState {
    pub position_m: Vector3<f64>,
    pub velocity_mps: Vector3<f64>,
}

/// Attitude and angular velocity of a rigid body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct AttitudeState {
    /// World from body.
    pub attitude: UnitQuaternion<f64>,
    /// Angular velocity in body axes, rad/s.
    pub rate_radps: Vector3<f64>,
}

impl AttitudeState {
    /// Level, at rest.
    pub fn level() -> Self {
        Self { attitude: UnitQuaternion::identity(), rate_radps: Vector3::zeros() }
    }
}
