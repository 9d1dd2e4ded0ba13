//! The family's plan columns, and what a table of them becomes.

use super::trajectory::DERIVED_FROM;
use super::{AT_NODE, CSV_COLUMNS, Cable, Control, State, Trajectory};
use crate::plan_input::columns::{Columns, Gaps, without_vehicle_and_time};
use crate::plan_input::{ColumnTable, ImportedTrajectory};
use crate::{Family, Interpolation};

/// State, control and cable, all required: nothing is reconstructed. Without the column `at_node` every row is a node. The
/// columns after it follow from the others, and are not used.
pub(super) const COLUMNS: Columns = Columns {
    family: Family::SlungLoad,
    written: &CSV_COLUMNS,
    required: without_vehicle_and_time(CSV_COLUMNS.split_at(25).0),
    velocity: &[],
    controls: &[],
    optional: CSV_COLUMNS.split_at(DERIVED_FROM - 1).1,
    ignored: &[],
    converted: &[],
    words: &[("cable", &["slack", "taut"]), (AT_NODE, &["no", "yes"])],
    arrays: &[
        ("position_m", &["x_m", "y_m", "z_m"]),
        ("velocity_mps", &["vx_mps", "vy_mps", "vz_mps"]),
        ("roll_pitch_yaw_rad", &["roll_rad", "pitch_rad", "yaw_rad"]),
        ("body_rate_radps", &["rate_x_radps", "rate_y_radps", "rate_z_radps"]),
        ("load_position_m", &["load_x_m", "load_y_m", "load_z_m"]),
        ("load_velocity_mps", &["load_vx_mps", "load_vy_mps", "load_vz_mps"]),
        ("thrust_n", &["thrust_1_n", "thrust_2_n", "thrust_3_n", "thrust_4_n"]),
    ],
    allows_discontinuity: true,
    gaps: Gaps::Refused,
};

pub(super) fn trajectory(table: &ColumnTable) -> ImportedTrajectory {
    let nodes = 0..table.times_s.len();
    let value =
        |column: usize, node: usize| table.columns.get(CSV_COLUMNS[column]).map_or(f64::NAN, |values| values[node]);
    let state = |node: usize| State::from_array(std::array::from_fn(|i| value(2 + i, node)));
    let control = |node: usize| Control { thrust_n: std::array::from_fn(|i| value(20 + i, node)) };
    let cable = |node: usize| if value(24, node) == 0.0 { Cable::Slack } else { Cable::Taut };
    let trajectory = Trajectory {
        vehicle: table.vehicle.clone(),
        interpolation: Interpolation::FirstOrderHold,
        times_s: table.times_s.clone(),
        states: nodes.clone().map(state).collect(),
        controls: nodes.clone().map(control).collect(),
        cable: nodes.map(cable).collect(),
        planner_nodes: planner_nodes(table),
    };
    ImportedTrajectory::Complete(trajectory.into())
}

/// The nodes of the planner that the table lists, or the rows that say so.
fn planner_nodes(table: &ColumnTable) -> Vec<usize> {
    match table.columns.get(AT_NODE) {
        Some(at_node) => (0..at_node.len()).filter(|row| at_node[*row] != 0.0).collect(),
        None => table.planner_nodes.clone(),
    }
}
