//! The family's plan columns, and what a table of them becomes.

use super::{CSV_COLUMNS, State, Trajectory};
use crate::Family;
use crate::plan_input::columns::{Columns, Gaps};
use crate::plan_input::{ColumnTable, ImportedTrajectory, flight_columns};

/// Position and velocity; without the latter it is reconstructed.
pub(super) const COLUMNS: Columns = Columns {
    family: Family::Multirotor,
    written: &CSV_COLUMNS,
    required: &["x_m", "y_m", "z_m"],
    velocity: &[&["vx_mps", "vy_mps", "vz_mps"]],
    controls: &[],
    optional: &[],
    ignored: &[],
    converted: &[],
    words: &[],
    arrays: &[("position_m", &["x_m", "y_m", "z_m"]), ("velocity_mps", &["vx_mps", "vy_mps", "vz_mps"])],
    allows_discontinuity: true,
    gaps: Gaps::Refused,
};

/// Of a flight flown elsewhere.
pub(super) const FLIGHT_COLUMNS: Columns = flight_columns(&COLUMNS);

/// The planned motion of one multirotor by its positions alone.
#[derive(Clone, Debug, PartialEq)]
pub struct Positions {
    /// Name of the vehicle.
    pub vehicle: String,
    /// Times of the nodes, s, increasing from 0.
    pub times_s: Vec<f64>,
    /// Positions at the nodes, m.
    pub positions_m: Vec<[f64; 3]>,
}

pub(super) fn trajectory(table: &ColumnTable) -> ImportedTrajectory {
    let positions_m = table.triples(["x_m", "y_m", "z_m"]).unwrap_or_default();
    let (vehicle, times_s) = (table.vehicle.clone(), table.times_s.clone());
    let Some(velocities_mps) = table.triples(["vx_mps", "vy_mps", "vz_mps"]) else {
        return ImportedTrajectory::Positions(Positions { vehicle, times_s, positions_m });
    };
    let states = positions_m.into_iter().zip(velocities_mps);
    let states = states.map(|(position_m, velocity_mps)| State { position_m, velocity_mps }).collect();
    ImportedTrajectory::Complete(Trajectory { vehicle, times_s, states }.into())
}
