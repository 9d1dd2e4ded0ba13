//! The log of what was planned during a flight.

use scenarios::in_loop::{Node, PlannerRemarks, ReplanDiagnostics, ReplanStatus};
use scenarios::multirotor::Trajectory;

/// Everything that was planned in the loop during a flight.
#[derive(Clone, Debug, PartialEq)]
pub struct PlanningLog {
    /// Every call of a planner, in the order of time.
    pub replans: Vec<Replan>,
    /// The reference that each vehicle followed, from the start to its arrival or to the end of the flight.
    pub followed: Vec<Trajectory>,
    /// What is to be said of the planners beyond their results.
    pub remarks: PlannerRemarks,
}

/// One call of an in-loop planner and its result.
#[derive(Clone, Debug, PartialEq)]
pub struct Replan {
    /// Index of the vehicle.
    pub vehicle: usize,
    /// Time at which the planner was called, s.
    pub asked_s: f64,
    /// Simulated time at which its result was available, s.
    pub ready_s: f64,
    /// Time from which its result was in force, s: the simulator's first step that is not before it.
    pub takes_effect_s: f64,
    /// What became of the result.
    pub outcome: ReplanStatus,
    /// The reference that it gave, if it is flown.
    pub nodes: Vec<Node>,
    /// Diagnostics of the search.
    pub diagnostics: ReplanDiagnostics,
    /// Names of the obstacles that the vehicle had discovered since the previous call.
    pub discovered: Vec<String>,
    /// Wall time of the call on this machine, s.
    pub wall_s: f64,
}
