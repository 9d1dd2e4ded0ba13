//! Near misses of every family: what is just inside a limit must pass, since a judge that fails everything catches every fault.

use super::family::FamilySelftest;
use super::faults::tightened_limits::{self, SHARE, TightenedLimit};
use super::{NearMiss, ReferenceCase};
use crate::families;

/// Distance from a limit, m.
pub const NEAR_M: f64 = 1e-5;

/// The near misses of a reference case. In wind there are none beyond the case itself.
pub fn of(reference: &ReferenceCase) -> Vec<NearMiss> {
    if reference.scenario.simulation.wind.is_some() {
        return Vec::new();
    }
    (families::of(reference.family()).selftest.near_misses)(reference)
}

/// The near misses of tightened limits and of whole plans, then those of the family itself.
pub fn with_limits(own: Vec<NearMiss>, family: &'static FamilySelftest) -> Vec<NearMiss> {
    let mut near_misses: Vec<NearMiss> = tightened_limits::all(family).map(just_above).collect();
    near_misses.extend(whole());
    near_misses.extend(own);
    near_misses
}

/// A limit just above the largest of the values that it decides.
fn just_above(limit: &'static TightenedLimit) -> NearMiss {
    NearMiss::new(limit.name, |it: &mut ReferenceCase| {
        let reached = limit.checks.iter().map(|check| it.value(check)).fold(0.0, f64::max);
        // What two integrators disagree on is no margin.
        let unsure_m = 2.0 * it.value("flight.dynamics");
        (limit.set)(it, reached * (1.0 + SHARE) + unsure_m);
    })
}

fn whole() -> Vec<NearMiss> {
    vec![
        NearMiss::new("the flight ends with its plan", |it| {
            let planned = it.planned_steps() + 1;
            it.flight().vehicles.iter_mut().for_each(|log| {
                log.samples.truncate(planned + 1);
                log.loads.truncate(planned + 1);
            });
        }),
        NearMiss::new("the plan is off by a rounding", |it| {
            let last = it.times_s(0).len() - 1;
            it.times_s(0)[last] *= 1.0 + f64::EPSILON;
        }),
    ]
}

/// Vehicles as near to each other as the separation allows.
pub fn as_near_as_allowed() -> NearMiss {
    NearMiss::new("vehicles as near to each other as they may be", |it| {
        let groups = ["nodes.separation", "plan.separation", "flight.separation"];
        let nearest_m = groups.iter().map(|check| it.value(check)).fold(f64::INFINITY, f64::min);
        let unsure_m = 2.0 * it.value("flight.dynamics");
        it.scenario.fleet.separation_m = Some(nearest_m - NEAR_M - unsure_m);
    })
}
