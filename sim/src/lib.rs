//! Flies plans: plants on rapier bodies, tracking control, wind, sensors, the flight log.
//!
//! ```text
//! Plan -> reference -> tracker -> load factors -> force -> rapier -> truth -> sensors -> tracker
//! ```
//!
//! The plants are written from physics and share no code with the planners' models. Only `rapier_world` knows rapier.

mod air;
mod aircraft;
pub mod fixed_wing;
mod flight;
mod fly;
mod rapier_world;
mod saturation;
mod sensors;
mod touch;
mod tracker;

pub use flight::{Event, EventKind, Flight, Sample, VehicleLog};
pub use fly::{Pilot, Setup, fly, fly_with};
