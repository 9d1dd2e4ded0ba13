mod conditions;
mod fixed_wing;
mod log;
mod multirotor;
mod plan;
mod slung_load;
pub mod tightened_limits;

use scenarios::Family;

use super::{Fault, ReferenceCase};

/// The faults for a reference: those of all vehicles, those of its family, and those that need a disturbance.
///
/// A reference in still air gets everything but the last, one in wind only the last: the rest would be said twice.
pub fn of(reference: &ReferenceCase) -> Vec<Fault> {
    if reference.scenario.simulation.wind.is_some() {
        return conditions::faults();
    }
    let family = reference.family();
    let of_family = match family {
        Family::FixedWing => fixed_wing::faults(),
        Family::SlungLoad => slung_load::faults(),
        Family::Multirotor => return multirotor::faults(reference),
    };
    [plan::faults(), log::faults(), of_family, tightened_limits::faults(family)].into_iter().flatten().collect()
}
