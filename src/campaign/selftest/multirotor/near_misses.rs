use scenarios::BoxObstacle;
use scenarios::in_loop::ReplanStatus;
use sim::{Event, EventKind, Sample};

use super::has_rotors;
use crate::campaign::selftest::faults::{places, requirements};
use crate::campaign::selftest::near_misses::{self, NEAR_M};
use crate::campaign::selftest::{NearMiss, ReferenceCase};

/// The near misses for a reference case of multirotors in still air.
pub fn all(reference: &ReferenceCase) -> Vec<NearMiss> {
    if reference.is_planned_in_the_loop() {
        return in_the_loop(reference);
    }
    let own = [places::near_misses(), requirements::near_misses(), vec![near_misses::separation()]];
    let common = [near_misses::limits(&super::SELFTEST.limits), near_misses::whole()].into_iter().chain(own);
    common.flatten().chain(planned()).collect()
}

fn planned() -> [NearMiss; 2] {
    [
        NearMiss::new("a pole that a rotor just clears", |it| {
            let (middle, reach_m) = (it.planned_steps() / 2, it.multirotor_model().body_radius_m);
            let [x_m, y_m, _] = it.samples(0)[middle].position_m;
            let aside_m = reach_m + 0.01 + search_resolution_m(it);
            it.scenario.world.boxes.push(BoxObstacle {
                name: "planted".to_owned(),
                center_m: [x_m, y_m - aside_m],
                size_m: [0.02, 0.02],
                heading_deg: 0.0,
                z_m: None,
            });
        }),
        NearMiss::new("a flight just below the largest speed", |it| {
            let planned_mps = it.multirotor_model().planning_limits.speed_mps;
            let airspeed = |sample: &Sample| sample.air_velocity_mps().iter().map(|v| v * v).sum::<f64>().sqrt();
            let samples = it.flight().vehicles.iter().flat_map(|log| &log.samples);
            let fastest_mps = samples.map(airspeed).fold(planned_mps, f64::max);
            it.multirotor_model().limits.speed_mps = fastest_mps + NEAR_M;
        }),
    ]
}

fn in_the_loop(reference: &ReferenceCase) -> Vec<NearMiss> {
    let mut all = vec![NearMiss::new("an answer that is there at its deadline", |it| {
        let deadline_s = it.scenario.simulation.planning.deadline_s;
        let mut slow = it.scenario.clone();
        slow.simulation.planning.median_s = deadline_s;
        it.fly_in(&slow);
        it.scenario = slow;
    })];
    all.push(NearMiss::new("a planner that crashes after the flight's planned end", |it| {
        let flight = it.flight();
        let (end_s, planning) = (flight.plan_end_s, flight.planning.as_mut().expect("it was planned in the loop"));
        let last = planning.replans.last_mut().filter(|replan| replan.asked_s > end_s).expect("an answer in the coast");
        last.outcome = ReplanStatus::Failed { reason: "it ended with exit code 1".into() };
        let kind = EventKind::ReplanFailed { reason: "it ended with exit code 1".into() };
        let event = Event { t_s: last.asked_s, kind, vehicles: Vec::new() };
        flight.events.push(event);
    }));
    if has_rotors(reference) {
        all.push(NearMiss::new("a quadrotor just below its largest tilt", |it| {
            let tilt_deg = |sample: &Sample| {
                let [x, y, ..] = sample.world_from_body;
                (1.0 - 2.0 * (x * x + y * y)).acos().to_degrees()
            };
            let max_deg = it.samples(0).iter().map(tilt_deg).fold(0.0, f64::max);
            it.multirotor_model().airframe.iter_mut().for_each(|airframe| airframe.tilt_deg = max_deg + 1e-6);
        }));
    }
    if !reference.scenario.world.moving.is_empty() {
        all.push(NearMiss::new("moving obstacles just narrow enough", |it| {
            let room_m = it.value("flight.clearance") - search_resolution_m(it);
            it.scenario.world.moving.iter_mut().for_each(|cart| cart.radius_m += room_m);
        }));
    }
    all
}

/// Resolution of the distance search, and uncertainty of the flight between its samples, m.
fn search_resolution_m(it: &ReferenceCase) -> f64 {
    2e-4 + 10.0 * it.value("flight.dynamics")
}
