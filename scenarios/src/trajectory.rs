use serde::{Deserialize, Serialize};

use crate::{Family, Trajectory};

/// Interpolation of the controls between nodes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Interpolation {
    /// Linear in time (first-order hold).
    FirstOrderHold,
}

/// What the trajectories of all families have in common. Functions of a `node` (its index, from 0) panic if it does not
/// exist.
pub trait TrajectoryNodes {
    /// The family of the vehicle.
    fn family(&self) -> Family;
    /// Name of the vehicle.
    fn vehicle(&self) -> &str;
    /// Times of the nodes, s.
    fn times_s(&self) -> &[f64];
    /// The quantities given at every node (`states`, `controls`), with the number of their values.
    fn counts(&self) -> Vec<(&'static str, usize)>;
    /// Position of the vehicle at a node, world frame, m.
    fn position_m(&self, node: usize) -> [f64; 3];
    /// Velocity of the vehicle at a node, world frame, m/s.
    fn velocity_mps(&self, node: usize) -> [f64; 3];
    /// Every number of the trajectory.
    fn numbers(&self) -> Vec<f64>;
    /// One row of a CSV file, without vehicle and time. Numbers are read back exactly.
    fn csv_cells(&self, node: usize) -> Vec<String>;
}

impl Trajectory {
    /// The family of the vehicle.
    pub fn family(&self) -> Family {
        self.nodes().family()
    }

    /// Name of the vehicle.
    pub fn vehicle(&self) -> &str {
        self.nodes().vehicle()
    }

    /// Times of the nodes, s.
    pub fn times_s(&self) -> &[f64] {
        self.nodes().times_s()
    }

    /// Number of nodes at which all quantities are given.
    pub fn node_count(&self) -> usize {
        let counts = self.nodes().counts().into_iter().map(|(_, count)| count);
        counts.fold(self.times_s().len(), usize::min)
    }

    /// Time of the last node, s.
    pub fn end_s(&self) -> Option<f64> {
        self.times_s().last().copied()
    }

    /// Whether two nodes may share a time, before and after a jump in velocity: a cable that becomes taut causes one, and so
    /// does an in-loop planner that replaces its reference.
    pub fn allows_discontinuity(&self) -> bool {
        self.family().spec().columns.allows_discontinuity
    }
}
