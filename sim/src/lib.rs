//! Flies plans: plants on rapier bodies, tracking control, wind, sensors, the flight log.
//!
//! ```text
//! Plan -> reference -> tracker -> controls -> forces -> rapier -> truth -> sensors -> tracker
//! ```
//!
//! The plants are written from physics and share no code with the planners' models. Only `rapier_world` knows rapier,
//! and only `families` lists the vehicle families. [`fly`] is the entry point.

mod actuation;
mod air;
mod collision;
mod families;
pub mod fixed_wing;
mod flight;
mod fly;
mod kinematics;
pub mod multirotor;
mod obstacles;
mod planning_log;
mod plant_steps;
mod quadrotor;
mod rapier_world;
mod request;
mod runge_kutta;
mod saturation;
mod sensors;
pub mod slung_load;
mod start;
mod state_hash;

pub use actuation::{Actuation, Commanded};
pub use air::LoggedAir;
pub use collision::GROUND;
pub use flight::{Event, EventKind, Flight, LoadSample, Sample, VehicleLog};
pub use fly::{fly, fly_with};
pub use obstacles::Obstacles;
pub use planning_log::{PlanningLog, Replan};
pub use request::{ControlMode, FlightOptions, ReferenceSource};
pub use state_hash::StateHash;
