use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::Family;

/// The limits that the judge applies beyond those of the vehicles and of the fleet. Those that are left out are the
/// family's: the first figure is for fixed wings, the second for slung loads, the third for multirotors.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct VerdictLimits {
    /// Largest distance from the plan while it is flown, m. Default: 5 m, 0.05 m, 0.5 m.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub tracking_max_m: Option<f64>,
    /// Largest root mean square of that distance, m. Default: 2 m, 0.03 m, 0.2 m.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub tracking_rms_m: Option<f64>,
    /// Largest difference between the arrival times of a fleet that must arrive together, s. Default: 0.5 s.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub arrival_spread_s: Option<f64>,
    /// Largest distance from the goal at arrival, m. Default: 5 m, 0.05 m, 0.5 m.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub goal_m: Option<f64>,
    /// Largest speed of quadrotor and load, relative to the goal's, at the end, m/s; fixed wings do not come to rest.
    /// Default: 0.1 m/s, of multirotors 0.2 m/s.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub rest_mps: Option<f64>,
    /// Largest distance between the end of an interval of the plan and where its controls lead through the nonlinear
    /// equations from the interval's beginning, m. Default: 1 m, 0.01 m.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub dynamics_m: Option<f64>,
    /// Largest distance from the plan's end when its controls are flown open loop from the start, m. Default: 5 m; for
    /// slung loads, which are unstable, it is not asked.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub rollout_m: Option<f64>,
    /// Largest share of the flight during which the tracker's command is cut off at the vehicle's limits, in [0, 1].
    /// Default: 0.05.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub saturation: Option<f64>,
    /// Smallest distance of the plan's envelope circle from every obstacle, m: a quadrotor's body or its load's horizontal
    /// reach, whichever is larger, as a vertical cylinder without ends. Absent: the envelope is not asked for, only the true
    /// shapes are. In flight the envelope has to stay clear by 0 m.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub envelope_m: Option<f64>,
    /// Largest difference between the planned and the flown instant at which a cable becomes taut or slack, s; a switch
    /// without its counterpart is worse than any. Default: 0.02 s.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub switch_s: Option<f64>,
    /// Checks that are shown and counted but do not decide, by their full names (`flight.tracking_rms`).
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub advisory: Vec<String>,
    /// Checks that must have been made: a skip fails them. By their full names.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub required: Vec<String>,
}

/// [`VerdictLimits`] with a figure for each: what a judge compares with.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct AppliedLimits {
    /// Distance from the plan, m.
    pub tracking_max_m: f64,
    /// Root mean square of that distance, m.
    pub tracking_rms_m: f64,
    /// Difference between arrival times, s.
    pub arrival_spread_s: f64,
    /// Distance from the goal at arrival, m.
    pub goal_m: f64,
    /// Speed at the end, m/s.
    pub rest_mps: f64,
    /// Defect of the plan's intervals, m.
    pub dynamics_m: f64,
    /// Open-loop error at the plan's end, m.
    pub rollout_m: f64,
    /// Share of the flight with a saturated command, -.
    pub saturation: f64,
    /// Difference between a planned and a flown switch of the cable, s.
    pub switch_s: f64,
}

impl VerdictLimits {
    /// The limits for vehicles of this family.
    pub fn applied_to(&self, family: Family) -> AppliedLimits {
        let default = &family.spec().verdict_limits;
        AppliedLimits {
            tracking_max_m: self.tracking_max_m.unwrap_or(default.tracking_max_m),
            tracking_rms_m: self.tracking_rms_m.unwrap_or(default.tracking_rms_m),
            arrival_spread_s: self.arrival_spread_s.unwrap_or(default.arrival_spread_s),
            goal_m: self.goal_m.unwrap_or(default.goal_m),
            rest_mps: self.rest_mps.unwrap_or(default.rest_mps),
            dynamics_m: self.dynamics_m.unwrap_or(default.dynamics_m),
            rollout_m: self.rollout_m.unwrap_or(default.rollout_m),
            saturation: self.saturation.unwrap_or(default.saturation),
            switch_s: self.switch_s.unwrap_or(default.switch_s),
        }
    }
}
