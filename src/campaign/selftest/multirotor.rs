//! The selftest of multirotors: plans made ahead, and planning in the loop.

use scenarios::BoxObstacle;
use scenarios::multirotor::Plant;

use super::family::FamilySelftest;
use super::faults::tightened_limits::{TightenedLimit, limit};
use super::near_misses::{NEAR_M, as_near_as_allowed};
use super::reference_case::{UnflownCase, by, shipped};
use super::{NearMiss, ReferenceCase, faults, near_misses};

/// What it consists of.
pub const SELFTEST: FamilySelftest = FamilySelftest {
    reference_cases,
    faults: |reference| faults::multirotor::faults(reference, &SELFTEST),
    near_misses,
    limits: LIMITS,
    distances: &["nodes.separation", "plan.separation", "flight.separation"],
    keep_apart,
};

// A multirotor's plan ends in its goal to the last bit: below that there is no limit.
const LIMITS: &[TightenedLimit] = &[
    limit("the limit of the distance from the goal", &["flight.goal"], |it, limit| {
        it.scenario.verdict.goal_m = Some(limit);
    }),
    limit("the limit of the speed at the end", &["flight.rest"], |it, limit| {
        it.scenario.verdict.rest_mps = Some(limit);
    }),
];

fn reference_cases() -> Vec<UnflownCase> {
    vec![
        head_on(),
        crossing(),
        shipped("corridor-moving", include_str!("../../../scenarios/multirotor/corridor-moving.toml")),
        tilting(),
        windy(),
    ]
}

/// With drag, of which planners know nothing: without it the tracking would be perfect, and a log that flatters it true.
fn crossing() -> UnflownCase {
    let UnflownCase { mut scenario, plan_source } =
        shipped("crossing-4", include_str!("../../../scenarios/multirotor/crossing-4.toml"));
    scenario.models.multirotor.values_mut().for_each(|model| model.drag_area_m2 = 0.03);
    UnflownCase { scenario, plan_source }
}

/// The two of the four that fly towards each other, a metre apart, planned ahead and arriving together.
fn head_on() -> UnflownCase {
    let UnflownCase { mut scenario, .. } = crossing();
    "head-on".clone_into(&mut scenario.name);
    scenario.vehicles.truncate(2);
    scenario.fleet.simultaneous_arrival = true;
    by("sparse-astar", scenario)
}

/// A quadrotor that has to tilt, with exact sensors: what is wrong with its log is not hidden by noise.
fn tilting() -> UnflownCase {
    let UnflownCase { mut scenario, plan_source } =
        shipped("paper-map-quadrotor", include_str!("../../../scenarios/multirotor/paper-map-quadrotor.toml"));
    scenario.simulation.sensors = scenarios::Sensors::default();
    UnflownCase { scenario, plan_source }
}

/// In a wind whose gusts are smaller than its mean: what blows within gusts of its own size cannot be told from them.
fn windy() -> UnflownCase {
    let UnflownCase { mut scenario, plan_source } =
        shipped("paper-map-gusts", include_str!("../../../scenarios/multirotor/paper-map-gusts.toml"));
    let gusts = scenario.simulation.wind.as_mut().and_then(|wind| wind.gusts.as_mut());
    if let Some(gusts) = gusts {
        (gusts.wind_at_20ft_mps, gusts.sigma_aloft_mps) = (2.0, 0.4);
    }
    scenario.simulation.sensors.delay_s = 0.02;
    UnflownCase { scenario, plan_source }
}

fn keep_apart(it: &mut ReferenceCase, limit_m: f64) {
    it.scenario.fleet.separation_m = Some(limit_m);
}

fn near_misses(reference: &ReferenceCase) -> Vec<NearMiss> {
    if reference.is_planned_in_the_loop() {
        return in_the_loop(reference);
    }
    let mut own = vec![as_near_as_allowed()];
    own.extend(planned_ahead());
    near_misses::with_limits(own, &SELFTEST)
}

fn planned_ahead() -> Vec<NearMiss> {
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
