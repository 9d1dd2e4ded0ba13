//! The family's plan columns, and what a table of them becomes.

use super::{CSV_COLUMNS, State, Trajectory};
use crate::Family;
use crate::plan_input::columns::{Columns, without_vehicle_and_time};
use crate::plan_input::{ColumnTable, ImportedTrajectory};

/// Position and velocity, both required: nothing is reconstructed.
pub(super) const COLUMNS: Columns = Columns {
    family: Family::Multirotor,
    written: &CSV_COLUMNS,
    required: without_vehicle_and_time(&CSV_COLUMNS),
    velocity: &[],
    controls: &[],
    optional: &[],
    converted: &[],
    words: &[],
    arrays: &[("position_m", &["x_m", "y_m", "z_m"]), ("velocity_mps", &["vx_mps", "vy_mps", "vz_mps"])],
    allows_discontinuity: true,
    refuses_gaps: true,
};

pub(super) fn trajectory(table: &ColumnTable) -> ImportedTrajectory {
    let positions_m = table.triples(["x_m", "y_m", "z_m"]).unwrap_or_default();
    let velocities_mps = table.triples(["vx_mps", "vy_mps", "vz_mps"]).unwrap_or_default();
    let states = positions_m.into_iter().zip(velocities_mps);
    let trajectory = Trajectory {
        vehicle: table.vehicle.clone(),
        times_s: table.times_s.clone(),
        states: states.map(|(position_m, velocity_mps)| State { position_m, velocity_mps }).collect(),
    };
    ImportedTrajectory::Complete(trajectory.into())
}
