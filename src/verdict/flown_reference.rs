//! Is what the log calls the plan's reference what the plan asks for?
//!
//! Tracking is measured against the reference in the log. A log whose reference is another plan's, or follows the vehicle
//! instead of the plan, would show a perfect tracking.

use nalgebra::Vector3;
use scenarios::{Scenario, Trajectory, Vehicle};
use sim::slung_load::Plant;
use sim::{Sample, VehicleLog, fixed_wing, multirotor, slung_load};

use crate::verdict::compare::{exceeds, is_smaller};

/// The two may differ by this, m: what rounding leaves.
const TOLERANCE_M: f64 = 1e-6;
/// A reference that jumps, because a plan made in the loop takes the place of another, jumps within this of its time, s.
const JUMP_S: f64 = 1e-9;

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
        Trajectory::Multirotor(trajectory) => {
            let reference = multirotor::Reference::new(trajectory.nodes());
            // What a planner in the loop asks for beyond the arrival is no part of what was followed.
            let end_s = trajectory.times_s.last()? + JUMP_S;
            let followed = log.samples.iter().take_while(|sample| sample.t_s <= end_s);
            followed
                .map(|sample| (sample, nearest(&reference, sample)))
                .find_map(|(sample, asked_m)| strays("", sample.t_s, sample.reference_position_m, &asked_m))
        }
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

/// What a reference asks for on the side of a jump on which the log is, m.
fn nearest(reference: &multirotor::Reference, sample: &Sample) -> Vector3<f64> {
    let sides_m = [0.0, -JUMP_S, JUMP_S].map(|beside_s| reference.at(sample.t_s + beside_s).position_m);
    let logged_m = Vector3::from(sample.reference_position_m);
    let [at_m, before_m, after_m] = sides_m.map(|asked_m| (asked_m, (asked_m - logged_m).norm()));
    [before_m, after_m].into_iter().fold(at_m, |best, side| if is_smaller(side.1, best.1) { side } else { best }).0
}

fn strays(whose: &str, t_s: f64, logged_m: [f64; 3], asked_m: &Vector3<f64>) -> Option<String> {
    let distance_m = (Vector3::from(logged_m) - asked_m).norm();
    exceeds(distance_m, TOLERANCE_M).then(|| {
        format!("at {t_s:.3} s the log's reference{whose} is {distance_m:.3e} m away from what the plan asks for")
    })
}
