//! The fixed-wing point mass from physics: forces along the axes of the air path, Newton's law in the world frame.
//!
//! The model is written in Cartesian coordinates, where the papers use polar ones (Wang, Xu, Long 2020, eq. 2). The two
//! describe the same motion, but share no formula, so that an error in one is not repeated in the other.

mod air_path;
mod aircraft;
mod aircraft_batch;
mod attitude;
mod collisions;
mod fleet;
mod plant;
mod propagate;
mod quintic;
mod reference;
mod replay;
mod tracker;

pub use air_path::{AirPath, acceleration_mps2, gravity_mps2};
pub use attitude::world_from_body;
pub(crate) use fleet::simulate;
pub use propagate::{Knot, propagate, rollout};
pub use reference::{Reference, ReferencePoint};
pub use replay::{AppliedControls, Replay};
