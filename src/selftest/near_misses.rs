//! What is just inside a limit must pass: a judge that fails everything catches every fault too.

use scenarios::{Cylinder, Family};

use super::faults::cuts::{self, SHARE};
use super::{NearMiss, Specimen};

/// Distance from a limit, m.
const NEAR_M: f64 = 1e-5;

/// The near misses of a specimen. In wind there are none beyond the specimen itself.
pub fn of(specimen: &Specimen) -> Vec<NearMiss> {
    if specimen.scenario.simulation.wind.is_some() {
        return Vec::new();
    }
    let mut all: Vec<NearMiss> = cuts::at_most(specimen.family()).map(just_above).collect();
    all.extend(whole());
    all.extend(match specimen.family() {
        Family::FixedWing => fixed_wing(),
        Family::SlungLoad => slung_load(),
        Family::Multirotor => Vec::new(),
    });
    all
}

/// A limit just above the largest of the values that it decides.
fn just_above(cut: &'static cuts::Cut) -> NearMiss {
    NearMiss::new(cut.name, |it: &mut Specimen| {
        let reached = cut.checks.iter().map(|check| it.value(check)).fold(0.0, f64::max);
        // What two integrators disagree on is no margin.
        let unsure_m = 2.0 * it.value("flight.dynamics");
        (cut.set)(it, reached * (1.0 + SHARE) + unsure_m);
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

fn fixed_wing() -> Vec<NearMiss> {
    vec![
        NearMiss::new("vehicles as near to each other as they may be", |it| {
            let groups = ["nodes.separation", "plan.separation", "flight.separation"];
            let nearest_m = groups.iter().map(|check| it.value(check)).fold(f64::INFINITY, f64::min);
            let unsure_m = 2.0 * it.value("flight.dynamics");
            cuts::keep_apart(it, nearest_m - NEAR_M - unsure_m);
        }),
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

fn slung_load() -> Vec<NearMiss> {
    vec![
        NearMiss::new("an envelope as near to the block as it may be", |it| {
            let nearest_m = it.value("nodes.envelope").min(it.value("plan.envelope"));
            cuts::keep_apart(it, nearest_m - NEAR_M);
        }),
        NearMiss::new("thrusts as large as the rotors give", |it| {
            let flown = it.samples(0).iter_mut().flat_map(|it| super::specimen::thrusts(it).control.thrust_n);
            let largest_n = flown.fold(0.0, f64::max);
            let promised_n = it.slung_load_model().planning_limits.thrust_n.max + 1e-4;
            let planned = it.slung_load().controls.iter().flat_map(|control| control.thrust_n);
            let planned_n = planned.fold(promised_n, f64::max);
            it.slung_load_model().limits.thrust_n.max = largest_n.max(planned_n) + NEAR_M;
        }),
    ]
}
