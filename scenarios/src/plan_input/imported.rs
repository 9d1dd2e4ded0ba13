use crate::curve::Curve;
use crate::{Trajectory, fixed_wing, multirotor};

/// The planned motion of one vehicle as a file gives it.
#[derive(Clone, Debug, PartialEq)]
pub enum ImportedTrajectory {
    /// Complete.
    Complete(Trajectory),
    /// Of a fixed wing, with or without velocities and controls, which can be reconstructed.
    Partial(fixed_wing::PartialTrajectory),
    /// Of a multirotor, by positions alone.
    Positions(multirotor::Positions),
    /// Polynomial pieces.
    Curve(Curve),
}

impl ImportedTrajectory {
    /// Position at the first node, m.
    pub fn first_position_m(&self) -> [f64; 3] {
        match self {
            Self::Complete(trajectory) => trajectory.nodes().position_m(0),
            Self::Partial(trajectory) => trajectory.positions_m[0],
            Self::Positions(positions) => positions.positions_m[0],
            Self::Curve(curve) => curve.first_position_m().unwrap_or([f64::NAN; 3]),
        }
    }

    /// Positions at the first and the last node, m; `None` without nodes.
    pub fn end_positions_m(&self) -> Option<[[f64; 3]; 2]> {
        let last_m = match self {
            Self::Complete(trajectory) => trajectory.nodes().position_m(trajectory.node_count().checked_sub(1)?),
            Self::Partial(trajectory) => *trajectory.positions_m.last()?,
            Self::Positions(positions) => *positions.positions_m.last()?,
            Self::Curve(curve) => curve.pieces.last()?.position_m(1.0),
        };
        Some([self.first_position_m(), last_m])
    }
}
