mod conditions;
pub mod fixed_wing;
mod log;
pub mod multirotor;
mod plan;
pub mod slung_load;
pub mod tightened_limits;

use super::family::FamilySelftest;
use super::{Fault, ReferenceCase};
use crate::families;

/// The faults for a reference: those of all vehicles, those of its family, and those that need a disturbance.
///
/// A reference in still air gets everything but the last, one in wind only the last: the rest would be said twice.
pub fn of(reference: &ReferenceCase) -> Vec<Fault> {
    if reference.scenario.simulation.wind.is_some() {
        return conditions::faults();
    }
    (families::of(reference.family()).selftest.faults)(reference)
}

/// The faults of any plan and any log, those of the family, and its tightened limits.
pub fn with_limits(own: Vec<Fault>, family: &'static FamilySelftest) -> Vec<Fault> {
    [plan::faults(), log::faults(), own, tightened_limits::faults(family)].into_iter().flatten().collect()
}
