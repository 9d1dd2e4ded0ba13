use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Requirements between the vehicles of a fleet.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct FleetRules {
    /// Minimum distance R between any two vehicles at any time, m: horizontal between fixed wings, in space between
    /// multirotors. Absent: not required.
    pub separation_m: Option<f64>,
    /// Whether all vehicles must arrive at the same time.
    #[serde(default)]
    pub simultaneous_arrival: bool,
    /// Whether vehicles with in-loop planners share their references.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub plans_shared: bool,
}
