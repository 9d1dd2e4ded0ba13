use crate::{Trajectory, fixed_wing};

/// The planned motion of one vehicle as a file gives it.
#[derive(Clone, Debug, PartialEq)]
pub enum ImportedTrajectory {
    /// Complete.
    Complete(Trajectory),
    /// Of a fixed wing, with or without velocities and controls, which can be reconstructed.
    Partial(fixed_wing::PartialTrajectory),
}

impl ImportedTrajectory {
    /// Position at the first node, m.
    pub fn first_position_m(&self) -> [f64; 3] {
        match self {
            Self::Complete(trajectory) => trajectory.nodes().position_m(0),
            Self::Partial(trajectory) => trajectory.positions_m[0],
        }
    }
}
