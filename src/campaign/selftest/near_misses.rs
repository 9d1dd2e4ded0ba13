//! Plans and flights just inside a limit. They must pass: a judge that fails everything catches every fault, too.

use super::faults::tightened_limits::{self, FamilyLimits, RELATIVE_STEP, TightenedLimit};
use super::{NearMiss, ReferenceCase};

/// Distance from a limit, m.
pub const NEAR_M: f64 = 1e-5;

/// The near misses for a reference case: in still air those of its family, in wind none beyond the case itself.
pub fn of(reference: &ReferenceCase, of_family: fn(&ReferenceCase) -> Vec<NearMiss>) -> Vec<NearMiss> {
    if reference.scenario.simulation.wind.is_some() {
        return Vec::new();
    }
    of_family(reference)
}

/// Every upper limit just above the largest value that it bounds.
pub fn limits(limits: &FamilyLimits) -> Vec<NearMiss> {
    tightened_limits::upper(limits).map(just_above).collect()
}

fn just_above(limit: &'static TightenedLimit) -> NearMiss {
    NearMiss::new(limit.name, |it: &mut ReferenceCase| {
        let reached = limit.checks.iter().map(|check| it.value(check)).fold(0.0, f64::max);
        let bound = reached * (1.0 + RELATIVE_STEP) + integration_error_m(it);
        (limit.set)(it, bound);
    })
}

/// Plans and flights that are barely complete.
pub fn whole() -> Vec<NearMiss> {
    vec![
        NearMiss::new("the flight ends with its plan", |it| {
            let planned = it.planned_steps() + 1;
            it.flight().vehicles.iter_mut().for_each(|log| {
                log.samples.truncate(planned + 1);
                log.loads.truncate(planned + 1);
            });
        }),
        NearMiss::new("the plan's last time is off by a rounding error", |it| {
            let last = it.times_s(0).len() - 1;
            it.times_s(0)[last] *= 1.0 + f64::EPSILON;
        }),
    ]
}

/// A separation just below the smallest distance between vehicles.
pub fn separation() -> NearMiss {
    NearMiss::new("vehicles just beyond their separation", |it| {
        let groups = ["nodes.separation", "plan.separation", "flight.separation"];
        let nearest_m = groups.iter().map(|check| it.value(check)).fold(f64::INFINITY, f64::min);
        let limit_m = nearest_m - NEAR_M - integration_error_m(it);
        tightened_limits::set_separation(it, limit_m);
    })
}

/// Below this margin checks are undecided, m.
fn integration_error_m(it: &ReferenceCase) -> f64 {
    2.0 * it.value("flight.dynamics")
}
