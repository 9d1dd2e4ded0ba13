//! Multirotors: a point mass that accelerates as commanded, or a quadrotor that has to tilt first, on rapier bodies; a
//! tracker that follows a reference from measurements; the obstacles around them, moving ones included; and planning in
//! the loop.

mod arrival;
mod fleet;
mod in_loop;
mod multirotor_sim;
mod recorded;
mod reference;
mod replay;
mod simulate;
mod state;
mod tracker;

pub use reference::{Reference, ReferencePoint};
pub use replay::{AppliedControls, Replay};
pub(crate) use simulate::simulate;
