//! Flies plans: plants on rapier bodies, tracking control, wind, sensors, the flight log.
//!
//! ```text
//! Plan -> reference -> tracker -> controls -> forces -> rapier -> truth -> sensors -> tracker
//! ```
//!
//! The plants are written from physics and share no code with the planners' models. Only `rapier_world` knows rapier.

mod air;
mod collision;
pub mod fixed_wing;
mod flight;
mod fly;
mod in_loop;
pub mod multirotor;
mod quadrotor;
mod rapier_world;
mod runge_kutta;
mod saturation;
mod sensors;
pub mod slung_load;
mod start;
mod state_hash;

pub use flight::{Actuation, Commanded, Event, EventKind, Flight, LoadSample, Sample, VehicleLog};
pub use fly::{ControlMode, FlightOptions, fly, fly_in_loop, fly_with};
pub use in_loop::{PlanningLog, Replan};
pub use state_hash::StateHash;
