//! The quadrotor that carries a load on a cable: parameters, limits, state, control.
//!
//! Kang, Huang, Wen (2020): a rigid body with four rotors, a point load, and between them a massless cable that hangs at
//! the quadrotor's centre of mass and can only pull. Positions and velocities are Cartesian here, where the paper uses
//! cable angles: they name every place of the load, the one above the quadrotor included.

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
pub use trajectory::{CSV_COLUMNS, Trajectory};

/// A quadrotor with a slung load.
///
/// Body axes: x forward, y left, z up, the rotors' thrust along z. With the thrusts F_1 ... F_4 the torques about them are
///
/// ```text
/// τ_x = L (-F_1 + F_2 + F_3 - F_4),   τ_y = L (-F_1 - F_2 + F_3 + F_4),   τ_z = k (F_1 - F_2 + F_3 - F_4)
/// ```
///
/// (Kang, Huang, Wen 2020, eq. 5, whose order is yaw, pitch, roll.)
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Model {
    /// Nominal mass of the quadrotor m_Q, kg.
    pub mass_kg: f64,
    /// Moments of inertia about the body axes x, y, z, kg m².
    pub inertia_kgm2: [f64; 3],
    /// Lever arm L of the rotors about the body's x and y axes, m.
    pub arm_m: f64,
    /// Torque about the body's z axis for each newton of a rotor's thrust, k, m.
    pub torque_per_thrust_m: f64,
    /// Radius of a propeller r_p, m: the body's disc has the radius L + r_p.
    pub propeller_radius_m: f64,
    /// Nominal mass of the load m_L, kg.
    pub load_mass_kg: f64,
    /// Radius of the ball that encloses the load, m.
    pub load_radius_m: f64,
    /// Length of the taut cable l_0, m.
    pub cable_length_m: f64,
    /// Drag area of the quadrotor (drag coefficient times area), m²: what moving air does to it. Planners know none.
    #[serde(default)]
    pub drag_area_m2: f64,
    /// Drag area of the load, m².
    #[serde(default)]
    pub load_drag_area_m2: f64,
    /// Time constant with which a rotor's thrust follows its command, s. Absent: at once.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub rotor_time_constant_s: Option<f64>,
    /// Physical limits, by which the flight is judged.
    pub limits: Limits,
    /// Limits inside the physical ones, to which a planner keeps, so that a tracker has authority left.
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
    /// Largest tension of the cable, N: what it and its hooks bear.
    pub tension_n: f64,
}

impl Model {
    /// Radius of the disc that the body is taken for, r_2 = L + r_p, m.
    pub fn body_radius_m(&self) -> f64 {
        self.arm_m + self.propeller_radius_m
    }

    /// Thrust of each rotor that holds quadrotor and load still, N.
    pub fn hover_thrust_n(&self) -> f64 {
        (self.mass_kg + self.load_mass_kg) * GRAVITY_MPS2 / 4.0
    }
}
