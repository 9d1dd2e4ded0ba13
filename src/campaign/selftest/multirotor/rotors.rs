//! Faults of flights of a quadrotor, which has to tilt to accelerate.

use crate::campaign::selftest::Fault;
use crate::campaign::selftest::reference_case::thrusts;

/// The faults.
pub fn faults() -> Vec<Fault> {
    vec![
        Fault::new("flight.state_limits", "the quadrotor turns over for one sample", |it| {
            let middle = it.steps() / 2;
            it.samples(0)[middle].world_from_body = [1.0, 0.0, 0.0, 0.0];
        }),
        Fault::new("flight.state_limits", "one attitude is no rotation", |it| {
            let middle = it.steps() / 2;
            it.samples(0)[middle].world_from_body = [0.0, 0.0, 0.0, 2.0];
        }),
        Fault::new("flight.state_limits", "one attitude is all zeros", |it| {
            let middle = it.steps() / 2;
            it.samples(0)[middle].world_from_body = [0.0; 4];
        }),
        Fault::new("flight.dynamics", "the attitude in the log stays level", |it| {
            it.samples(0).iter_mut().for_each(|sample| sample.world_from_body = [0.0, 0.0, 0.0, 1.0]);
        }),
        Fault::new("flight.dynamics", "the attitudes in the log are body from world", |it| {
            it.samples(0).iter_mut().for_each(|sample| {
                let [x, y, z, w] = sample.world_from_body;
                sample.world_from_body = [-x, -y, -z, w];
            });
        }),
        Fault::new("flight.control_limits", "a thrust jumps for one sample", |it| {
            let middle = it.steps() / 2;
            thrusts(&mut it.samples(0)[middle]).control.thrust_n[1] = 8.01;
        }),
        Fault::new("flight.control_limits", "a rotor stands still for one sample", |it| {
            let middle = it.steps() / 2;
            thrusts(&mut it.samples(0)[middle]).control.thrust_n[1] = 0.19;
        }),
        Fault::new("flight.dynamics", "the thrusts in the log are not those that acted", |it| {
            let middle = it.steps() / 2;
            it.samples(0)[middle..middle + 20].iter_mut().for_each(|it| thrusts(it).control.thrust_n[0] += 0.5);
        }),
        Fault::new("flight.dynamics", "the rotors have no lag", |it| {
            it.multirotor_model().airframe.iter_mut().for_each(|airframe| airframe.rotor_time_constant_s = None);
        }),
        Fault::new("flight.dynamics", "another mass flew than the scenario's", |it| {
            let mut heavy = it.scenario.clone();
            heavy.simulation.mismatch.mass_ratio = 1.02;
            it.fly_in(&heavy);
        }),
        Fault::new("flight.state_limits", "the limit of the tilt is just below what was flown", |it| {
            let tilt_deg = |sample: &sim::Sample| {
                let [x, y, ..] = sample.world_from_body;
                (1.0 - 2.0 * (x * x + y * y)).acos().to_degrees()
            };
            let max_deg = it.samples(0).iter().map(tilt_deg).fold(0.0, f64::max);
            it.multirotor_model().airframe.iter_mut().for_each(|airframe| airframe.tilt_deg = max_deg - 1e-3);
        }),
        Fault::new("flight.saturation", "commands are cut off for a tenth of the time", |it| {
            let tenth = it.planned_steps() / 10;
            it.samples(0)[..tenth].iter_mut().for_each(|sample| thrusts(sample).command.thrust_n[0] = 9.0);
        }),
    ]
}
