//! The quadrotor with a slung load, from physics: Newton's and Euler's laws in Cartesian coordinates, a cable that only
//! pulls.
//!
//! Planners write the same motion in cable angles (Kang, Huang, Wen 2020); the two share no formula.

mod body;
mod cable_watch;
mod dynamics;
mod flow;
mod fly;
mod gains;
mod linear;
mod reference;
mod replay;
mod shapes;
mod tracker;

pub use body::Body;
pub use cable_watch::SHORTEST_PHASE_S;
pub use dynamics::{Plant, impact};
pub use flow::{Knot, flow};
pub use reference::{Reference, ReferencePoint};
pub use replay::{Acting, Replay};
pub use shapes::{GROUND, OVERHANG_M, Part, Parts, Plane};

pub(crate) use fly::fly;
