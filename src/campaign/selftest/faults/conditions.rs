//! Faults of flights in wind and with sensor noise.

use super::super::{Fault, ReferenceCase};

/// The faults.
pub fn faults() -> Vec<Fault> {
    vec![
        Fault::new("flight.conditions", "the wind was switched off", |it| {
            let mut calm = it.scenario.clone();
            calm.simulation.wind = None;
            it.fly_in(&calm);
        }),
        Fault::new("flight.conditions", "the wind blew with the opposite sign", |it| {
            let mut turned = it.scenario.clone();
            reverse_wind(&mut turned);
            it.fly_in(&turned);
        }),
        Fault::new("flight.dynamics", "the wind in the log has the opposite sign of the wind that acted", |it| {
            each_sample(it, |sample| sample.wind_mps = sample.wind_mps.map(|component| -component));
        }),
        Fault::new("flight.conditions", "the sensors had no noise", |it| {
            let mut exact = it.scenario.clone();
            exact.simulation.sensors = scenarios::Sensors::default();
            it.fly_in(&exact);
        }),
        Fault::new("flight.conditions", "the sensors had half of the noise", |it| {
            let mut quieter = it.scenario.clone();
            quieter.simulation.sensors.position_noise_m /= 2.0;
            it.fly_in(&quieter);
        }),
        Fault::new("flight.conditions", "the measurements came later than the scenario says", |it| {
            let mut late = it.scenario.clone();
            late.simulation.sensors.delay_s += 0.05;
            it.fly_in(&late);
        }),
        Fault::new("flight.dynamics", "the true mass was the nominal one", |it| {
            let mut nominal = it.scenario.clone();
            nominal.simulation.mismatch = scenarios::Mismatch::default();
            it.fly_in(&nominal);
        }),
    ]
}

fn reverse_wind(scenario: &mut scenarios::Scenario) {
    let Some(wind) = &mut scenario.simulation.wind else { return };
    wind.mean_mps = wind.mean_mps.map(|component| -component);
    wind.pulses.iter_mut().for_each(|pulse| pulse.peak_mps = pulse.peak_mps.map(|component| -component));
}

fn each_sample(it: &mut ReferenceCase, change: impl Fn(&mut sim::Sample)) {
    it.flight().vehicles.iter_mut().flat_map(|log| &mut log.samples).for_each(change);
}
