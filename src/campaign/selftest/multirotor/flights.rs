//! Faults of flights that follow a plan, of point masses.

use scenarios::Range;
use sim::{Actuation, Commanded, EventKind, Sample};

use super::plans::add;
use crate::campaign::selftest::faults::log::{delay, swap};
use crate::campaign::selftest::{Fault, ReferenceCase};

/// The faults.
pub fn faults() -> Vec<Fault> {
    [motions(), limits(), obstacles()].into_iter().flatten().collect()
}

fn motions() -> Vec<Fault> {
    vec![
        Fault::new("flight.complete", "the logs of two vehicles are swapped", |it| it.flight().vehicles.swap(0, 1)),
        Fault::new("flight.complete", "the contents of two logs are swapped", |it| swap(it, 0)),
        Fault::new("flight.dynamics", "two vehicles change places in the middle of the flight", |it| {
            let middle = it.steps() / 2;
            swap(it, middle);
        }),
        Fault::new("flight.tracking_max", "one vehicle is delayed", |it| {
            let late_s = 1.1 * it.scenario.limits().arrival_spread_s;
            delay(it, late_s);
        }),
        Fault::new("flight.separation", "one vehicle flies beside another", |it| {
            let beside_m = 0.9 * it.scenario.fleet.separation_m.unwrap_or(0.0);
            let beside = it.samples(0).clone();
            for (sample, beside) in it.samples(1).iter_mut().zip(beside) {
                sample.position_m = [beside.position_m[0], beside.position_m[1] + beside_m, beside.position_m[2]];
                sample.velocity_mps = beside.velocity_mps;
            }
        }),
        Fault::new("flight.crash", "two bodies overlap without a crash in the log", |it| {
            let own = it.samples(0).clone();
            for (sample, own) in it.samples(1).iter_mut().zip(own) {
                (sample.position_m, sample.velocity_mps) = (own.position_m, own.velocity_mps);
                sample.position_m[2] += 0.1;
            }
        }),
        Fault::new("flight.tracking_max", "a vehicle is blown aside for a moment", |it| {
            let (middle, max_m) = (it.steps() / 2, it.scenario.limits().tracking_max_m);
            it.shift(0, middle..middle + 20, [0.0, 0.0, 1.2 * max_m]);
        }),
        Fault::new("flight.tracking_rms", "a vehicle flies above its plan", |it| {
            let (steps, max_m) = (it.steps(), it.scenario.limits().tracking_rms_m);
            it.shift(0, 0..steps, [0.0, 0.0, 1.1 * max_m]);
        }),
        Fault::new("flight.rest", "a vehicle still moves at the end", |it| {
            let (end, max_mps) = (it.planned_steps(), it.scenario.limits().rest_mps);
            it.samples(0)[end - 2..].iter_mut().for_each(|sample| sample.velocity_mps[2] = 1.1 * max_mps);
        }),
        Fault::new("flight.duration", "the flight exceeds the longest duration", |it| {
            it.scenario.simulation.max_duration_s = 0.9 * it.plan.flight_time_s().unwrap_or(0.0);
        }),
    ]
}

