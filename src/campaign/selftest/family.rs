use scenarios::{Family, Trajectory};

use super::faults::tightened_limits::TightenedLimit;
use super::reference_case::UnflownCase;
use super::{Fault, NearMiss, ReferenceCase};

/// What differs between the selftests of the vehicle families.
pub struct FamilySelftest {
    /// The family.
    pub family: Family,
    /// The reference cases: first in still air, then in wind and with sensor noise.
    pub reference_cases: fn() -> Vec<UnflownCase>,
    /// The faults for a reference case in still air.
    pub faults: fn(&ReferenceCase) -> Vec<Fault>,
    /// The near misses for a reference case in still air.
    pub near_misses: fn(&ReferenceCase) -> Vec<NearMiss>,
    /// Upper limits of this family's checks, beside those of all families.
    pub upper_limits: &'static [TightenedLimit],
    /// Checks of the distance that is set by `set_distance`.
    pub distance_checks: &'static [&'static str],
    /// Sets the smallest distance that is allowed, m.
    pub set_distance: fn(&mut ReferenceCase, f64),
    /// Access to a trajectory of this family. Panics for a trajectory of another.
    pub edit: fn(&mut Trajectory) -> &mut dyn EditTrajectory,
}

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
