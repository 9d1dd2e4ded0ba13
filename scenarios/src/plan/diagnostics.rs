use serde::{Deserialize, Serialize};

use super::PlanStatus;

/// What a planner tells beyond its trajectories.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct PlanDiagnostics {
    /// What the plan foresees, in time.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub events: Vec<PlannedEvent>,
    /// Ways that were tried and not taken.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub alternatives: Vec<Alternative>,
}

impl PlanDiagnostics {
    /// Is there nothing to tell?
    pub fn is_empty(&self) -> bool {
        self.events.is_empty() && self.alternatives.is_empty()
    }
}

/// An instant that a plan foresees.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PlannedEvent {
    /// When, s.
    pub at_s: f64,
    /// What, for a person to read.
    pub what: String,
}

/// A way that was tried and not taken.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Alternative {
    /// Which way, for a person to read.
    pub name: String,
    /// What the planner says of it.
    pub status: PlanStatus,
    /// Value of the planner's objective.
    pub objective: Option<f64>,
    /// The vehicle's path, m.
    pub path_m: Vec<[f64; 3]>,
}
