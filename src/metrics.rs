//! Figures of a plan and its flight: those that the fixed-wing papers report, and how near it came to its limits.
//!
//! Wang, Xu, Long (2020), section 5, give for a fleet: flight time, mean speed, standard deviations of speed and
//! altitude, sums of the absolute load factors, smallest distance between vehicles.

pub mod figures;
pub mod fixed_wing;
mod flight;
mod in_loop;
pub mod multirotor;
pub mod over_time;
pub mod slung_load;
pub mod trajectory_error;

use scenarios::{Plan, Scenario};
use sim::Flight;

use crate::{families, verdict};

pub use figures::{FlightMetrics, Metrics, PlanMetrics, SmallestDistances};
pub use in_loop::InLoopMetrics;
pub use slung_load::{CableSwitch, SlungLoadMetrics};

/// Measures a plan and, if there is one, its flight.
pub fn measure(scenario: &Scenario, plan: &Plan, flight: Option<&Flight>) -> Metrics {
    if verdict::is_flyable(scenario, plan).is_err() {
        return Metrics::default();
    }
    let pose_errors = flight.map(trajectory_error::of_fleet).unwrap_or_default();
    Metrics { pose_errors, ..(families::of(scenario.family()).measure)(scenario, plan, flight) }
}

fn finite(value: f64) -> Option<f64> {
    value.is_finite().then_some(value)
}
