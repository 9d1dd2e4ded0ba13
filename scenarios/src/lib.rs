//! Scenarios and plans: the input of a planner and its output.
//!
//! A [`Scenario`] holds the world, the vehicles, the requirements between them, the disturbances and the limits of the
//! verdict. A [`Plan`] is the result of a planner. This crate depends neither on planners nor on the simulator; the
//! interface between the two during a flight is [`in_loop`].
//!
//! The world frame is ENU (x east, y north, z up, REP 103). Units are SI and radians, except for fields of scenario files
//! whose names end in `_deg` or `_degps`.

mod checks;
mod closest_name;
pub mod curve;
mod families;
mod find;
pub mod fixed_wing;
mod fleet;
pub mod geodesy;
pub mod geometry;
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
pub mod requirement;
mod scenario;
mod separation;
pub mod shipped;
mod simulation;
pub mod slung_load;
mod trajectory;
mod validate;
mod vehicle;
mod verdict_limits;
mod via_point;
mod world;

pub use checks::{CHECKS, CheckSpec, Group, LimitField, REQUIREMENT_CHECKS, check_names, check_spec, checks_of};
pub use closest_name::closest_name;
pub use families::{Family, Models, Trajectory, VehicleModel};
pub use find::{FindError, find};
pub use fleet::FleetRules;
pub use issue::Issue;
pub use load::{InvalidScenario, LoadError, LocatedIssue, ScenarioFile, load, parse};
pub use plan::{Alternative, Iteration, Plan, PlanDiagnostics, PlanStatus, PlanTimings, PlannedEvent};
pub use planner_settings::{
    AttractionAlong, Collocation, Convergence, Coordination, CostMap, Formulation, Horizon, Objective, PathTiming,
    PlannerSettings, PotentialField, PotentialFieldForm, RepelledBy, RepulsionForm, Sampler, Search, Shape, Solver,
    SolverStart, Swarm, Torques, Transcription, TrustRegion, ViolationWeights,
};
pub use random::stream;
pub use range::Range;
pub use scenario::Scenario;
pub use separation::{Separation, SeparationMeasure, SeparationShape, SeparationVolume};
pub use simulation::{GustPulse, Gusts, Mismatch, Planning, PlanningClock, Sensors, Simulation, Tracker, Wind};
pub use trajectory::{Interpolation, TrajectoryNodes};
pub use validate::{validate, wind_without_effect};
pub use vehicle::{LoadPoint, Vehicle, Waypoint};
pub use verdict_limits::{AppliedLimits, VerdictLimits};
pub use via_point::ViaPoint;
pub use world::{
    BoxObstacle, Capsule, Cuboid, Cylinder, Gate, Geofence, GeofenceKind, Map, Mesh, MovingCylinder, Origin, Prism,
    Sphere, Terrain, Window, World,
};

/// Gravitational acceleration, m/s², as in all four papers.
pub const GRAVITY_MPS2: f64 = 9.81;
