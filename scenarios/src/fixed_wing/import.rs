//! The family's plan columns, and what a table of them becomes.

use std::f64::consts::{PI, TAU};

use super::{CSV_COLUMNS, Control, State};
use crate::Family;
use crate::plan_input::columns::{Columns, Gaps};
use crate::plan_input::{ColumnTable, ImportedTrajectory, flight_columns};

const DEGREE: f64 = PI / 180.0;

/// Position; speed, heading (counterclockwise from east) and flight-path angle, or the velocity in the world frame; load
/// factors along the velocity, to the left, and up.
pub(super) const COLUMNS: Columns = Columns {
    family: Family::FixedWing,
    written: &CSV_COLUMNS,
    required: &["x_m", "y_m", "z_m"],
    velocity: &[&["speed_mps", "heading_rad", "flight_path_rad"], &["vx_mps", "vy_mps", "vz_mps"]],
    controls: &["n_x", "n_y", "n_z"],
    optional: &[],
    ignored: &[],
    converted: &[("heading_deg", "heading_rad", DEGREE), ("flight_path_deg", "flight_path_rad", DEGREE)],
    words: &[],
    arrays: &[],
    allows_discontinuity: false,
    gaps: Gaps::Judged,
};

/// Of a flight flown elsewhere.
pub(super) const FLIGHT_COLUMNS: Columns = flight_columns(&COLUMNS);

/// The planned motion of one aircraft as far as the file gives it: velocities and controls at every node, or not at all.
#[derive(Clone, Debug, PartialEq)]
pub struct PartialTrajectory {
    /// Name of the vehicle.
    pub vehicle: String,
    /// Times of the nodes, s, increasing from 0.
    pub times_s: Vec<f64>,
    /// Positions at the nodes, m.
    pub positions_m: Vec<[f64; 3]>,
    /// States at the nodes, if the file gives velocities.
    pub states: Option<Vec<State>>,
    /// Controls at the nodes, if the file gives them.
    pub controls: Option<Vec<Control>>,
}

pub(super) fn trajectory(table: &ColumnTable) -> ImportedTrajectory {
    let positions_m = table.triples(["x_m", "y_m", "z_m"]).unwrap_or_default();
    let polar = table.triples(["speed_mps", "heading_rad", "flight_path_rad"]);
    let cartesian = || table.triples(["vx_mps", "vy_mps", "vz_mps"]);
    let states = match polar {
        Some(polar) => Some(states_from_polar(&positions_m, &polar)),
        None => cartesian().map(|velocities_mps| states_from_velocities(&positions_m, &velocities_mps)),
    };
    let controls = table.triples(["n_x", "n_y", "n_z"]);
    ImportedTrajectory::Partial(PartialTrajectory {
        vehicle: table.vehicle.clone(),
        times_s: table.times_s.clone(),
        positions_m,
        states,
        controls: controls.map(|rows| rows.into_iter().map(Control::from_array).collect()),
    })
}

/// States from positions (m) and world-frame velocities (m/s) at the same nodes, with continuous headings.
pub fn states_from_velocities(positions_m: &[[f64; 3]], velocities_mps: &[[f64; 3]]) -> Vec<State> {
    let polar: Vec<[f64; 3]> = velocities_mps
        .iter()
        .map(|[x, y, z]| {
            let horizontal = x.hypot(*y);
            [horizontal.hypot(*z), y.atan2(*x), z.atan2(horizontal)]
        })
        .collect();
    states_from_polar(positions_m, &polar)
}

fn states_from_polar(positions_m: &[[f64; 3]], polar: &[[f64; 3]]) -> Vec<State> {
    let mut states: Vec<State> = Vec::with_capacity(polar.len());
    for ([x_m, y_m, z_m], [speed_mps, heading_rad, flight_path_rad]) in positions_m.iter().zip(polar) {
        let heading_rad = states.last().map_or(*heading_rad, |last| unwrapped(*heading_rad, last.heading_rad));
        states.push(State::from_array([*x_m, *y_m, *z_m, *speed_mps, heading_rad, *flight_path_rad]));
    }
    states
}

/// `angle_rad` plus the whole number of turns that brings it within half a turn of `last_rad`.
fn unwrapped(angle_rad: f64, last_rad: f64) -> f64 {
    let turns = ((last_rad - angle_rad) / TAU).round();
    if turns == 0.0 { angle_rad } else { angle_rad + turns * TAU }
}
