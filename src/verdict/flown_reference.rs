//! Is what the log calls the plan's reference what the plan asks for?
//!
//! Tracking is measured against the reference in the log. A log whose reference is another plan's, or follows the vehicle
//! instead of the plan, would show a perfect tracking.

use nalgebra::Vector3;
use scenarios::{Scenario, Trajectory, Vehicle};
use sim::slung_load::Plant;
use sim::{VehicleLog, fixed_wing, slung_load};

use crate::verdict::compare::exceeds;

/// The two may differ by this, m: what rounding leaves.
const TOLERANCE_M: f64 = 1e-6;

/// Where the log's reference is not the plan's, in words.
///
/// - `trajectory`: of the vehicle, flyable
pub fn defect(scenario: &Scenario, vehicle: &Vehicle, trajectory: &Trajectory, log: &VehicleLog) -> Option<String> {
    match trajectory {
        Trajectory::FixedWing(trajectory) => {
            let reference = fixed_wing::Reference::new(trajectory);
            log.samples.iter().find_map(|sample| {
                strays("", sample.t_s, sample.reference_position_m, &reference.at(sample.t_s).position_m)
            })
        }
        // Who plans in the loop asks for something else before the trajectory that he had last ends.
        Trajectory::Multirotor(_) => None,
        Trajectory::SlungLoad(trajectory) => {
            let plant = Plant::nominal(scenario.slung_load_model(vehicle), scenario.world.ground_m);
            let reference = slung_load::Reference::new(trajectory, &plant);
            log.samples.iter().zip(&log.loads).find_map(|(sample, load)| {
                let asked = reference.at(sample.t_s).body;
                strays("", sample.t_s, sample.reference_position_m, &asked.position_m)
                    .or_else(|| strays(" for the load", sample.t_s, load.reference_position_m, &asked.load_position_m))
            })
        }
    }
}

fn strays(whose: &str, t_s: f64, logged_m: [f64; 3], asked_m: &Vector3<f64>) -> Option<String> {
    let distance_m = (Vector3::from(logged_m) - asked_m).norm();
    exceeds(distance_m, TOLERANCE_M).then(|| {
        format!("at {t_s:.3} s the log's reference{whose} is {distance_m:.3e} m away from what the plan asks for")
    })
}
