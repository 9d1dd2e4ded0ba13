//! Where the bodies of a reference case are, for faults that put something in their way.

use scenarios::{Range, World};

use super::super::{Fault, ReferenceCase};

/// Beyond every path, m.
pub const FAR_M: f64 = 1e6;
/// Distance of a boundary from a centre, as a fraction of the body's radius.
pub const WITHIN_BODY: f64 = 0.5;

/// Places an obstacle or a boundary near a centre, m, at a distance, m, that is within the body.
pub type Placed = fn(&mut World, [f64; 3], f64);

/// The fault of something within the body of the first vehicle where a plan or a flight ends.
pub fn near_body(check: &'static str, &(name, place): &(&'static str, Placed)) -> Fault {
    Fault::new(check, name, move |it| {
        let centre_m = end_m(it, check);
        let near_m = WITHIN_BODY * body_radius_m(it, 0);
        place(&mut it.scenario.world, centre_m, near_m);
    })
}

/// Where the first vehicle of a plan, or of its flight, is at the planned end.
pub fn end_m(it: &mut ReferenceCase, check: &str) -> [f64; 3] {
    if check.starts_with("flight.") {
        let last = it.planned_steps() - 1;
        return it.samples(0)[last].position_m;
    }
    let trajectory = &it.plan.trajectories[0];
    trajectory.nodes().position_m(trajectory.times_s().len() - 1)
}

/// Radius of the body of a vehicle, m.
pub fn body_radius_m(it: &ReferenceCase, vehicle: usize) -> f64 {
    it.scenario.model(&it.scenario.vehicles[vehicle]).body_radius_m()
}

/// The ranges of the positions of all bodies, with the largest tracking error added.
pub fn occupied(it: &ReferenceCase) -> [Range; 3] {
    let logs = it.flight.iter().flat_map(|flight| flight.vehicles.iter().enumerate());
    let mut ranges = [Range::new(f64::INFINITY, f64::NEG_INFINITY); 3];
    for (vehicle, log) in logs {
        let beyond_m = body_radius_m(it, vehicle) + it.scenario.limits().tracking_max_m;
        let positions_m = log.samples.iter().map(|sample| sample.position_m);
        for position_m in positions_m.chain(log.loads.iter().map(|load| load.position_m)) {
            for (range, value_m) in ranges.iter_mut().zip(position_m) {
                *range = Range::new(range.min.min(value_m - beyond_m), range.max.max(value_m + beyond_m));
            }
        }
    }
    ranges
}
