//! The multirotor: a vehicle that accelerates in any direction and can hover. Parameters, limits, state, trajectory.
//!
//! Planners take it for a double integrator with bounded speed and acceleration. What flies is that double integrator, or
//! a quadrotor with four rotors that has to tilt before it can accelerate: the scenario says which.

mod family;
mod import;
mod trajectory;
mod validate;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::Range;

pub use crate::GRAVITY_MPS2;
pub(crate) use family::FAMILY;
pub use trajectory::{CSV_COLUMNS, State, Trajectory};

/// A multirotor.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Model {
    /// What flies: planners do not ask.
    #[serde(default)]
    pub plant: Plant,
    /// Nominal mass, kg. Forces are computed with it, whatever the true mass is.
    pub mass_kg: f64,
    /// Radius of the sphere that encloses the vehicle, m: what has to stay clear of obstacles.
    pub body_radius_m: f64,
    /// Distance within which its sensors find obstacles and other vehicles, from its centre to their surface, m.
    pub sensor_range_m: f64,
    /// Drag area (drag coefficient times area), m²: what moving air does to it. Planners know none.
    #[serde(default)]
    pub drag_area_m2: f64,
    /// Rotors and inertia; only a `quadrotor` needs them.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub airframe: Option<Airframe>,
    /// Physical limits, by which the flight is judged.
    pub limits: Limits,
    /// Limits inside the physical ones, to which a planner keeps, so that a tracker has authority left.
    pub planning_limits: Limits,
}

/// What flies.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Plant {
    /// A double integrator: what it is told to accelerate it accelerates at once, inside its limits.
    #[default]
    PointMass,
    /// A rigid body with four rotors and an attitude loop.
    Quadrotor,
}

/// Four rotors on a rigid body, numbered and turning as those of [`slung_load::Model`](crate::slung_load::Model).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Airframe {
    /// Moments of inertia about the body axes x, y, z, kg m².
    pub inertia_kgm2: [f64; 3],
    /// Lever arm of the rotors about the body's x and y axes, m.
    pub arm_m: f64,
    /// Torque about the body's z axis for each newton of a rotor's thrust, m.
    pub torque_per_thrust_m: f64,
    /// Time constant with which a rotor's thrust follows its command, s. Absent: at once.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub rotor_time_constant_s: Option<f64>,
    /// Thrust of each rotor, N: physical limits.
    pub thrust_n: Range,
    /// Largest angle between the thrust and the vertical, deg: the physical limit, by which the flight is judged.
    pub tilt_deg: f64,
}

/// Bounds on the magnitudes of velocity and acceleration.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Limits {
    /// Speed, m/s; in the simulator relative to the air.
    pub speed_mps: f64,
    /// Acceleration, m/s²: that of the rotors beyond what carries the weight.
    pub acceleration_mps2: f64,
}

impl Limits {
    /// Distance that braking from full speed takes, m: v² / 2a.
    pub fn stopping_distance_m(&self) -> f64 {
        self.speed_mps * self.speed_mps / (2.0 * self.acceleration_mps2)
    }
}
