//! Changes to a planned trajectory that are the same for every family.

use scenarios::Trajectory;

/// Access to a trajectory of one family. Panics for a trajectory of another.
pub type AsEditable = fn(&mut Trajectory) -> &mut dyn EditTrajectory;

/// Changes to a planned trajectory.
pub trait EditTrajectory {
    /// Name of the vehicle.
    fn vehicle(&mut self) -> &mut String;
    /// Times of the nodes, s.
    fn times_s(&mut self) -> &mut Vec<f64>;
    /// Removes all nodes but the first `nodes`.
    fn truncate(&mut self, nodes: usize);
    /// Moves all nodes north, m.
    fn move_north(&mut self, by_m: f64);
}
