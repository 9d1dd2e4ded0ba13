//! The selftest of slung loads.

use super::family::FamilySelftest;
use super::faults::tightened_limits::{DEFECTS, GOALS, TightenedLimit, limit};
use super::near_misses::NEAR_M;
use super::reference_case::{UnflownCase, shipped};
use super::{NearMiss, ReferenceCase, faults, near_misses};

/// What it consists of.
pub const SELFTEST: FamilySelftest = FamilySelftest {
    reference_cases,
    faults: |_| faults::with_limits(faults::slung_load::faults(), &SELFTEST),
    near_misses: |_| near_misses::with_limits(own_near_misses(), &SELFTEST),
    limits: LIMITS,
    distances: &["nodes.envelope", "plan.envelope"],
    keep_apart,
};

const LIMITS: &[TightenedLimit] = &[
    DEFECTS,
    GOALS,
    limit("the limit of the speed at the end", &["plan.rest", "flight.rest"], |it, limit| {
        it.scenario.verdict.rest_mps = Some(limit);
    }),
    limit("what the cable bears", &["plan.tension", "flight.tension"], |it, limit| {
        it.slung_load_model().limits.tension_n = limit;
    }),
    limit("the limit of the time between planned and flown switches", &["flight.slack"], |it, limit| {
        it.scenario.verdict.switch_s = Some(limit);
    }),
];

fn reference_cases() -> Vec<UnflownCase> {
    vec![
        shipped("drop-and-catch", include_str!("../../../scenarios/slung/drop-and-catch.toml")),
        shipped("drop-and-catch-wind", include_str!("../../../scenarios/slung/drop-and-catch-wind.toml")),
    ]
}

fn keep_apart(it: &mut ReferenceCase, limit_m: f64) {
    it.scenario.verdict.envelope_m = Some(limit_m);
}

fn own_near_misses() -> Vec<NearMiss> {
    vec![
        NearMiss::new("an envelope as near to the block as it may be", |it| {
            let nearest_m = it.value("nodes.envelope").min(it.value("plan.envelope"));
            keep_apart(it, nearest_m - NEAR_M);
        }),
        NearMiss::new("thrusts as large as the rotors give", |it| {
            let flown = it.samples(0).iter_mut().flat_map(|it| super::reference_case::thrusts(it).control.thrust_n);
            let largest_n = flown.fold(0.0, f64::max);
            let promised_n = it.slung_load_model().planning_limits.thrust_n.max + 1e-4;
            let planned = it.slung_load().controls.iter().flat_map(|control| control.thrust_n);
            let planned_n = planned.fold(promised_n, f64::max);
            it.slung_load_model().limits.thrust_n.max = largest_n.max(planned_n) + NEAR_M;
        }),
    ]
}
