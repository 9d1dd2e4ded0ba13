//! The selftest of fixed wings.

use scenarios::Cylinder;

use super::family::FamilySelftest;
use super::faults::tightened_limits::{DEFECTS, GOALS, TightenedLimit, limit};
use super::near_misses::{NEAR_M, as_near_as_allowed};
use super::reference_case::{UnflownCase, shipped};
use super::{NearMiss, ReferenceCase, faults, near_misses};

/// What it consists of.
pub const SELFTEST: FamilySelftest = FamilySelftest {
    reference_cases,
    faults: |_| faults::with_limits(faults::fixed_wing::faults(), &SELFTEST),
    near_misses: |_| near_misses::with_limits(own_near_misses(), &SELFTEST),
    limits: LIMITS,
    distances: &["nodes.separation", "plan.separation", "flight.separation"],
    keep_apart,
};

const LIMITS: &[TightenedLimit] = &[
    DEFECTS,
    GOALS,
    limit("the limit of the open-loop error", &["plan.rollout"], |it, limit| {
        it.scenario.verdict.rollout_m = Some(limit);
    }),
    limit("the limit of the spread of arrivals", &["flight.arrival"], |it, limit| {
        it.scenario.verdict.arrival_spread_s = Some(limit);
    }),
];

fn reference_cases() -> Vec<UnflownCase> {
    vec![
        shipped("rendezvous-2", include_str!("../../../scenarios/fixed-wing/rendezvous-2.toml")),
        shipped("rendezvous-7-wind", include_str!("../../../scenarios/fixed-wing/rendezvous-7-wind.toml")),
    ]
}

fn keep_apart(it: &mut ReferenceCase, limit_m: f64) {
    it.scenario.fleet.separation_m = Some(limit_m);
}

fn own_near_misses() -> Vec<NearMiss> {
    vec![
        as_near_as_allowed(),
        NearMiss::new("a pole that a wing just clears", |it| {
            let (middle, wing_m) = (it.steps() / 2, it.fixed_wing_model().body_radius_m);
            let from = it.samples(0)[middle];
            let [vx, vy, _] = from.velocity_mps;
            let (speed_mps, left_m) = (vx.hypot(vy), wing_m + 1.0);
            let [x_m, y_m, _] = from.position_m;
            let center_m = [x_m - left_m * vy / speed_mps, y_m + left_m * vx / speed_mps];
            it.scenario.world.cylinders.push(Cylinder { name: "planted".to_owned(), center_m, radius_m: 0.9 });
        }),
        NearMiss::new("a flight as fast as its wings bear", |it| {
            let airspeed = |sample: &sim::Sample| sample.air_velocity_mps().iter().map(|v| v * v).sum::<f64>().sqrt();
            let fastest = |samples: &[sim::Sample]| samples.iter().map(airspeed).fold(0.0, f64::max);
            let logs = &it.flight().vehicles;
            let fastest_mps = logs.iter().map(|log| fastest(&log.samples)).fold(0.0, f64::max);
            let planned_mps = it.fixed_wing_model().planning_limits.speed_mps.max + 1e-4;
            it.fixed_wing_model().limits.speed_mps.max = fastest_mps.max(planned_mps) + NEAR_M;
        }),
    ]
}
