//! The question that a planner is asked, and the form of its answer.
//!
//! A [`Scenario`] holds the world, the vehicles, the fleet's rules, the disturbances and the limits that a verdict
//! applies. A [`Plan`] is what a planner hands back. Nothing here knows how plans are made or flown.
//!
//! Frames and units: the world frame is ENU (x east, y north, z up, REP 103); SI and radians everywhere, except that
//! scenario files give angles in degrees, in fields whose names say so.

mod checks;
mod closest_name;
mod families;
mod find;
pub mod fixed_wing;
mod fleet;
pub mod in_loop;
mod issue;
mod load;
pub mod multirotor;
mod plan;
mod plan_file;
pub mod plan_input;
mod planner_settings;
mod random;
mod range;
mod scenario;
mod simulation;
pub mod slung_load;
mod trajectory;
mod validate;
mod vehicle;
mod verdict_limits;
mod world;

pub use checks::{CHECKS, CheckSpec, Group, LimitField, check_names, check_spec, checks_of};
pub use closest_name::closest_name;
pub use families::{Family, Models, Trajectory, VehicleModel};
pub use find::{FindError, find};
pub use fleet::FleetRules;
pub use issue::Issue;
pub use load::{InvalidScenario, LoadError, LocatedIssue, ScenarioFile, load, parse};
pub use plan::{Alternative, Iteration, Plan, PlanDiagnostics, PlanStatus, PlanTimings, PlannedEvent};
pub use planner_settings::{
    Collocation, Convergence, CostMap, Formulation, Horizon, Objective, PlannerSettings, PotentialField,
    PotentialFieldForm, RepulsionForm, Sampler, Shape, Solver, Transcription, TrustRegion,
};
pub use random::stream;
pub use range::Range;
pub use scenario::Scenario;
pub use simulation::{GustPulse, Gusts, Mismatch, Planning, PlanningClock, Sensors, Simulation, Tracker, Wind};
pub use trajectory::{Interpolation, TrajectoryNodes};
pub use validate::validate;
pub use vehicle::{LoadPoint, Vehicle, Waypoint};
pub use verdict_limits::{AppliedLimits, VerdictLimits};
pub use world::{BoxObstacle, Cylinder, Gate, Map, MovingCylinder, Prism, Window, World};

/// Gravity, m/s², as all four papers take it.
pub const GRAVITY_MPS2: f64 = 9.81;