fn limits() -> Vec<Fault> {
    vec![
        Fault::new("flight.state_limits", "one sample is faster than the vehicle", |it| {
            let (middle, max_mps) = (it.steps() / 2, it.multirotor_model().limits.speed_mps);
            it.samples(0)[middle].velocity_mps[0] = 1.001 * max_mps;
        }),
        Fault::new("flight.state_limits", "flown altitudes in feet", |it| {
            it.samples(0).iter_mut().for_each(|sample| sample.position_m[2] /= 0.3048);
        }),
        Fault::new("flight.control_limits", "an acceleration jumps for one sample", |it| {
            let (middle, max_mps2) = (it.steps() / 2, it.multirotor_model().limits.acceleration_mps2);
            acceleration(&mut it.samples(0)[middle]).control[2] = 1.001 * max_mps2;
        }),
        Fault::new("flight.control_limits", "the log holds the thrusts of a quadrotor", |it| {
            let none = scenarios::slung_load::Control { thrust_n: [0.0; 4] };
            let thrusts = sim::Actuation::Thrusts(sim::Commanded { command: none, control: none });
            it.samples(0).iter_mut().for_each(|sample| sample.actuation = thrusts);
        }),
        Fault::new("flight.dynamics", "the accelerations in the log are not those that acted", |it| {
            let middle = it.steps() / 2;
            it.samples(0)[middle..middle + 50].iter_mut().for_each(|it| acceleration(it).control[1] += 0.1);
        }),
        Fault::new("flight.dynamics", "an acceleration has the opposite sign", |it| {
            it.samples(0).iter_mut().for_each(|it| {
                let acceleration = acceleration(it);
                acceleration.control[0] = -acceleration.control[0];
            });
        }),
        Fault::new("flight.saturation", "commands are cut off for a tenth of the time", |it| {
            let tenth = it.planned_steps() / 10;
            it.samples(0)[..tenth].iter_mut().for_each(|sample| acceleration(sample).command[0] = 9.0);
        }),
    ]
}

fn obstacles() -> Vec<Fault> {
    vec![
        Fault::new("flight.clearance", "a wall of 1 mm crosses the path between two samples", |it| {
            let [x_m, y_m, _] = between_samples(it);
            add(it, [x_m, y_m], [1e-3, 0.4], None);
        }),
        Fault::new("flight.clearance", "a pole is a millimetre inside the rotors' reach", |it| {
            let ([x_m, y_m, _], reach_m) = (between_samples(it), it.multirotor_model().body_radius_m);
            add(it, [x_m, y_m - reach_m - 9e-3], [0.02, 0.02], None);
        }),
        Fault::new("flight.clearance", "a hidden beam is a millimetre too low", |it| {
            let ([x_m, y_m, z_m], reach_m) = (between_samples(it), it.multirotor_model().body_radius_m);
            add(it, [x_m, y_m], [0.2, 2.0], Some(Range::new(z_m + reach_m - 1e-3, z_m + 2.0)));
            it.scenario.world.hidden.push("planted".to_owned());
        }),
        Fault::new("flight.clearance", "the map's ceiling is below the top of the body", |it| {
            let ([.., z_m], reach_m) = (between_samples(it), it.multirotor_model().body_radius_m);
            it.scenario.world.map.z_m.max = z_m + reach_m - 1e-3;
        }),
        Fault::new("flight.complete", "a vehicle flew into a wall, and the crash was removed from the log", |it| {
            let [x_m, y_m, _] = between_samples(it);
            add(it, [x_m, y_m], [0.5, 0.5], None);
            let scenario = it.scenario.clone();
            it.fly_in(&scenario);
            it.flight().events.retain(|event| !matches!(event.kind, EventKind::Crash { .. }));
        }),
        Fault::new("flight.crash", "a vehicle flew through a wall without a crash in the log", |it| {
            let [x_m, y_m, _] = between_samples(it);
            add(it, [x_m, y_m], [0.5, 0.5], None);
        }),
    ]
}

/// Half way between two samples in the middle of the first vehicle's flight, m.
fn between_samples(it: &mut ReferenceCase) -> [f64; 3] {
    let middle = it.planned_steps() / 2;
    let [from, to] = [it.samples(0)[middle].position_m, it.samples(0)[middle + 1].position_m];
    std::array::from_fn(|axis| f64::midpoint(from[axis], to[axis]))
}

/// Acceleration of a sample. Panics for one that does not stand for a point mass.
fn acceleration(sample: &mut Sample) -> &mut Commanded<[f64; 3]> {
    match &mut sample.actuation {
        Actuation::Acceleration(acceleration) => acceleration,
        _ => panic!("not a point mass"),
    }
}
