use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// What the vehicles of a fleet owe to each other.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct FleetRules {
    /// Smallest horizontal distance R between any two vehicles at any time, m. Absent: no rule.
    pub separation_m: Option<f64>,
    /// Do all vehicles have to arrive at the same time?
    #[serde(default)]
    pub simultaneous_arrival: bool,
    /// Do vehicles that plan in the loop tell each other what they are going to fly?
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub plans_shared: bool,
}
