mod bodies;
mod conditions;
pub mod log;
pub mod places;
pub mod plan;
pub mod requirements;
mod solids;
pub mod tightened_limits;

use self::tightened_limits::FamilyLimits;
use super::{Fault, ReferenceCase};

/// The faults for a reference case: in still air those of its family, in wind those that need a disturbance.
pub fn of(reference: &ReferenceCase, of_family: fn(&ReferenceCase) -> Vec<Fault>) -> Vec<Fault> {
    if reference.scenario.simulation.wind.is_some() {
        return conditions::faults();
    }
    of_family(reference)
}

/// The faults that all families have in common, with those of one family among them.
pub fn with_common(of_family: Vec<Fault>, limits: &'static FamilyLimits) -> Vec<Fault> {
    let all = [
        plan::faults(),
        log::faults(),
        places::faults(),
        requirements::faults(),
        of_family,
        tightened_limits::faults(limits),
    ];
    all.into_iter().flatten().collect()
}
