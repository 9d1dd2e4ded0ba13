//! Planning in the loop: the seam between a planner that is asked again and again while its vehicle flies, and whoever
//! flies the vehicle.
//!
//! ```text
//! t                    the vehicle measures, the planner is asked: Observation
//! t + planning time    its ReplanResult is there
//! t + deadline         an answer in time begins to be flown here, a late one when it is there
//! ```
//!
//! Neither side sees the other. Planners implement [`InLoopPlanner`]; the simulator calls it.

use serde::{Deserialize, Serialize};

use crate::{Range, World};

/// A planner for one vehicle, asked again and again while it flies.
pub trait InLoopPlanner: Send {
    /// Answers what is known at one instant with where to fly from the next one on.
    ///
    /// The same observations in the same order give the same answers: a planner reads no clock, and draws random numbers
    /// from the seed alone that it was made with.
    fn replan(&mut self, observation: &Observation<'_>) -> ReplanResult;
}

/// What a vehicle knows at one instant. World frame.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Observation<'a> {
    /// Time of the measurement, s.
    pub t_s: f64,
    /// When an answer in time begins to be flown, s: plan from the state then.
    pub takes_effect_s: f64,
    /// Own position as measured, m.
    pub position_m: [f64; 3],
    /// Own velocity as measured, m/s.
    pub velocity_mps: [f64; 3],
    /// The reference that is flown now: from `t_s` or before to its end, after which the vehicle stands.
    pub in_force: &'a [Node],
    /// What became of the last answer.
    pub last: &'a ReplanStatus,
    /// Map, and every obstacle known so far that does not move.
    pub known: &'a World,
    /// Names of the obstacles in `known` that were not yet there at the last observation.
    pub discovered: &'a [String],
    /// MovingCylinder obstacles within sensor range.
    pub moving: &'a [ObstacleMeasurement],
    /// Other vehicles within sensor range.
    pub neighbours: &'a [Neighbour],
}

/// A point of a reference. Between two of them it is the cubic with their positions and velocities.
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
    /// Standing at a position, m.
    pub fn at_rest(t_s: f64, position_m: [f64; 3]) -> Self {
        Self { t_s, position_m, velocity_mps: [0.0; 3] }
    }
}

/// A moving obstacle as it is seen: an upright cylinder.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ObstacleMeasurement {
    /// Its name.
    pub name: String,
    /// Radius, m.
    pub radius_m: f64,
    /// Lowest and highest altitude, m. Absent: without bottom or top.
    pub z_m: Option<Range>,
    /// Axis as measured, (x, y) in m.
    pub position_m: [f64; 2],
    /// Velocity as measured, m/s.
    pub velocity_mps: [f64; 2],
}

/// Another vehicle as it is seen.
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
    /// The last reference that it accepted, if the fleet shares its plans; else empty.
    pub plan: Vec<Node>,
}

/// What became of a planner's last answer.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(tag = "what", rename_all = "kebab-case")]
pub enum ReplanStatus {
    /// There was none.
    #[default]
    None,
    /// It was in time.
    InTime,
    /// It came too late, and was joined in its middle.
    Late {
        /// By how much, s.
        by_s: f64,
    },
    /// It said to keep the reference in force, for this reason.
    Kept {
        /// Why.
        reason: String,
    },
    /// It could not be flown, for this reason; the reference in force was flown on.
    Rejected {
        /// Why.
        reason: String,
    },
}

/// A planner's answer to one observation.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ReplanResult {
    /// What to fly.
    pub decision: Decision,
    /// How it was found.
    #[serde(rename = "account")]
    pub diagnostics: ReplanDiagnostics,
}

/// What to fly from now on.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum Decision {
    /// A new reference: two nodes or more, times increasing, the first not after the instant at which it takes effect, all
    /// numbers finite. After its last node the vehicle stands there.
    Fly(Vec<Node>),
    /// Nothing better was found: the reference in force is flown to its end.
    Keep {
        /// Why.
        reason: String,
    },
}

/// How an answer was found, as far as the planner cares to tell.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct ReplanDiagnostics {
    /// Iterations, or samples drawn.
    pub iterations: usize,
    /// The first iteration with a feasible candidate.
    pub first_feasible: Option<usize>,
    /// Share of feasible candidates at the end, in [0, 1].
    #[serde(rename = "feasible_share")]
    pub feasible_fraction: Option<f64>,
    /// Cost of the answer, in the planner's unit.
    pub cost: Option<f64>,
    /// Paths of the best candidates, m: a few.
    pub candidates: Vec<Vec<[f64; 3]>>,
    /// Way from the reference's end to the goal, m.
    pub route: Vec<[f64; 3]>,
    /// Edges of the cost map, m, when it was rebuilt.
    pub graph: Option<Vec<[[f64; 3]; 2]>>,
    /// Anything else worth a line.
    pub note: Option<String>,
}

impl ReplanResult {
    /// To fly through these nodes.
    pub fn fly(nodes: Vec<Node>) -> Self {
        Self { decision: Decision::Fly(nodes), diagnostics: ReplanDiagnostics::default() }
    }

    /// To fly on as before.
    pub fn keep(reason: impl Into<String>) -> Self {
        Self { decision: Decision::Keep { reason: reason.into() }, diagnostics: ReplanDiagnostics::default() }
    }
}
