use std::collections::BTreeMap;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::fixed_wing;

/// Vehicle models by kind, then by name: `[models.fixed-wing.NAME]`.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Models {
    /// Fixed-wing point-mass models.
    #[serde(default, rename = "fixed-wing")]
    pub fixed_wing: BTreeMap<String, fixed_wing::Model>,
}

/// One vehicle of the fleet.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Vehicle {
    /// Name, unique in the fleet.
    pub name: String,
    /// Name of its model.
    pub model: String,
    /// Where and how it begins, at time 0.
    pub start: Waypoint,
    /// Where and how it must arrive.
    pub goal: Waypoint,
}

/// A position and a velocity, the velocity in polar form.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Waypoint {
    /// East, m.
    pub x_m: f64,
    /// North, m.
    pub y_m: f64,
    /// Up, m.
    pub z_m: f64,
    /// Speed, m/s.
    pub speed_mps: f64,
    /// Direction of the horizontal velocity, counterclockwise from x (east), deg.
    #[serde(default)]
    pub heading_deg: f64,
    /// Climb angle of the velocity above the horizontal, deg.
    #[serde(default)]
    pub flight_path_deg: f64,
}

impl Waypoint {
    /// The waypoint as a fixed-wing state.
    pub fn fixed_wing_state(&self) -> fixed_wing::State {
        fixed_wing::State {
            x_m: self.x_m,
            y_m: self.y_m,
            z_m: self.z_m,
            speed_mps: self.speed_mps,
            heading_rad: self.heading_deg.to_radians(),
            flight_path_rad: self.flight_path_deg.to_radians(),
        }
    }

    /// Position in the world frame, m.
    pub fn position_m(&self) -> [f64; 3] {
        [self.x_m, self.y_m, self.z_m]
    }
}
