use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::geodesy::{Geodetic, LocalFrame};

/// Where the world frame lies on the Earth: its origin, with x to the east, y to the north and z up along the normal of the
/// ellipsoid WGS 84.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Origin {
    /// Latitude, WGS 84, deg, positive to the north, in [-90, 90].
    pub latitude_deg: f64,
    /// Longitude, WGS 84, deg, positive to the east, in [-180, 180].
    pub longitude_deg: f64,
    /// Altitude above mean sea level (AMSL), m.
    pub altitude_m: f64,
}

impl Origin {
    /// The world frame.
    pub fn frame(&self) -> LocalFrame {
        LocalFrame::new(self)
    }

    /// The origin as a point.
    pub fn geodetic(&self) -> Geodetic {
        let Self { latitude_deg, longitude_deg, altitude_m } = *self;
        Geodetic { latitude_deg, longitude_deg, altitude_m }
    }
}
