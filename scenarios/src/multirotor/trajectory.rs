use serde::{Deserialize, Serialize};

use crate::in_loop::Node;
use crate::{Family, TrajectoryNodes};

/// Columns of a written multirotor plan: time and state, one row per vehicle and node. World frame, SI.
pub const CSV_COLUMNS: [&str; 8] = ["vehicle", "t_s", "x_m", "y_m", "z_m", "vx_mps", "vy_mps", "vz_mps"];

/// State of a multirotor. World frame.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct State {
    /// Position, m.
    pub position_m: [f64; 3],
    /// Velocity, m/s.
    pub velocity_mps: [f64; 3],
}

/// The planned motion of a multirotor, given at nodes.
///
/// Between two nodes it is the cubic with their positions and velocities. Its acceleration is linear in time, so that a
/// double integrator with constant or linear acceleration between the nodes is represented exactly, without accelerations
/// at the nodes. Two nodes may share a time where an in-loop planner replaced its reference.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Trajectory {
    /// Name of the vehicle.
    pub vehicle: String,
    /// Times of the nodes, s, from 0, non-decreasing.
    pub times_s: Vec<f64>,
    /// States at the nodes.
    pub states: Vec<State>,
}

impl Trajectory {
    /// The motion of `vehicle` through `nodes`.
    pub fn through(vehicle: impl Into<String>, nodes: &[Node]) -> Self {
        let state = |node: &Node| State { position_m: node.position_m, velocity_mps: node.velocity_mps };
        Self {
            vehicle: vehicle.into(),
            times_s: nodes.iter().map(|node| node.t_s).collect(),
            states: nodes.iter().map(state).collect(),
        }
    }

    /// The nodes.
    pub fn nodes(&self) -> Vec<Node> {
        let node = |(&t_s, state): (&f64, &State)| Node {
            t_s,
            position_m: state.position_m,
            velocity_mps: state.velocity_mps,
        };
        self.times_s.iter().zip(&self.states).map(node).collect()
    }
}

impl TrajectoryNodes for Trajectory {
    fn family(&self) -> Family {
        Family::Multirotor
    }

    fn vehicle(&self) -> &str {
        &self.vehicle
    }

    fn times_s(&self) -> &[f64] {
        &self.times_s
    }

    fn counts(&self) -> Vec<(&'static str, usize)> {
        vec![("states", self.states.len())]
    }

    fn position_m(&self, node: usize) -> [f64; 3] {
        self.states[node].position_m
    }

    fn velocity_mps(&self, node: usize) -> [f64; 3] {
        self.states[node].velocity_mps
    }

    fn numbers(&self) -> Vec<f64> {
        let states = self.states.iter().flat_map(|state| [state.position_m, state.velocity_mps]).flatten();
        self.times_s.iter().copied().chain(states).collect()
    }

    fn csv_cells(&self, node: usize) -> Vec<String> {
        let State { position_m, velocity_mps } = self.states[node];
        position_m.into_iter().chain(velocity_mps).map(|number| format!("{number:?}")).collect()
    }
}

impl From<Trajectory> for crate::Trajectory {
    fn from(trajectory: Trajectory) -> Self {
        Self::Multirotor(trajectory)
    }
}

impl crate::Trajectory {
    /// The trajectory of a multirotor.
    ///
    /// # Panics
    ///
    /// Panics if the vehicle is of another family, which the import of plans excludes.
    pub fn multirotor(&self) -> &Trajectory {
        match self {
            Self::Multirotor(trajectory) => trajectory,
            _ => panic!("the trajectory of {} is not that of a multirotor", self.vehicle()),
        }
    }
}
