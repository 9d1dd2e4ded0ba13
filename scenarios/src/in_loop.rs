//! In-loop planning: the interface between a planner that replans while its vehicle flies, and the simulator.
//!
//! ```text
//! t                    the vehicle measures, and the planner is called with an Observation
//! t + planning time    the ReplanResult is available
//! t + deadline         a result in time takes effect; a late one takes effect when it is available
//! ```
//!
//! Planners implement [`InLoopPlanner`]; the simulator calls it. Neither side depends on the other.
//!
//! # Examples
//!
//! ```
//! use scenarios::in_loop::{InLoopPlanner, Node, Observation, ReplanResult, ReplanStatus};
//! use scenarios::{Map, Range, World};
//!
//! /// Flies to a point and stops there 5 s later, without regard to obstacles.
//! struct Straight([f64; 3]);
//!
//! impl InLoopPlanner for Straight {
//!     fn replan(&mut self, observation: &Observation<'_>) -> ReplanResult {
//!         let begin_s = observation.takes_effect_s;
//!         let begin = Node::at_rest(begin_s, observation.position_m);
//!         ReplanResult::fly(vec![begin, Node::at_rest(begin_s + 5.0, self.0)])
//!     }
//! }
//!
//! let axis = Range::new(0.0, 20.0);
//! let observation = Observation {
//!     t_s: 1.0,
//!     takes_effect_s: 1.1,
//!     position_m: [1.0, 1.0, 2.0],
//!     velocity_mps: [0.0; 3],
//!     acceleration_mps2: [0.0; 3],
//!     world_from_body: [0.0, 0.0, 0.0, 1.0],
//!     in_force: &[],
//!     last: &ReplanStatus::None,
//!     known: &World::empty(Map { x_m: axis, y_m: axis, z_m: axis }),
//!     discovered: &[],
//!     moving: &[],
//!     neighbours: &[],
//! };
//! let result = Straight([9.0, 1.0, 2.0]).replan(&observation);
//! assert_eq!(result, ReplanResult::fly(vec![
//!     Node::at_rest(1.1, [1.0, 1.0, 2.0]),
//!     Node::at_rest(6.1, [9.0, 1.0, 2.0]),
//! ]));
//! ```

use serde::{Deserialize, Serialize};

use crate::{Range, World};

/// A planner for one vehicle that replans during the flight.
pub trait InLoopPlanner: Send {
    /// Plans from `observation.takes_effect_s` on, with what is known now.
    ///
    /// The same observations in the same order must give the same results: a planner does not read a clock, and draws random
    /// numbers only from the seed that it was created with.
    fn replan(&mut self, observation: &Observation<'_>) -> ReplanResult;

    /// Ends the planning: called once, after the last call of [`replan`](Self::replan). Returns what is to be said of the
    /// planner beyond its results.
    fn finish(&mut self) -> PlannerRemarks {
        PlannerRemarks::default()
    }
}

/// What is to be said of a planner beyond its results, once the flight is over.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PlannerRemarks {
    /// What is told, one sentence each, and does not decide.
    pub notes: Vec<String>,
    /// Why its results cannot be trusted, if they cannot.
    pub failure: Option<String>,
}

/// What a vehicle knows at one instant. World frame.
#[derive(Clone, Copy, Debug)]
pub struct Observation<'a> {
    /// Time of the measurement, s.
    pub t_s: f64,
    /// Time at which a result in time takes effect, s: plan from the state at that time.
    pub takes_effect_s: f64,
    /// Own position as measured, m.
    pub position_m: [f64; 3],
    /// Own velocity as measured, m/s.
    pub velocity_mps: [f64; 3],
    /// Acceleration that its controller commanded for the previous step, m/s²; gravity is compensated.
    pub acceleration_mps2: [f64; 3],
    /// Own attitude as measured, as a unit quaternion (x, y, z, w), world from body (x forward, y left, z up). That of a
    /// point mass points its thrust.
    pub world_from_body: [f64; 4],
    /// The reference being flown, from `t_s` or before to its end, after which the vehicle hovers.
    pub in_force: &'a [Node],
    /// Status of the previous result.
    pub last: &'a ReplanStatus,
    /// The map, and the static obstacles known so far.
    pub known: &'a World,
    /// Names of the obstacles that were added to `known` since the previous observation.
    pub discovered: &'a [String],
    /// Moving obstacles within sensor range.
    pub moving: &'a [ObstacleMeasurement],
    /// Other vehicles within sensor range.
    pub neighbours: &'a [Neighbour],
}

