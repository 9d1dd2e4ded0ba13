//! Multirotors: a point mass that accelerates as it is told, or a quadrotor that has to tilt first, on rapier bodies; a
//! tracker that follows a reference from measurements; and the obstacles around them, those that move among them.

mod fleet;
mod multirotor_sim;
mod obstacles;
mod reference;
mod replay;
mod tracker;

pub(crate) use fleet::{fly, fly_in_loop};
pub use obstacles::Obstacles;
pub use reference::{Reference, ReferencePoint};
pub use replay::{AppliedControls, Replay};
