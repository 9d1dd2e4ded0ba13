use serde::{Deserialize, Serialize};

use crate::{Family, fixed_wing, multirotor, slung_load};

/// The planned motion of one vehicle, given at nodes; state and control are those of its family.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "family", rename_all = "kebab-case")]
pub enum Trajectory {
    /// Of a fixed wing.
    FixedWing(fixed_wing::Trajectory),
    /// Of a quadrotor with a load.
    SlungLoad(slung_load::Trajectory),
    /// Of a multirotor.
    Multirotor(multirotor::Trajectory),
}

/// How controls run between two nodes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Interpolation {
    /// Linear in time from node to node.
    FirstOrderHold,
}

/// What the trajectories of all families have in common. A `node` counts from 0, and must be there.
pub trait Nodes {
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
        match self {
            Self::FixedWing(_) => Family::FixedWing,
            Self::SlungLoad(_) => Family::SlungLoad,
            Self::Multirotor(_) => Family::Multirotor,
        }
    }

    /// What does not depend on the family.
    pub fn nodes(&self) -> &dyn Nodes {
        match self {
            Self::FixedWing(trajectory) => trajectory,
            Self::SlungLoad(trajectory) => trajectory,
            Self::Multirotor(trajectory) => trajectory,
        }
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
        self.family() != Family::FixedWing
    }

    /// As one of a fixed wing. Panics if it is another's: whoever took the plan in has seen to that.
    pub fn fixed_wing(&self) -> &fixed_wing::Trajectory {
        match self {
            Self::FixedWing(trajectory) => trajectory,
            _ => panic!("the trajectory of {} is not that of a fixed wing", self.vehicle()),
        }
    }

    /// As one of a quadrotor with a load. Panics if it is another's.
    pub fn slung_load(&self) -> &slung_load::Trajectory {
        match self {
            Self::SlungLoad(trajectory) => trajectory,
            _ => panic!("the trajectory of {} is not that of a slung load", self.vehicle()),
        }
    }

    /// As one of a multirotor. Panics if it is another's.
    pub fn multirotor(&self) -> &multirotor::Trajectory {
        match self {
            Self::Multirotor(trajectory) => trajectory,
            _ => panic!("the trajectory of {} is not that of a multirotor", self.vehicle()),
        }
    }
}

impl From<fixed_wing::Trajectory> for Trajectory {
    fn from(trajectory: fixed_wing::Trajectory) -> Self {
        Self::FixedWing(trajectory)
    }
}

impl From<slung_load::Trajectory> for Trajectory {
    fn from(trajectory: slung_load::Trajectory) -> Self {
        Self::SlungLoad(trajectory)
    }
}

impl From<multirotor::Trajectory> for Trajectory {
    fn from(trajectory: multirotor::Trajectory) -> Self {
        Self::Multirotor(trajectory)
    }
}