/// A node of a reference. Between two nodes the reference is the cubic with their positions and velocities.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Node {
    /// Time since the flight began, s.
    pub t_s: f64,
    /// Position, m.
    pub position_m: [f64; 3],
    /// Velocity, m/s.
    pub velocity_mps: [f64; 3],
}

impl Node {
    /// A node at rest at a position, m.
    pub fn at_rest(t_s: f64, position_m: [f64; 3]) -> Self {
        Self { t_s, position_m, velocity_mps: [0.0; 3] }
    }
}

/// A measurement of a moving obstacle, an upright cylinder.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ObstacleMeasurement {
    /// Its name.
    pub name: String,
    /// Radius, m.
    pub radius_m: f64,
    /// Lowest and highest altitude, m. Absent: unbounded.
    pub z_m: Option<Range>,
    /// Axis as measured, (x, y) in m.
    pub position_m: [f64; 2],
    /// Velocity as measured, m/s.
    pub velocity_mps: [f64; 2],
}

/// A measurement of another vehicle.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Neighbour {
    /// Its name.
    pub name: String,
    /// Radius of the sphere that encloses it, m.
    pub body_radius_m: f64,
    /// Position as measured, m.
    pub position_m: [f64; 3],
    /// Velocity as measured, m/s.
    pub velocity_mps: [f64; 3],
    /// Its accepted reference if the fleet shares plans; otherwise empty.
    pub plan: Vec<Node>,
}

/// Status of the previous result of a planner.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(tag = "what", rename_all = "kebab-case")]
pub enum ReplanStatus {
    /// There was no previous result.
    #[default]
    None,
    /// In time.
    InTime,
    /// Late; its reference was entered after its beginning.
    Late {
        /// Delay, s.
        by_s: f64,
    },
    /// The planner kept the reference in force.
    Kept {
        /// The reason.
        reason: String,
    },
    /// The result could not be flown; the reference in force was kept.
    Rejected {
        /// The reason.
        reason: String,
    },
    /// The planner gave no result that can be used; the reference in force was kept.
    Failed {
        /// The reason.
        reason: String,
    },
}

impl ReplanStatus {
    /// Whether the reference was flown, in time or late.
    pub fn is_flown(&self) -> bool {
        matches!(self, Self::InTime | Self::Late { .. })
    }
}

/// The result of replanning for one observation.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ReplanResult {
    /// What to fly.
    pub decision: Decision,
    /// Diagnostics of the search.
    #[serde(rename = "account")]
    pub diagnostics: ReplanDiagnostics,
}

/// What to fly from now on.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum Decision {
    /// A new reference: at least two nodes with finite numbers and increasing times, the first not after the time at which
    /// the result takes effect. It continues the reference in force or the measured state, within the limits of the vehicle.
    /// After the last node the vehicle hovers there.
    Fly(Vec<Node>),
    /// Keep flying the reference in force to its end.
    Keep {
        /// The reason.
        reason: String,
    },
    /// The planner gave no result that can be used: it crashed, fell silent, or replied something else.
    Failed {
        /// The reason.
        reason: String,
    },
}

/// Diagnostics of one replanning; planners leave out what they do not have.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct ReplanDiagnostics {
    /// Number of iterations or samples.
    pub iterations: usize,
    /// First iteration with a feasible candidate.
    pub first_feasible: Option<usize>,
    /// Fraction of feasible candidates at the end, in [0, 1].
    #[serde(rename = "feasible_share")]
    pub feasible_fraction: Option<f64>,
    /// Cost of the result, in the planner's unit.
    pub cost: Option<f64>,
    /// Lowest cost after every iteration, in the planner's unit; absent while there is no feasible candidate.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub convergence: Vec<Option<f64>>,
    /// Paths of some of the best candidates, m.
    pub candidates: Vec<Vec<[f64; 3]>>,
    /// Path from the end of the reference to the goal, m.
    pub route: Vec<[f64; 3]>,
    /// Edges of the cost map, m, if it was rebuilt.
    pub graph: Option<Vec<[[f64; 3]; 2]>>,
    /// Anything else, as text.
    pub note: Option<String>,
}

impl ReplanResult {
    /// To fly through `nodes`.
    pub fn fly(nodes: Vec<Node>) -> Self {
        Self { decision: Decision::Fly(nodes), diagnostics: ReplanDiagnostics::default() }
    }

    /// No result that can be used.
    pub fn failed(reason: impl Into<String>) -> Self {
        Self { decision: Decision::Failed { reason: reason.into() }, diagnostics: ReplanDiagnostics::default() }
    }

    /// To keep the reference in force.
    pub fn keep(reason: impl Into<String>) -> Self {
        Self { decision: Decision::Keep { reason: reason.into() }, diagnostics: ReplanDiagnostics::default() }
    }
}
