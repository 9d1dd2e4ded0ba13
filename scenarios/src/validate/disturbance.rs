//! Disturbances that could not act on the vehicles, or fall between two steps of the simulator. They are refused, so that
//! no flight looks undisturbed because a disturbance was ignored.

use crate::{GustPulse, Issue, Scenario, VehicleModel, Wind};

/// Steps of the simulator for each single gust, at least: the log then holds it, with 85 % of its peak or more.
const MIN_STEPS_PER_PULSE: f64 = 4.0;

/// Relative rounding error of a number of steps.
const ROUNDING: f64 = 1e-9;

pub(super) fn issues(scenario: &Scenario) -> Vec<Issue> {
    let wind = scenario.simulation.wind.as_ref();
    let useless_wind = wind.filter(|wind| blows(wind)).and_then(|_| wind_without_effect(scenario));
    let single = [useless_wind, wind.and_then(|wind| short_pulse(scenario, wind)), short_delay(scenario)];
    single.into_iter().flatten().chain(noise_without_effect(scenario)).collect()
}

/// The first vehicle on which wind cannot act, because its model has no drag.
pub fn wind_without_effect(scenario: &Scenario) -> Option<Issue> {
    scenario.vehicles.iter().find_map(|vehicle| {
        let model = scenario.models.get(&vehicle.model)?;
        let fields = model.missing_drag()?;
        let found = format!("wind, which cannot act on `{}`: its model has no drag area", vehicle.name);
        let path = format!("models.{}.{}", model.family().key(), vehicle.model);
        let expected = format!("a drag area ({fields}) in [{path}]");
        Some(Issue::new("simulation.wind", found, expected).remedy("add the drag area, or remove the wind"))
    })
}

fn blows(wind: &Wind) -> bool {
    let Wind { mean_mps, gusts, pulses } = wind;
    let gusty = gusts.as_ref().is_some_and(|gusts| gusts.wind_at_20ft_mps > 0.0 || gusts.sigma_aloft_mps > 0.0);
    gusty || *mean_mps != [0.0; 3] || pulses.iter().any(|pulse| pulse.peak_mps != [0.0; 3])
}

/// The shortest single gust, if it is over after so few steps that a flight log could not show it.
fn short_pulse(scenario: &Scenario, wind: &Wind) -> Option<Issue> {
    let pulses = wind.pulses.iter().enumerate().filter(|(_, pulse)| pulse.duration_s > 0.0);
    let (index, GustPulse { duration_s, .. }) = pulses.min_by(|a, b| a.1.duration_s.total_cmp(&b.1.duration_s))?;
    let step_s = scenario.simulation.step_s;
    (*duration_s < MIN_STEPS_PER_PULSE * step_s * (1.0 - ROUNDING)).then(|| {
        let found = format!("{duration_s} s, at a time step of {step_s} s");
        let expected = format!("at least {MIN_STEPS_PER_PULSE} time steps, so that the log shows the gust");
        let needed_s = duration_s / MIN_STEPS_PER_PULSE;
        Issue::new(format!("simulation.wind.pulses[{index}].duration_s"), found, expected)
            .remedy(format!("set simulation.step_s to at most {needed_s} s, or lengthen the gust"))
    })
}

/// A delay that rounds to no step.
fn short_delay(scenario: &Scenario) -> Option<Issue> {
    let (step_s, delay_s) = (scenario.simulation.step_s, scenario.simulation.sensors.delay_s);
    (delay_s > 0.0 && (delay_s / step_s).round() == 0.0).then(|| {
        let found = format!("{delay_s} s, less than half a time step of {step_s} s");
        let expected = "0, or a delay that is not rounded to nothing: delays are in whole time steps";
        Issue::new("simulation.sensors.delay_s", found, expected)
            .remedy(format!("set simulation.step_s to {delay_s} s, or remove the delay"))
    })
}

/// Noise and mismatch that no vehicle of the scenario has a use for.
fn noise_without_effect(scenario: &Scenario) -> Vec<Issue> {
    let models: Vec<&dyn VehicleModel> =
        scenario.vehicles.iter().filter_map(|vehicle| scenario.models.get(&vehicle.model)).collect();
    if models.is_empty() {
        return Vec::new();
    }
    let (sensors, mismatch) = (&scenario.simulation.sensors, &scenario.simulation.mismatch);
    let any = |has: fn(&dyn VehicleModel) -> bool| models.iter().any(|model| has(*model));
    let with_attitude = (any(|model| model.has_attitude()), "0: only vehicles with rotors measure their attitude");
    let with_load = (any(|model| model.family().carries_load()), "0: no vehicle carries a load");
    let in_loop = (any(|model| model.family().senses_obstacles()), "0: only multirotors sense other bodies");
    let noises = [
        ("attitude_noise_deg", sensors.attitude_noise_deg, with_attitude),
        ("rate_noise_degps", sensors.rate_noise_degps, with_attitude),
        ("load_position_noise_m", sensors.load_position_noise_m, with_load),
        ("load_velocity_noise_mps", sensors.load_velocity_noise_mps, with_load),
        ("sighting_position_noise_m", sensors.sighting_position_noise_m, in_loop),
        ("sighting_velocity_noise_mps", sensors.sighting_velocity_noise_mps, in_loop),
    ];
    let useless = noises.into_iter().filter(|(_, noise, (has_effect, _))| *noise > 0.0 && !has_effect);
    let useless = useless.map(|(name, noise, (_, expected))| {
        Issue::new(format!("simulation.sensors.{name}"), noise.to_string(), expected).remedy("remove it")
    });
    let load = (mismatch.load_mass_ratio != 1.0 && !with_load.0).then(|| {
        let found = mismatch.load_mass_ratio.to_string();
        Issue::new("simulation.mismatch.load_mass_ratio", found, "1: no vehicle carries a load").remedy("remove it")
    });
    useless.chain(load).collect()
}
