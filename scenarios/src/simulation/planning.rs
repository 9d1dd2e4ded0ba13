use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// When a planner in the loop is asked, and how long its answer takes.
///
/// Asked at t, a planner that needs the time d is flown from t + `deadline_s` on if d is not longer, else from t + d: late.
/// A planner that is still busy misses its turn. Several vehicles take turns, evenly over the period.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Planning {
    /// Time from one observation to the next, s, > 0.
    pub period_s: f64,
    /// Time from an observation to the instant for which an answer is planned, s, 0 or more.
    pub deadline_s: f64,
    /// Where the planning time comes from.
    pub time: PlanningClock,
    /// Median of a modelled planning time, s.
    pub median_s: f64,
    /// Standard deviation of the logarithm of a modelled planning time (log-normal), -. Zero: always the median.
    pub spread: f64,
    /// Recorded planning times, s, taken in turn, again and again.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub recorded_s: Vec<f64>,
}

/// Where planning times come from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum PlanningClock {
    /// From `median_s` and `spread`: the same on every machine.
    Modelled,
    /// From `recorded_s`: the same on every machine.
    Recorded,
    /// From the clock of the machine at hand: the flight depends on it.
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
