use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// How the vehicles of the papers' fleet planners agree on priorities and on a common arrival. Xu et al. (2022) give no
/// values for these thresholds; the defaults are ours.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Coordination {
    /// Difference of two flight times beyond which two vehicles swap priorities, s (eq. 17).
    #[serde(skip_serializing_if = "Option::is_none")]
    pub swap_threshold_s: Option<f64>,
    /// Largest change of a step length since the last iteration with which it counts for the common lower bound, s (eq. 18).
    #[serde(skip_serializing_if = "Option::is_none")]
    pub damped_change_s: Option<f64>,
    /// Largest spread of the flight times of a fleet that arrives together, s (eq. 19).
    #[serde(skip_serializing_if = "Option::is_none")]
    pub arrival_spread_s: Option<f64>,
    /// Maximum number of rounds over the fleet of a planner that plans one vehicle after the other.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub max_rounds: Option<usize>,
}
