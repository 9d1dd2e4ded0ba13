//! The multirotor, which accelerates in any direction and can hover: parameters, limits, state, trajectory.
//!
//! The planning model is a double integrator with bounded speed and acceleration. The simulated plant is the same double
//! integrator, or a quadrotor that must tilt in order to accelerate.

mod family;
mod import;
mod trajectory;
mod validate;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::Range;

pub use crate::GRAVITY_MPS2;
pub(crate) use family::FAMILY;
pub use import::Positions;
pub use trajectory::{CSV_COLUMNS, State, Trajectory};

/// A multirotor.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Model {
    /// The simulated plant; planners ignore it.
    #[serde(default)]
    pub plant: Plant,
    /// Nominal mass, kg. Forces are computed from it even if the true mass differs.
    pub mass_kg: f64,
    /// Radius of the sphere that encloses the vehicle, which must stay clear of obstacles, m.
    pub body_radius_m: f64,
    /// Range of the sensors, from the centre of the vehicle to the surface of an obstacle or another vehicle, m.
    pub sensor_range_m: f64,
    /// Drag area (drag coefficient times area), m². Planning models have no drag.
    #[serde(default)]
    pub drag_area_m2: f64,
    /// Rotors and inertia, required for the plant `quadrotor`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub airframe: Option<Airframe>,
    /// Physical limits, applied to the flight.
    pub limits: Limits,
    /// Limits for planners, inside the physical ones to leave control authority to the tracker.
    pub planning_limits: Limits,
}

/// Simulated plant.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Plant {
    /// A double integrator that follows the commanded acceleration immediately, within its limits.
    #[default]
    PointMass,
    /// A rigid body with four rotors and an attitude loop.
    Quadrotor,
}

/// Four rotors on a rigid body, with the numbering and directions of [`slung_load::Model`](crate::slung_load::Model).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Airframe {
    /// Moments of inertia about the body axes x, y, z, kg m².
    pub inertia_kgm2: [f64; 3],
    /// Lever arm of the rotors about the body axes x and y, m.
    pub arm_m: f64,
    /// Ratio of a rotor's torque about the body axis z to its thrust, m.
    pub torque_per_thrust_m: f64,
    /// Time constant of the rotor thrust, s. Absent: the thrust follows its command immediately.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub rotor_time_constant_s: Option<f64>,
    /// Physical limits of the thrust of each rotor, N.
    pub thrust_n: Range,
    /// Maximum angle between thrust and vertical, deg: a physical limit, applied to the flight.
    pub tilt_deg: f64,
}

/// Bounds of the magnitudes of velocity and acceleration.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Limits {
    /// Speed, m/s; in the simulator, airspeed.
    pub speed_mps: f64,
    /// Acceleration by the rotors, beyond gravity compensation, m/s².
    pub acceleration_mps2: f64,
}

impl Limits {
    /// Braking distance from maximum speed, v² / 2a, m.
    pub fn stopping_distance_m(&self) -> f64 {
        self.speed_mps * self.speed_mps / (2.0 * self.acceleration_mps2)
    }
}
