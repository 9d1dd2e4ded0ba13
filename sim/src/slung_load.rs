//! The quadrotor with a slung load, from physics: Newton's and Euler's laws in Cartesian coordinates, and a cable that
//! only pulls.
//!
//! The planners formulate the same dynamics in cable angles (Kang, Huang, Wen 2020); the two share no formula.

mod cable_detector;
mod dynamics;
mod gains;
mod linear;
mod propagate;
mod reference;
mod replay;
mod shapes;
mod slung_load_sim;
mod state;
mod tethered_pair;
mod tracker;

pub use cable_detector::MIN_PHASE_S;
pub use dynamics::{Plant, impact};
pub use propagate::{Knot, propagate};
pub use reference::{Reference, ReferencePoint};
pub use replay::{AppliedControls, Replay};
pub use shapes::{OVERHANG_M, Part, Parts, SeparatingPlane};
pub(crate) use slung_load_sim::simulate;
pub use state::SlungLoadState;
