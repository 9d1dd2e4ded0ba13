//! Goals that lie beyond or just within a tolerance of where the vehicles were sent.

use scenarios::{AppliedLimits, Waypoint};

use crate::campaign::selftest::{Fault, NearMiss, ReferenceCase};

/// A part of a goal.
struct Part {
    /// Its value lies beyond the tolerance.
    fault: &'static str,
    /// Its value lies just within the tolerance.
    near_miss: &'static str,
    tolerance: fn(&AppliedLimits) -> f64,
    field: fn(&mut Waypoint) -> &mut f64,
}

const PARTS: &[Part] = &[
    Part {
        fault: "the goals lie higher than the vehicles were sent",
        near_miss: "goals just within the tolerance of their position",
        tolerance: |limits| limits.goal_m,
        field: |goal| &mut goal.z_m,
    },
    Part {
        fault: "the goals have another heading",
        near_miss: "goals just within the tolerance of their heading",
        tolerance: |limits| limits.goal_heading_deg,
        field: |goal| &mut goal.heading_deg,
    },
    Part {
        fault: "the goals have another flight-path angle",
        near_miss: "goals just within the tolerance of their flight-path angle",
        tolerance: |limits| limits.goal_flight_path_deg,
        field: |goal| &mut goal.flight_path_deg,
    },
    Part {
        fault: "the goals have another speed",
        near_miss: "goals just within the tolerance of their speed",
        tolerance: |limits| limits.goal_speed_mps,
        field: |goal| &mut goal.speed_mps,
    },
];

/// The checks of the goals.
const CHECKS: [&str; 3] = ["nodes.goal", "plan.goal", "flight.goal"];
/// Distance of a fault from its tolerance, as a fraction of it: more than the flight in wind misses its goal by.
const BEYOND: f64 = 0.5;
/// Distance of a near miss from its tolerance, as a fraction of it: more than the flight without wind misses its goal by.
const WITHIN: f64 = 1e-3;

/// Every part of the goals beyond its tolerance, in plan and flight.
pub fn faults() -> impl Iterator<Item = Fault> {
    let every = PARTS.iter().flat_map(|part| CHECKS.map(|check| (part, check)));
    every.map(|(part, check)| Fault::new(check, part.fault, |it| move_goals(it, part, 1.0 + BEYOND)))
}

/// Every part of the goals just within its tolerance.
pub fn near_misses() -> impl Iterator<Item = NearMiss> {
    PARTS.iter().map(|part| NearMiss::new(part.near_miss, |it| move_goals(it, part, 1.0 - WITHIN)))
}

/// - `by`: as a fraction of the tolerance
fn move_goals(it: &mut ReferenceCase, part: &Part, by: f64) {
    let by = by * (part.tolerance)(&it.scenario.limits());
    it.scenario.vehicles.iter_mut().for_each(|vehicle| *(part.field)(&mut vehicle.goal) += by);
}
