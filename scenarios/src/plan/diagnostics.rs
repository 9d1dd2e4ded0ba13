use serde::{Deserialize, Serialize};

use super::PlanStatus;

/// What a planner reports beyond its trajectories.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct PlanDiagnostics {
    /// Planned events, in the order of time.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub events: Vec<PlannedEvent>,
    /// Alternatives that were evaluated and not chosen.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub alternatives: Vec<Alternative>,
}

impl PlanDiagnostics {
    /// Whether there are no events and no alternatives.
    pub fn is_empty(&self) -> bool {
        self.events.is_empty() && self.alternatives.is_empty()
    }
}

/// A planned event, such as the release of a load.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PlannedEvent {
    /// Time, s.
    pub at_s: f64,
    /// Description.
    pub what: String,
}

/// An alternative that was evaluated and not chosen.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Alternative {
    /// Description.
    pub name: String,
    /// Status reported by the planner.
    pub status: PlanStatus,
    /// Value of the planner's objective.
    pub objective: Option<f64>,
    /// Path of the vehicle, m.
    pub path_m: Vec<[f64; 3]>,
}
