//! Trajectory optimisation for a quadrotor with a load on a cable that can go slack (Kang, Huang, Wen 2020; dynamics
//! after Foehn et al. 2017).

mod attitude;
mod cable;
mod cost;
mod envelope;
mod gate;
mod guess;
mod initial_iterate;
mod jet;
mod multiphase;
mod obstacle_rows;
mod optimise;
mod parts;
mod path_constraints;
mod planner;
mod polygon;
mod prism_distance;
mod problem;
mod problem_builder;
mod r_function;
mod rotation;
mod route;
mod smooth_envelope;
mod solution;
mod system;
mod tension_derivatives;
mod terminal_constraints;
mod translation;

#[cfg(test)]
mod derivative_tests;
#[cfg(test)]
mod transcription_tests;

pub use envelope::{Envelope, envelope};
pub use guess::Guess;
pub(crate) use jet::Jet;
pub use optimise::{Candidate, MeshIteration, Options, optimise};
pub use planner::{PLANNER, candidate_routes, route_name};
pub use polygon::Polygon;
pub use problem::{
    Avoidance, CableMode, Gate, InitialCondition, Limits, Phase, Problem, TorqueModel, VehicleParameters, Weights,
};
pub use problem_builder::{options, problem};
pub use route::{Route, routes};
pub use system::SlungLoadSystem;

use crate::planner::Planner;

/// The planners of this family.
pub(crate) const PLANNERS: &[Planner] = &[PLANNER];
