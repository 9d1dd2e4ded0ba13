//! The one table of vehicle families: how the simulator flies each of them.
//!
//! A family's folder holds its plant, its reference and its tracker, and the equations of motion in which the judge
//! replays its flights. The kinds of control that a log can hold are listed in [`Actuation`](crate::Actuation).

use scenarios::Family;

use crate::flight::FleetLog;
use crate::request::{FlightRequest, ReferenceSource};
use crate::{fixed_wing, multirotor, slung_load};

/// Simulates the fleet of a scenario. `progress` is called about once per simulated second with the simulated time, s.
///
/// # Panics
///
/// If the source is not one that the family can follow.
pub(crate) fn simulate(
    request: &FlightRequest<'_>,
    source: ReferenceSource<'_>,
    progress: &mut dyn FnMut(f64),
) -> FleetLog {
    match request.scenario.family() {
        Family::FixedWing => fixed_wing::simulate(request, source.plan(), progress),
        Family::SlungLoad => slung_load::simulate(request, source.plan(), progress),
        Family::Multirotor => multirotor::simulate(request, source, progress),
    }
}
