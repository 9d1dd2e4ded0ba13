//! The references in the log of a quadrotor and its load, which should be those of the plan.

use scenarios::{Scenario, Trajectory, Vehicle};
use sim::VehicleLog;
use sim::slung_load::{Plant, Reference};

use crate::verdict::flown_reference::strays;

/// The first instant at which a reference in the log differs from the plan's.
pub fn defect(scenario: &Scenario, vehicle: &Vehicle, trajectory: &Trajectory, log: &VehicleLog) -> Option<String> {
    let plant = Plant::nominal(scenario.slung_load_model(vehicle), scenario.world.ground_m);
    let reference = Reference::new(trajectory.slung_load(), &plant);
    log.samples.iter().zip(&log.loads).find_map(|(sample, load)| {
        let planned = reference.at(sample.t_s).state;
        strays("", sample.t_s, sample.reference_position_m, &planned.position_m)
            .or_else(|| strays(" for the load", sample.t_s, load.reference_position_m, &planned.load_position_m))
    })
}
