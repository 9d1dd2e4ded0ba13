//! Four rotors on a rigid body: what every quadrotor has, with or without a load.

pub(crate) mod allocation;
mod attitude;
mod rotors;

pub(crate) use attitude::torque_nm;
pub(crate) use rotors::{LaggedRotors, RotorGeometry, mid_step_wrench};
