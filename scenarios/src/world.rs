use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::Range;

/// The map and the obstacles on it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct World {
    /// The volume that no vehicle may leave.
    pub map: Map,
    /// Vertical cylinders without top or bottom: keep-out zones in the plane (threats, pillars).
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub cylinders: Vec<Cylinder>,
}

/// An axis-aligned box in the world frame.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Map {
    /// West and east limit, m.
    pub x_m: Range,
    /// South and north limit, m.
    pub y_m: Range,
    /// Lowest and highest altitude, m.
    pub z_m: Range,
}

impl Map {
    /// The limits in the order x, y, z.
    pub fn axes(&self) -> [Range; 3] {
        [self.x_m, self.y_m, self.z_m]
    }
}

/// A vertical cylinder, unbounded upwards and downwards.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Cylinder {
    /// Name, unique among all obstacles.
    pub name: String,
    /// Axis, (x, y) in m.
    pub center_m: [f64; 2],
    /// Radius, m, > 0.
    pub radius_m: f64,
}

impl Cylinder {
    /// Signed horizontal distance from a point to the surface, m: negative inside.
    pub fn signed_distance_m(&self, x_m: f64, y_m: f64) -> f64 {
        (x_m - self.center_m[0]).hypot(y_m - self.center_m[1]) - self.radius_m
    }
}
