use serde::{Deserialize, Serialize};

use super::{Control, State};
use crate::{Family, Interpolation, TrajectoryNodes};

/// Columns of a written fixed-wing plan: time, state and control, one row per vehicle and node. World frame, SI, radians.
pub const CSV_COLUMNS: [&str; 11] =
    ["vehicle", "t_s", "x_m", "y_m", "z_m", "speed_mps", "heading_rad", "flight_path_rad", "n_x", "n_y", "n_z"];

/// The planned motion of a fixed wing, given at nodes.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Trajectory {
    /// Name of the vehicle.
    pub vehicle: String,
    /// Interpolation of the controls between the nodes.
    pub interpolation: Interpolation,
    /// Times of the nodes, s, increasing from 0.
    pub times_s: Vec<f64>,
    /// States at the nodes.
    pub states: Vec<State>,
    /// Controls at the nodes.
    pub controls: Vec<Control>,
}

impl TrajectoryNodes for Trajectory {
    fn family(&self) -> Family {
        Family::FixedWing
    }

    fn vehicle(&self) -> &str {
        &self.vehicle
    }

    fn times_s(&self) -> &[f64] {
        &self.times_s
    }

    fn counts(&self) -> Vec<(&'static str, usize)> {
        vec![("states", self.states.len()), ("controls", self.controls.len())]
    }

    fn position_m(&self, node: usize) -> [f64; 3] {
        self.states[node].position_m()
    }

    fn velocity_mps(&self, node: usize) -> [f64; 3] {
        self.states[node].velocity_mps()
    }

    fn numbers(&self) -> Vec<f64> {
        let states = self.states.iter().flat_map(|state| state.to_array());
        let controls = self.controls.iter().flat_map(|control| control.to_array());
        self.times_s.iter().copied().chain(states).chain(controls).collect()
    }

    fn csv_cells(&self, node: usize) -> Vec<String> {
        let numbers = self.states[node].to_array().into_iter().chain(self.controls[node].to_array());
        numbers.map(|number| format!("{number:?}")).collect()
    }
}

impl From<Trajectory> for crate::Trajectory {
    fn from(trajectory: Trajectory) -> Self {
        Self::FixedWing(trajectory)
    }
}

impl crate::Trajectory {
    /// The trajectory of a fixed wing.
    ///
    /// # Panics
    ///
    /// Panics if the vehicle is of another family, which the import of plans excludes.
    pub fn fixed_wing(&self) -> &Trajectory {
        match self {
            Self::FixedWing(trajectory) => trajectory,
            _ => panic!("the trajectory of {} is not that of a fixed wing", self.vehicle()),
        }
    }
}
