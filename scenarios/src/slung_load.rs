//! The quadrotor with a slung load: parameters, limits, state, control.
//!
//! Model of Kang, Huang, Wen (2020): a rigid body with four rotors, a point load, and a massless cable, attached to the
//! centre of mass of the quadrotor, that can only pull. Positions and velocities are Cartesian, unlike the cable angles of
//! the paper, so that every position of the load is regular, including above the quadrotor.

mod family;
mod import;
mod state;
mod trajectory;
mod validate;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::Range;

pub use crate::GRAVITY_MPS2;
pub(crate) use family::FAMILY;
pub use state::{Cable, Control, State};
pub use trajectory::{AT_NODE, CSV_COLUMNS, Trajectory};

/// A quadrotor with a slung load.
///
/// Body axes: x forward, y left, z up, with the thrust of the rotors along z. The thrusts F_1 ... F_4 cause the torques
///
/// ```text
/// τ_x = L (-F_1 + F_2 + F_3 - F_4),   τ_y = L (-F_1 - F_2 + F_3 + F_4),   τ_z = k (F_1 - F_2 + F_3 - F_4)
/// ```
///
/// about these axes (Kang, Huang, Wen 2020, eq. 5, in the order yaw, pitch, roll).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Model {
    /// Nominal mass of the quadrotor m_Q, kg.
    pub mass_kg: f64,
    /// Moments of inertia about the body axes x, y, z, kg m².
    pub inertia_kgm2: [f64; 3],
    /// Lever arm L of the rotors about the body axes x and y, m.
    pub arm_m: f64,
    /// Ratio k of a rotor's torque about the body axis z to its thrust, m.
    pub torque_per_thrust_m: f64,
    /// Radius of a propeller r_p, m. The body is a disc of radius L + r_p.
    pub propeller_radius_m: f64,
    /// Nominal mass of the load m_L, kg.
    pub load_mass_kg: f64,
    /// Radius of the sphere that encloses the load, m.
    pub load_radius_m: f64,
    /// Length of the taut cable l_0, m.
    pub cable_length_m: f64,
    /// Drag area of the quadrotor (drag coefficient times area), m². Planning models have no drag.
    #[serde(default)]
    pub drag_area_m2: f64,
    /// Drag area of the load, m².
    #[serde(default)]
    pub load_drag_area_m2: f64,
    /// Time constant of the rotor thrust, s. Absent: the thrust follows its command immediately.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub rotor_time_constant_s: Option<f64>,
    /// Physical limits, applied to the flight.
    pub limits: Limits,
    /// Limits for planners, inside the physical ones to leave control authority to the tracker.
    pub planning_limits: Limits,
}

/// Box limits of state and control.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Limits {
    /// Thrust of each rotor, N.
    pub thrust_n: Range,
    /// Roll and pitch (Z-Y-X Euler angles) and yaw, deg, inside (-90, 90).
    pub attitude_deg: Range,
    /// Cable angles α and β, deg: the load is at ρ (-cos α sin β, sin α, -cos α cos β) from the quadrotor.
    pub cable_deg: Range,
    /// Maximum tension that the cable and its attachments bear, N.
    pub tension_n: f64,
}

impl Model {
    /// Radius of the disc that represents the body, r_2 = L + r_p, m.
    pub fn body_radius_m(&self) -> f64 {
        self.arm_m + self.propeller_radius_m
    }

    /// Thrust of each rotor in hover with the load, N.
    pub fn hover_thrust_n(&self) -> f64 {
        (self.mass_kg + self.load_mass_kg) * GRAVITY_MPS2 / 4.0
    }
}
