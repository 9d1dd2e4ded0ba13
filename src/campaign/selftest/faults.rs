mod conditions;
pub mod log;
pub mod plan;
pub mod tightened_limits;

use super::{Fault, ReferenceCase};

/// The faults for a reference case: in still air those of its family, in wind those that need a disturbance.
pub fn of(reference: &ReferenceCase) -> Vec<Fault> {
    if reference.scenario.simulation.wind.is_some() {
        return conditions::faults();
    }
    (reference.selftest.faults)(reference)
}

/// The faults that all families have in common, with those of one family among them.
pub fn with_common(of_family: Vec<Fault>, reference: &ReferenceCase) -> Vec<Fault> {
    let all = [plan::faults(), log::faults(), of_family, tightened_limits::faults(reference.selftest)];
    all.into_iter().flatten().collect()
}
