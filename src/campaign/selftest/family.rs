//! What the selftest has of its own for every vehicle family.

use super::faults::tightened_limits::TightenedLimit;
use super::reference_case::UnflownCase;
use super::{Fault, NearMiss, ReferenceCase};

/// What the selftest does with the vehicles of one family.
pub struct FamilySelftest {
    /// Scenarios to plan, fly and inject faults into: in still air, and with every disturbance.
    pub reference_cases: fn() -> Vec<UnflownCase>,
    /// The faults of a reference case in still air.
    pub faults: fn(&ReferenceCase) -> Vec<Fault>,
    /// The near misses of a reference case in still air.
    pub near_misses: fn(&ReferenceCase) -> Vec<NearMiss>,
    /// Limits that are tightened to just below the value reached.
    pub limits: &'static [TightenedLimit],
    /// The checks of a distance to keep.
    pub distances: &'static [&'static str],
    /// Sets the distance to keep, m.
    pub keep_apart: fn(&mut ReferenceCase, f64),
}
