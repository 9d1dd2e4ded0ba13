use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The limits that the judge applies beyond those of the vehicles and of the fleet.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct VerdictLimits {
    /// Largest distance from the plan while it is flown, m.
    pub tracking_max_m: f64,
    /// Largest root mean square of that distance, m.
    pub tracking_rms_m: f64,
    /// Largest difference between the arrival times of a fleet that must arrive together, s.
    pub arrival_spread_s: f64,
    /// Largest distance from the goal at arrival, m.
    pub goal_m: f64,
    /// Largest distance between the end of an interval of the plan and where its controls lead through the nonlinear
    /// equations from the interval's beginning, m.
    pub dynamics_m: f64,
    /// Largest distance from the plan's end when its controls are flown open loop from the start, m.
    pub rollout_m: f64,
    /// Largest share of the flight during which the tracker's command is cut off at the vehicle's limits, in [0, 1].
    pub saturation: f64,
    /// Checks that are shown and counted but do not decide, by their full names (`flight.tracking_rms`).
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub advisory: Vec<String>,
    /// Checks that must have been made: a skip fails them. By their full names.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub required: Vec<String>,
}

impl Default for VerdictLimits {
    fn default() -> Self {
        Self {
            tracking_max_m: 5.0,
            tracking_rms_m: 2.0,
            arrival_spread_s: 0.5,
            goal_m: 5.0,
            dynamics_m: 1.0,
            rollout_m: 5.0,
            saturation: 0.05,
            advisory: Vec::new(),
            required: Vec::new(),
        }
    }
}
