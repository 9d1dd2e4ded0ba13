use serde::{Deserialize, Serialize};

use crate::{Family, Trajectory};

/// How controls run between two nodes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Interpolation {
    /// Linear in time from node to node.
    FirstOrderHold,
}

/// What the trajectories of all families have in common. A `node` counts from 0, and must be there.
pub trait TrajectoryNodes {
    /// The family of the vehicle.
    fn family(&self) -> Family;
    /// Name of the vehicle.
    fn vehicle(&self) -> &str;
    /// Times of the nodes, s.
    fn times_s(&self) -> &[f64];
    /// What there should be one of at every node, and how many there are.
    fn counts(&self) -> Vec<(&'static str, usize)>;
    /// Position of the vehicle at a node, world frame, m.
    fn position_m(&self, node: usize) -> [f64; 3];
    /// Velocity of the vehicle at a node, world frame, m/s.
    fn velocity_mps(&self, node: usize) -> [f64; 3];
    /// Every number in it.
    fn numbers(&self) -> Vec<f64>;
    /// Columns of the family's CSV form, `vehicle` and `t_s` first.
    fn csv_columns(&self) -> &'static [&'static str];
    /// One row of the CSV form, without vehicle and time. Numbers read back as they were, to the last bit.
    fn csv_cells(&self, node: usize) -> Vec<String>;
}

impl Trajectory {
    /// The family of the vehicle that it is for.
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

    /// Number of nodes at which everything is there.
    pub fn node_count(&self) -> usize {
        let counts = self.nodes().counts().into_iter().map(|(_, count)| count);
        counts.fold(self.times_s().len(), usize::min)
    }

    /// Time of the last node, s.
    pub fn end_s(&self) -> Option<f64> {
        self.times_s().last().copied()
    }

    /// May two nodes share a time, before and after a jump? A cable that becomes taut makes one, and so does a planner in the
    /// loop that changes its mind.
    pub fn allows_discontinuity(&self) -> bool {
        self.family().spec().columns.allows_discontinuity
    }
}
