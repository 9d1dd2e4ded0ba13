use serde::{Deserialize, Serialize};

use super::{Cable, Control, State};
use crate::{Family, Interpolation, TrajectoryNodes};

/// Columns of a written slung-load plan: time, state, control and cable, one row per vehicle and node. World frame, SI,
/// radians. `cable` is `taut` or `slack` from this node to the next; `at_node` is `yes` where the planner imposed its
/// constraints, `no` at samples between. The last six columns follow from the others.
pub const CSV_COLUMNS: [&str; 32] = [
    "vehicle",
    "t_s",
    "x_m",
    "y_m",
    "z_m",
    "vx_mps",
    "vy_mps",
    "vz_mps",
    "roll_rad",
    "pitch_rad",
    "yaw_rad",
    "rate_x_radps",
    "rate_y_radps",
    "rate_z_radps",
    "load_x_m",
    "load_y_m",
    "load_z_m",
    "load_vx_mps",
    "load_vy_mps",
    "load_vz_mps",
    "thrust_1_n",
    "thrust_2_n",
    "thrust_3_n",
    "thrust_4_n",
    "cable",
    AT_NODE,
    "yaw_rate_radps",
    "pitch_rate_radps",
    "roll_rate_radps",
    "alpha_rad",
    "beta_rad",
    "rho_m",
];

/// The first of the columns that follow from the others: Euler rates, and the cable in polar coordinates. They are written
/// for those who compare with Kang, Huang, Wen (2020), and not read.
pub(super) const DERIVED_FROM: usize = 26;

/// The column that tells nodes of the planner from samples.
pub const AT_NODE: &str = "at_node";

/// The planned motion of a quadrotor with a load, given at nodes.
///
/// Two nodes may share a time, before and after the impact in which a slack cable becomes taut.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Trajectory {
    /// Name of the vehicle.
    pub vehicle: String,
    /// Interpolation of the controls between the nodes.
    pub interpolation: Interpolation,
    /// Times of the nodes, s, from 0, non-decreasing.
    pub times_s: Vec<f64>,
    /// States at the nodes.
    pub states: Vec<State>,
    /// Controls at the nodes.
    pub controls: Vec<Control>,
    /// State of the cable from each node to the next; that of the last node applies after the end.
    pub cable: Vec<Cable>,
    /// Indices of the nodes at which the planner imposed its constraints, if the trajectory is sampled more densely. The
    /// checks `nodes.*` apply to these. Empty: all nodes.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub planner_nodes: Vec<usize>,
}

impl Trajectory {
    /// Indices of the nodes at which the planner imposed its constraints.
    pub fn planner_nodes(&self) -> Vec<usize> {
        let count = self.times_s.len();
        match self.planner_nodes.as_slice() {
            [] => (0..count).collect(),
            own => own.iter().copied().filter(|node| *node < count).collect(),
        }
    }
}

impl TrajectoryNodes for Trajectory {
    fn family(&self) -> Family {
        Family::SlungLoad
    }

    fn vehicle(&self) -> &str {
        &self.vehicle
    }

    fn times_s(&self) -> &[f64] {
        &self.times_s
    }

    fn counts(&self) -> Vec<(&'static str, usize)> {
        vec![("states", self.states.len()), ("controls", self.controls.len()), ("cable modes", self.cable.len())]
    }

    fn position_m(&self, node: usize) -> [f64; 3] {
        self.states[node].position_m
    }

    fn velocity_mps(&self, node: usize) -> [f64; 3] {
        self.states[node].velocity_mps
    }

    fn numbers(&self) -> Vec<f64> {
        let states = self.states.iter().flat_map(|state| state.to_array());
        let controls = self.controls.iter().flat_map(|control| control.thrust_n);
        self.times_s.iter().copied().chain(states).chain(controls).collect()
    }

    fn csv_cells(&self, node: usize) -> Vec<String> {
        let numbers = self.states[node].to_array().into_iter().chain(self.controls[node].thrust_n);
        let cable = match self.cable[node] {
            Cable::Taut => "taut",
            Cable::Slack => "slack",
        };
        let is_node = self.planner_nodes.is_empty() || self.planner_nodes.contains(&node);
        let words = [cable, if is_node { "yes" } else { "no" }].map(str::to_owned);
        let state = &self.states[node];
        let derived = state.euler_rates_radps().into_iter().chain(state.polar_cable());
        let cell = |number: f64| format!("{number:?}");
        numbers.map(cell).chain(words).chain(derived.map(cell)).collect()
    }
}

impl From<Trajectory> for crate::Trajectory {
    fn from(trajectory: Trajectory) -> Self {
        Self::SlungLoad(trajectory)
    }
}

impl crate::Trajectory {
    /// The trajectory of a quadrotor with a slung load.
    ///
    /// # Panics
    ///
    /// Panics if the vehicle is of another family, which the import of plans excludes.
    pub fn slung_load(&self) -> &Trajectory {
        match self {
            Self::SlungLoad(trajectory) => trajectory,
            _ => panic!("the trajectory of {} is not that of a quadrotor with a slung load", self.vehicle()),
        }
    }
}
