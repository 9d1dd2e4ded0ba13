use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Options of planners that search for a path of straight legs.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Search {
    /// How a path becomes a motion. Absent: within limits.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub timing: Option<PathTiming>,
}

/// How a path becomes a motion.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum PathTiming {
    /// Within the limits on speed and acceleration, with arcs at the corners.
    WithinLimits,
    /// As planned: at the largest speed along the legs, turning at once at the corners. No vehicle can fly it.
    ConstantSpeed,
}
