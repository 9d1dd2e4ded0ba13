use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Schedule and planning times of in-loop planners.
///
/// A planner is called at t and takes the time d. Its result takes effect at t + `deadline_s` if d ≤ `deadline_s`,
/// otherwise, late, at t + d. A planner that is still busy misses its turn. The calls of several vehicles are staggered
/// evenly over the period.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Planning {
    /// Time from one observation to the next, s, > 0.
    pub period_s: f64,
    /// Time from an observation to the time for which a result is planned, s, 0 or more.
    pub deadline_s: f64,
    /// Source of the planning time.
    pub time: PlanningClock,
    /// Median of a modelled planning time, s.
    pub median_s: f64,
    /// Standard deviation of the logarithm of a modelled planning time (log-normal), -. Zero: always the median.
    pub spread: f64,
    /// Recorded planning times, s, used cyclically.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub recorded_s: Vec<f64>,
}

/// Source of planning times.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum PlanningClock {
    /// Log-normal, from `median_s` and `spread`: the same on every machine.
    Modelled,
    /// From `recorded_s`: the same on every machine.
    Recorded,
    /// Measured on this machine: the flight depends on it.
    Measured,
}

impl Default for Planning {
    fn default() -> Self {
        Self {
            period_s: 0.25,
            deadline_s: 0.05,
            time: PlanningClock::Modelled,
            median_s: 0.01,
            spread: 0.0,
            recorded_s: Vec::new(),
        }
    }
}
