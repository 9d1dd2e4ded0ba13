//! Figures of multirotors: of the flight, and of planning in the loop.

use scenarios::{Plan, Scenario};
use sim::Flight;

use super::{Metrics, SmallestDistances, flight, in_loop};
use crate::verdict::{self, Motion};

/// Measures a flyable plan and, if there is one, its flight.
pub fn measure(scenario: &Scenario, plan: &Plan, flight: Option<&Flight>) -> Metrics {
    let distances = |motions: &[Motion]| distances(scenario, motions);
    Metrics {
        flight: flight.and_then(|flight| flight::measure(scenario, plan, flight, distances)),
        in_loop: flight.and_then(|flight| Some(in_loop::measure(flight, flight.planning.as_ref()?))),
        ..Metrics::default()
    }
}

fn distances(scenario: &Scenario, motions: &[Motion]) -> SmallestDistances {
    SmallestDistances {
        separation_m: verdict::closest_vehicles(motions, scenario.separation_measure()).map(|nearest| nearest.lower_m),
        clearance_m: verdict::multirotor::closest(scenario, motions).map(|nearest| nearest.lower_m),
    }
}
