mod conditions;
pub mod cuts;
mod fixed_wing;
mod log;
mod multirotor;
mod plan;
mod slung_load;

use scenarios::Family;

use super::{Fault, Specimen};

/// The faults for a specimen: those of all vehicles, those of its family, and those that need a disturbance.
///
/// A specimen in still air gets everything but the last, one in wind only the last: the rest would be said twice.
pub fn of(specimen: &Specimen) -> Vec<Fault> {
    if specimen.scenario.simulation.wind.is_some() {
        return conditions::faults();
    }
    let family = specimen.family();
    let of_family = match family {
        Family::FixedWing => fixed_wing::faults(),
        Family::SlungLoad => slung_load::faults(),
        Family::Multirotor => return multirotor::faults(specimen),
    };
    [plan::faults(), log::faults(), of_family, cuts::faults(family)].into_iter().flatten().collect()
}
