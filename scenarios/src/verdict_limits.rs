use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::Family;

/// Limits of the verdict, in addition to those of the vehicles and of the fleet. Each has a default per family: where
/// several are given, they are for fixed wings, slung loads and multirotors.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct VerdictLimits {
    /// Maximum tracking error: distance from the plan, m. Default: 5 m, 0.05 m, 0.5 m.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub tracking_max_m: Option<f64>,
    /// Maximum root mean square of the tracking error, m. Default: 2 m, 0.03 m, 0.2 m.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub tracking_rms_m: Option<f64>,
    /// Maximum difference between the arrival times of a fleet that must arrive at the same time, s. Default: 0.5 s.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub arrival_spread_s: Option<f64>,
    /// Maximum distance from the goal on arrival, m. Default: 5 m, 0.05 m, 0.5 m.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub goal_m: Option<f64>,
    /// Maximum difference between the heading on arrival and that of the goal, deg, modulo a full turn; only for fixed wings.
    /// Default: 5 deg.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub goal_heading_deg: Option<f64>,
    /// Maximum difference between the flight-path angle on arrival and that of the goal, deg; only for fixed wings. Default:
    /// 3 deg.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub goal_flight_path_deg: Option<f64>,
    /// Maximum difference between the speed over ground on arrival and that of the goal, m/s; only for fixed wings. Default:
    /// 2 m/s.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub goal_speed_mps: Option<f64>,
    /// Maximum speed of quadrotor and load at the end, relative to the goal, m/s; not applied to fixed wings. Default:
    /// 0.1 m/s for slung loads, 0.2 m/s for multirotors.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub rest_mps: Option<f64>,
    /// Maximum defect of the plan: distance between a row and the position to which the controls lead from an earlier row,
    /// by the nonlinear equations of motion, over one interval or at least 1 s (0.1 s for slung loads), m. Default: 1 m,
    /// 0.01 m, 1 m.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub dynamics_m: Option<f64>,
    /// Maximum distance from any row of the plan when its controls are flown open loop from the start, m. Default: 5 m; not
    /// applied to slung loads, which are unstable.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub rollout_m: Option<f64>,
    /// Maximum fraction of the flight during which the tracker's command is saturated at the vehicle's limits, in [0, 1].
    /// Default: 0.05.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub saturation: Option<f64>,
    /// Minimum distance of the planned envelope circle from every obstacle, m. The envelope is an unbounded vertical
    /// cylinder around the quadrotor, with the radius of its body or the horizontal reach of its load, whichever is larger.
    /// In flight the minimum is 0 m. Absent: the envelope is not checked, only the true shapes.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub envelope_m: Option<f64>,
    /// Maximum difference between the planned and the flown time at which a cable becomes taut or slack, s. A switch without
    /// a counterpart always exceeds it. Default: 0.02 s.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub switch_s: Option<f64>,
    /// Checks that are reported but do not affect the verdict, by full name (`flight.tracking_rms`). Those of crashes,
    /// completeness, finiteness, conditions and dynamics cannot be advisory.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub advisory: Vec<String>,
    /// Checks that fail if they are skipped, by full name.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub required: Vec<String>,
}

/// [`VerdictLimits`] with all defaults filled in.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct AppliedLimits {
    /// Tracking error, m.
    pub tracking_max_m: f64,
    /// Root mean square of the tracking error, m.
    pub tracking_rms_m: f64,
    /// Difference between arrival times, s.
    pub arrival_spread_s: f64,
    /// Distance from the goal at arrival, m.
    pub goal_m: f64,
    /// Heading at arrival, difference from the goal, deg.
    pub goal_heading_deg: f64,
    /// Flight-path angle at arrival, difference from the goal, deg.
    pub goal_flight_path_deg: f64,
    /// Speed at arrival, difference from the goal, m/s.
    pub goal_speed_mps: f64,
    /// Speed at the end, m/s.
    pub rest_mps: f64,
    /// Defect of the plan's intervals, m.
    pub dynamics_m: f64,
    /// Open-loop error at the plan's end, m.
    pub rollout_m: f64,
    /// Fraction of the flight with a saturated command, -.
    pub saturation: f64,
    /// Difference between a planned and a flown switch of the cable, s.
    pub switch_s: f64,
}

impl VerdictLimits {
    /// The limits for a family, with its defaults for those that are absent.
    pub fn applied_to(&self, family: Family) -> AppliedLimits {
        let default = &family.spec().verdict_limits;
        AppliedLimits {
            tracking_max_m: self.tracking_max_m.unwrap_or(default.tracking_max_m),
            tracking_rms_m: self.tracking_rms_m.unwrap_or(default.tracking_rms_m),
            arrival_spread_s: self.arrival_spread_s.unwrap_or(default.arrival_spread_s),
            goal_m: self.goal_m.unwrap_or(default.goal_m),
            goal_heading_deg: self.goal_heading_deg.unwrap_or(default.goal_heading_deg),
            goal_flight_path_deg: self.goal_flight_path_deg.unwrap_or(default.goal_flight_path_deg),
            goal_speed_mps: self.goal_speed_mps.unwrap_or(default.goal_speed_mps),
            rest_mps: self.rest_mps.unwrap_or(default.rest_mps),
            dynamics_m: self.dynamics_m.unwrap_or(default.dynamics_m),
            rollout_m: self.rollout_m.unwrap_or(default.rollout_m),
            saturation: self.saturation.unwrap_or(default.saturation),
            switch_s: self.switch_s.unwrap_or(default.switch_s),
        }
    }
}
