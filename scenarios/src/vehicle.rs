use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::{ViaPoint, fixed_wing};

/// One vehicle of the fleet.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Vehicle {
    /// Name, unique in the fleet.
    pub name: String,
    /// Name of its model.
    pub model: String,
    /// Position and velocity at time 0.
    pub start: Waypoint,
    /// Position and velocity on arrival.
    pub goal: Waypoint,
    /// Points that it passes on its way, in this order.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub via: Vec<ViaPoint>,
}

/// A position, a velocity in polar form, and the position of a slung load if there is one.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Waypoint {
    /// East, m.
    pub x_m: f64,
    /// North, m.
    pub y_m: f64,
    /// Up, m.
    pub z_m: f64,
    /// Speed, m/s. Default: at rest, which only vehicles that can hover allow.
    #[serde(default)]
    pub speed_mps: f64,
    /// Direction of the horizontal velocity, counterclockwise from x (east), deg.
    #[serde(default)]
    pub heading_deg: f64,
    /// Flight-path angle of the velocity above the horizontal, deg.
    #[serde(default)]
    pub flight_path_deg: f64,
    /// Position of a slung load, which has the velocity of the vehicle. Absent: it hangs straight down on a taut cable.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub load: Option<LoadPoint>,
}

/// Position of the centre of a load in the world frame.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct LoadPoint {
    /// East, m.
    pub x_m: f64,
    /// North, m.
    pub y_m: f64,
    /// Up, m.
    pub z_m: f64,
}

impl Waypoint {
    /// At rest at a position, m, with a load, if any, hanging straight down.
    pub fn at_rest([x_m, y_m, z_m]: [f64; 3]) -> Self {
        Self { x_m, y_m, z_m, speed_mps: 0.0, heading_deg: 0.0, flight_path_deg: 0.0, load: None }
    }

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

    /// Velocity in the world frame, m/s.
    pub fn velocity_mps(&self) -> [f64; 3] {
        self.fixed_wing_state().velocity_mps()
    }
}

impl LoadPoint {
    /// Position in the world frame, m.
    pub fn position_m(&self) -> [f64; 3] {
        [self.x_m, self.y_m, self.z_m]
    }
}
