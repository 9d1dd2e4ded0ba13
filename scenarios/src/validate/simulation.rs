//! The simulation: time step, duration, tracker and disturbances.

use super::quantity::{above_up_to, not_negative, positive};
use crate::{GustPulse, Gusts, Issue, Planning, PlanningClock, Simulation};

/// Maximum time step, s.
const MAX_STEP_S: f64 = 0.1;
/// Maximum number of steps of a flight: more than a day at the default step, and as many as a log can hold.
const MAX_STEPS: f64 = 1e7;

pub(super) fn issues(simulation: &Simulation) -> Vec<Issue> {
    let tracker = &simulation.tracker;
    let rules = [
        above_up_to("simulation.step_s", simulation.step_s, 0.0, MAX_STEP_S),
        positive("simulation.max_duration_s", simulation.max_duration_s),
        not_negative("simulation.coast_s", simulation.coast_s),
        positive("simulation.tracker.natural_frequency_radps", tracker.natural_frequency_radps),
        positive("simulation.tracker.damping_ratio", tracker.damping_ratio),
        not_negative("simulation.sensors.position_noise_m", simulation.sensors.position_noise_m),
        not_negative("simulation.sensors.velocity_noise_mps", simulation.sensors.velocity_noise_mps),
        not_negative("simulation.sensors.attitude_noise_deg", simulation.sensors.attitude_noise_deg),
        not_negative("simulation.sensors.rate_noise_degps", simulation.sensors.rate_noise_degps),
        not_negative("simulation.sensors.load_position_noise_m", simulation.sensors.load_position_noise_m),
        not_negative("simulation.sensors.load_velocity_noise_mps", simulation.sensors.load_velocity_noise_mps),
        not_negative("simulation.sensors.sighting_position_noise_m", simulation.sensors.sighting_position_noise_m),
        not_negative("simulation.sensors.sighting_velocity_noise_mps", simulation.sensors.sighting_velocity_noise_mps),
        not_negative("simulation.sensors.delay_s", simulation.sensors.delay_s),
        positive("simulation.mismatch.mass_ratio", simulation.mismatch.mass_ratio),
        positive("simulation.mismatch.load_mass_ratio", simulation.mismatch.load_mass_ratio),
        not_negative("simulation.mismatch.start_radius_m", simulation.mismatch.start_radius_m),
    ];
    let steps = too_many_steps(simulation);
    let gusts = simulation.wind.iter().flat_map(|wind| &wind.gusts).flat_map(gusts);
    let pulses = simulation.wind.iter().flat_map(|wind| wind.pulses.iter().enumerate()).flat_map(pulse);
    rules.into_iter().flatten().chain(steps).chain(gusts).chain(pulses).chain(planning(simulation)).collect()
}

fn too_many_steps(simulation: &Simulation) -> Option<Issue> {
    let Simulation { step_s, max_duration_s, .. } = simulation;
    let steps = max_duration_s / step_s;
    (*step_s > 0.0 && *max_duration_s > 0.0 && steps > MAX_STEPS).then(|| {
        let found = format!("{max_duration_s} s, {steps:.1e} steps of {step_s} s");
        Issue::new("simulation.max_duration_s", found, format!("at most {MAX_STEPS:.0} steps"))
            .remedy("increase the step, or shorten the flight")
    })
}

fn pulse((index, pulse): (usize, &GustPulse)) -> Vec<Issue> {
    let field = format!("simulation.wind.pulses[{index}]");
    let start = not_negative(&format!("{field}.start_s"), pulse.start_s);
    start.into_iter().chain(positive(&format!("{field}.duration_s"), pulse.duration_s)).collect()
}

fn planning(simulation: &Simulation) -> Vec<Issue> {
    let Planning { period_s, deadline_s, time, median_s, spread, recorded_s } = &simulation.planning;
    let rules = [
        positive("simulation.planning.period_s", *period_s),
        not_negative("simulation.planning.deadline_s", *deadline_s),
        not_negative("simulation.planning.median_s", *median_s),
        not_negative("simulation.planning.spread", *spread),
        (*period_s > 0.0 && *period_s < simulation.step_s).then(|| {
            let expected = format!("at least {} s, the time step", simulation.step_s);
            Issue::new("simulation.planning.period_s", period_s.to_string(), expected)
        }),
        (*time == PlanningClock::Recorded && recorded_s.is_empty()).then(|| {
            let expected = "planning times in s, since `time` is `recorded`";
            Issue::new("simulation.planning.recorded_s", "none", expected).remedy("add them, or use `modelled` times")
        }),
    ];
    let recorded = recorded_s.iter().enumerate();
    let recorded =
        recorded.filter_map(|(i, time_s)| not_negative(&format!("simulation.planning.recorded_s[{i}]"), *time_s));
    rules.into_iter().flatten().chain(recorded).collect()
}

fn gusts(gusts: &Gusts) -> Vec<Issue> {
    let rules = [
        not_negative("simulation.wind.gusts.wind_at_20ft_mps", gusts.wind_at_20ft_mps),
        not_negative("simulation.wind.gusts.sigma_aloft_mps", gusts.sigma_aloft_mps),
    ];
    rules.into_iter().flatten().collect()
}
