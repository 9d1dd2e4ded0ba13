//! Planning in the loop: who is asked when, what he is told, and when his answer is flown.

mod acceptance;
mod planning_time;
mod reference_manager;
mod sensed_world;

use scenarios::in_loop::{Node, ReplanDiagnostics, ReplanStatus};
use scenarios::multirotor::Trajectory;

pub(crate) use reference_manager::{NavigationInput, ReferenceManager};
pub(crate) use sensed_world::{Other, SensedWorld};

/// Everything that was planned during a flight.
#[derive(Clone, Debug, PartialEq)]
pub struct PlanningLog {
    /// Every answer, in the order in which they were asked for.
    pub replans: Vec<Replan>,
    /// What each vehicle was given to fly, from the beginning to its arrival or to the flight's end.
    pub followed: Vec<Trajectory>,
}

/// One answer of a planner.
#[derive(Clone, Debug, PartialEq)]
pub struct Replan {
    /// Index of the vehicle.
    pub vehicle: usize,
    /// When the planner was asked, s.
    pub asked_s: f64,
    /// When its answer was there, in the simulation, s.
    pub ready_s: f64,
    /// When its answer began to be flown, s: at the simulator's first step that is not before.
    pub takes_effect_s: f64,
    /// What became of it.
    pub outcome: ReplanStatus,
    /// The reference that it gave, if it is flown.
    pub nodes: Vec<Node>,
    /// How it was found.
    pub diagnostics: ReplanDiagnostics,
    /// What the vehicle had sensed that was new, by name.
    pub discovered: Vec<String>,
    /// Time that the planner took on the machine at hand, s.
    pub wall_s: f64,
}
