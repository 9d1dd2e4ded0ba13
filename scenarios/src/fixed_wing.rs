//! The fixed-wing point-mass model: parameters, limits, state, control.
//!
//! Wang, Xu, Long (2020), eq. 2: state (x, y, h, V, χ, γ), control the load factors (n_x, n_y, n_z).

mod family;
mod import;
mod trajectory;
mod validate;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::Range;

pub use crate::GRAVITY_MPS2;
pub(crate) use family::FAMILY;
pub use import::{PartialTrajectory, states_from_velocities};
pub use trajectory::{CSV_COLUMNS, Trajectory};

/// A fixed-wing aircraft as a point mass controlled by load factors.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Model {
    /// Nominal mass, kg. Forces are computed from it even if the true mass differs.
    pub mass_kg: f64,
    /// Radius of the sphere that encloses the airframe, which must stay clear of obstacles, m.
    pub body_radius_m: f64,
    /// Physical limits, applied to the flight.
    pub limits: Limits,
    /// Limits for planners, inside the physical ones to leave control authority to the tracker.
    pub planning_limits: Limits,
}

/// Box limits of state and control. In the simulator, speed is airspeed and load factors act in the air frame.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Limits {
    /// Altitude, m.
    pub altitude_m: Range,
    /// Airspeed, m/s.
    pub speed_mps: Range,
    /// Flight-path angle, deg, inside (-90, 90).
    pub flight_path_deg: Range,
    /// Load factor along the velocity, -.
    pub n_x: Range,
    /// Horizontal load factor, perpendicular to the velocity, positive to the left, -.
    pub n_y: Range,
    /// Load factor perpendicular to the velocity in the vertical plane, positive up, -.
    pub n_z: Range,
}

impl Limits {
    /// Limits of (n_x, n_y, n_z).
    pub fn controls(&self) -> [Range; 3] {
        [self.n_x, self.n_y, self.n_z]
    }
}

/// State s = (x, y, h, V, χ, γ).
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct State {
    /// East, m.
    pub x_m: f64,
    /// North, m.
    pub y_m: f64,
    /// Altitude, m.
    pub z_m: f64,
    /// Speed V, m/s.
    pub speed_mps: f64,
    /// Heading χ, counterclockwise from x (east), rad; not wrapped, and continuous along a trajectory.
    pub heading_rad: f64,
    /// Flight-path angle γ, rad.
    pub flight_path_rad: f64,
}

impl State {
    /// Position in the world frame, m.
    pub fn position_m(&self) -> [f64; 3] {
        [self.x_m, self.y_m, self.z_m]
    }

    /// Velocity in the world frame, m/s.
    pub fn velocity_mps(&self) -> [f64; 3] {
        let (sin_χ, cos_χ) = self.heading_rad.sin_cos();
        let (sin_γ, cos_γ) = self.flight_path_rad.sin_cos();
        let horizontal = self.speed_mps * cos_γ;
        [horizontal * cos_χ, horizontal * sin_χ, self.speed_mps * sin_γ]
    }

    /// (x, y, h, V, χ, γ).
    pub fn to_array(self) -> [f64; 6] {
        [self.x_m, self.y_m, self.z_m, self.speed_mps, self.heading_rad, self.flight_path_rad]
    }

    /// From (x, y, h, V, χ, γ).
    pub fn from_array([x_m, y_m, z_m, speed_mps, heading_rad, flight_path_rad]: [f64; 6]) -> Self {
        Self { x_m, y_m, z_m, speed_mps, heading_rad, flight_path_rad }
    }
}

/// Control u = (n_x, n_y, n_z): load factors along the velocity, horizontal, and vertical, -.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Control {
    /// Along the velocity.
    pub n_x: f64,
    /// Horizontal, positive to the left.
    pub n_y: f64,
    /// Perpendicular to the velocity in the vertical plane, positive up.
    pub n_z: f64,
}

impl Control {
    /// Straight and level flight at constant speed.
    pub const CRUISE: Self = Self { n_x: 0.0, n_y: 0.0, n_z: 1.0 };

    /// (n_x, n_y, n_z).
    pub fn to_array(self) -> [f64; 3] {
        [self.n_x, self.n_y, self.n_z]
    }

    /// From (n_x, n_y, n_z).
    pub fn from_array([n_x, n_y, n_z]: [f64; 3]) -> Self {
        Self { n_x, n_y, n_z }
    }
}
