//! The reference in the log of a multirotor, which should be that of the plan.

use nalgebra::Vector3;
use scenarios::{Scenario, Trajectory, Vehicle};
use sim::multirotor::Reference;
use sim::{Sample, VehicleLog};

use crate::verdict::compare::is_smaller;
use crate::verdict::flown_reference::strays;

/// A reference that jumps, because one plan made in the loop replaces another, jumps within this of the logged time, s.
const JUMP_S: f64 = 1e-9;

/// The first instant at which the log's reference differs from the plan's.
pub fn defect(_: &Scenario, _: &Vehicle, trajectory: &Trajectory, log: &VehicleLog) -> Option<String> {
    let trajectory = trajectory.multirotor();
    let reference = Reference::new(trajectory.nodes());
    // Beyond the arrival an in-loop planner's reference is not part of the motion that was followed.
    let end_s = trajectory.times_s.last()? + JUMP_S;
    let followed = log.samples.iter().take_while(|sample| sample.t_s <= end_s);
    followed
        .map(|sample| (sample, nearest(&reference, sample)))
        .find_map(|(sample, planned_m)| strays("", sample.t_s, sample.reference_position_m, &planned_m))
}

/// The planned position on the side of a jump on which the log is, m.
fn nearest(reference: &Reference, sample: &Sample) -> Vector3<f64> {
    let sides_m = [0.0, -JUMP_S, JUMP_S].map(|beside_s| reference.at(sample.t_s + beside_s).position_m);
    let logged_m = Vector3::from(sample.reference_position_m);
    let [at_m, before_m, after_m] = sides_m.map(|planned_m| (planned_m, (planned_m - logged_m).norm()));
    [before_m, after_m].into_iter().fold(at_m, |best, side| if is_smaller(side.1, best.1) { side } else { best }).0
}
