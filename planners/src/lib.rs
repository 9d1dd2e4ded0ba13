//! The trajectory planners, and the solvers they stand on. Planners never see the simulator or its models.

#![expect(confusable_idents, reason = "γ is the flight-path angle and y a multiplier, as in the papers")]

pub mod convex;
pub mod free_space;
pub mod horizon;
mod lanes;
pub mod nlp;
mod planner;
pub mod pseudospectral;
mod registry;
pub mod scp;
pub mod search;
pub mod slung;

pub use planner::{Planner, Progress};
pub use registry::{find, registry};
