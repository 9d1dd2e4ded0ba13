use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::{SeparationShape, SeparationVolume};

/// Requirements between the vehicles of a fleet.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct FleetRules {
    /// Minimum distance R between any two vehicles at any time, m: horizontal between fixed wings, in space between
    /// multirotors, unless `separation_shape` says otherwise. Absent: not required.
    pub separation_m: Option<f64>,
    /// Shape of the volume around a vehicle that no other may enter. Absent: horizontal between fixed wings, a sphere between
    /// multirotors.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub separation_shape: Option<SeparationShape>,
    /// How far a cylinder or an ellipsoid reaches up and down, m.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub separation_height_m: Option<f64>,
    /// A volume with a name in aviation, in place of the three fields above.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub separation_volume: Option<SeparationVolume>,
    /// Whether all vehicles must arrive at the same time.
    #[serde(default)]
    pub simultaneous_arrival: bool,
    /// Whether vehicles with in-loop planners share their references.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub plans_shared: bool,
}
