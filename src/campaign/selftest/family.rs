use scenarios::Family;

use super::edit_trajectory::AsEditable;
use super::faults::tightened_limits::FamilyLimits;
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
    /// Limits that are tightened until they are violated, besides those of all families.
    pub limits: FamilyLimits,
    /// Access to a trajectory of this family.
    pub edit: AsEditable,
}
