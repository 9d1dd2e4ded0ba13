//! The reference in the log of a fixed wing, which should be that of the plan.

use scenarios::{Scenario, Trajectory, Vehicle};
use sim::{VehicleLog, fixed_wing};

use crate::verdict::flown_reference::strays;

/// The first instant at which the log's reference differs from the plan's.
pub fn defect(_: &Scenario, _: &Vehicle, trajectory: &Trajectory, log: &VehicleLog) -> Option<String> {
    let reference = fixed_wing::Reference::new(trajectory.fixed_wing());
    log.samples
        .iter()
        .find_map(|sample| strays("", sample.t_s, sample.reference_position_m, &reference.at(sample.t_s).position_m))
}
