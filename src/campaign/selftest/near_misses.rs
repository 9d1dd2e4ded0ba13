//! What is just inside a limit must pass: a judge that fails everything catches every fault too.

use scenarios::multirotor::Plant;
use scenarios::{BoxObstacle, Cylinder, Family};

use super::faults::tightened_limits::{self, SHARE};
use super::{NearMiss, ReferenceCase};

/// Distance from a limit, m.
const NEAR_M: f64 = 1e-5;

/// The near misses of a reference. In wind there are none beyond the reference itself.
pub fn of(reference: &ReferenceCase) -> Vec<NearMiss> {
    if reference.scenario.simulation.wind.is_some() {
        return Vec::new();
    }
    match reference.family() {
        Family::FixedWing => joined([limits(reference), whole(), vec![as_near_as_may_be()], fixed_wing()]),
        Family::SlungLoad => joined([limits(reference), whole(), Vec::new(), slung_load()]),
        Family::Multirotor if reference.is_planned_in_the_loop() => in_the_loop(reference),
        Family::Multirotor => joined([limits(reference), whole(), vec![as_near_as_may_be()], multirotor()]),
    }
}

fn joined(parts: [Vec<NearMiss>; 4]) -> Vec<NearMiss> {
    parts.into_iter().flatten().collect()
}

fn limits(reference: &ReferenceCase) -> Vec<NearMiss> {
    tightened_limits::at_most(reference.family()).map(just_above).collect()
}

/// A limit just above the largest of the values that it decides.
fn just_above(limit: &'static tightened_limits::TightenedLimit) -> NearMiss {
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

fn as_near_as_may_be() -> NearMiss {
    NearMiss::new("vehicles as near to each other as they may be", |it| {
        let groups = ["nodes.separation", "plan.separation", "flight.separation"];
        let nearest_m = groups.iter().map(|check| it.value(check)).fold(f64::INFINITY, f64::min);
        let unsure_m = 2.0 * it.value("flight.dynamics");
        tightened_limits::keep_apart(it, nearest_m - NEAR_M - unsure_m);
    })
}

fn fixed_wing() -> Vec<NearMiss> {
    vec![
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
            tightened_limits::keep_apart(it, nearest_m - NEAR_M);
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

fn multirotor() -> Vec<NearMiss> {
    vec![
        NearMiss::new("a pole that a rotor just clears", |it| {
            let (middle, reach_m) = (it.planned_steps() / 2, it.multirotor_model().body_radius_m);
            let [x_m, y_m, _] = it.samples(0)[middle].position_m;
            let aside_m = reach_m + 0.01 + distance_m(it);
            it.scenario.world.boxes.push(BoxObstacle {
                name: "planted".to_owned(),
                center_m: [x_m, y_m - aside_m],
                size_m: [0.02, 0.02],
                heading_deg: 0.0,
                z_m: None,
            });
        }),
        NearMiss::new("a flight as fast as the vehicle may be", |it| {
            let planned_mps = it.multirotor_model().planning_limits.speed_mps;
            let airspeed = |sample: &sim::Sample| sample.air_velocity_mps().iter().map(|v| v * v).sum::<f64>().sqrt();
            let samples = it.flight().vehicles.iter().flat_map(|log| &log.samples);
            let fastest_mps = samples.map(airspeed).fold(planned_mps, f64::max);
            it.multirotor_model().limits.speed_mps = fastest_mps + NEAR_M;
        }),
    ]
}

/// What is left between a vehicle and a pole that it just clears, m: the resolution of the search, and what is known of the
/// flight between its samples.
fn distance_m(it: &ReferenceCase) -> f64 {
    2e-4 + 10.0 * it.value("flight.dynamics")
}

fn in_the_loop(reference: &ReferenceCase) -> Vec<NearMiss> {
    let mut all = vec![NearMiss::new("an answer that is there at its deadline", |it| {
        let deadline_s = it.scenario.simulation.planning.deadline_s;
        let mut slow = it.scenario.clone();
        slow.simulation.planning.median_s = deadline_s;
        it.fly_in(&slow);
        it.scenario = slow;
    })];
    let has_rotors = reference.scenario.models.multirotor.values().any(|model| model.plant == Plant::Quadrotor);
    if has_rotors {
        all.push(NearMiss::new("a quadrotor that tilts as far as it may", |it| {
            let tilt_deg = |sample: &sim::Sample| {
                let [x, y, ..] = sample.world_from_body;
                (1.0 - 2.0 * (x * x + y * y)).acos().to_degrees()
            };
            let most_deg = it.samples(0).iter().map(tilt_deg).fold(0.0, f64::max);
            it.multirotor_model().airframe.iter_mut().for_each(|airframe| airframe.tilt_deg = most_deg + 1e-6);
        }));
    }
    if !reference.scenario.world.moving.is_empty() {
        all.push(NearMiss::new("carts that are as wide as they may be", |it| {
            let room_m = it.value("flight.clearance") - distance_m(it);
            it.scenario.world.moving.iter_mut().for_each(|cart| cart.radius_m += room_m);
        }));
    }
    all
}
