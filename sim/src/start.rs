//! Where vehicles really start.

use nalgebra::Vector3;
use rand_distr::{Distribution, UnitDisc};
use scenarios::{Scenario, Vehicle};

use crate::FlightOptions;

/// True start of a vehicle relative to its nominal one, world frame, m: what the setup asks for, and a draw from the disc
/// that the scenario asks for.
pub fn offset_m(scenario: &Scenario, vehicle: &Vehicle, setup: &FlightOptions, seed: u64) -> Vector3<f64> {
    let mut rng = scenarios::stream(seed, &format!("start/{}", vehicle.name));
    let [east, north]: [f64; 2] = UnitDisc.sample(&mut rng);
    Vector3::from(setup.start_offset_m) + Vector3::new(east, north, 0.0) * scenario.simulation.mismatch.start_radius_m
}
