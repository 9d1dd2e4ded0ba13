//! Conditions of the flight: whether the logged air, sensor noise and planning in the loop are those of the scenario.
//!
//! A simulator that omits the wind, or reverses it, makes every flight look better than it is, and its log shows no other
//! defect.

use nalgebra::Vector3;
use scenarios::{CheckSpec, GustPulse, Gusts, Plan, Scenario, Wind};
use sim::{Flight, Sample, VehicleLog};

use crate::verdict::Check;
use crate::verdict::compare::exceeds;
use crate::verdict::in_loop_planning;
use crate::verdict::integrity::none_of;

/// Tolerance of air without turbulence, m/s: rounding.
const AIR_MPS: f64 = 1e-6;
/// Largest standard deviation of a component of low-altitude gusts, as a fraction of the wind at 20 ft: 0.1/0.177^0.4.
///                                                                                           [MIL-F-8785C, 3.7.3.4]
const LOW_ALTITUDE_SIGMA: f64 = 0.2;
/// Largest turbulence at any instant, and of its mean, in standard deviations.
const MAX_GUST: f64 = 8.0;
const MAX_MEAN: f64 = 5.0;
/// Largest relative error of a standard deviation that is estimated from n numbers, in its own standard deviations
/// 1/sqrt(2n). A few numbers give a weak test, but even they are not all 0.
const MAX_ESTIMATE_ERROR: f64 = 6.0;

/// Number of vehicles whose logged air or measurements are not those of the scenario, plus one if the planning in the loop
/// is not.
///
/// - `plan`: the plan that was flown; of in-loop planners, the references that were followed
pub fn check(spec: &CheckSpec, scenario: &Scenario, plan: &Plan, flight: &Flight) -> Check {
    let odd = |log: &VehicleLog| {
        let empty = log.samples.is_empty().then(|| "the log is empty".to_owned());
        let defect = empty
            .or_else(|| air_defect(scenario.simulation.wind.as_ref(), log))
            .or_else(|| sensor_defect(scenario, log));
        defect.map(|defect| format!("{}: {defect}", log.vehicle))
    };
    let defects = flight.vehicles.iter().filter_map(odd).chain(in_loop_planning::defect(scenario, plan, flight));
    let defects: Vec<String> = defects.collect();
    none_of(spec, defects.len(), &[], defects.first())
}

fn air_defect(wind: Option<&Wind>, log: &VehicleLog) -> Option<String> {
    let gusts: Vec<Vector3<f64>> = log.samples.iter().map(|sample| gust_mps(wind, sample)).collect();
    let Some(asked) = wind.and_then(|wind| wind.gusts.as_ref()) else {
        let odd = gusts.iter().position(|gust| exceeds(gust.norm(), AIR_MPS))?;
        let sample = &log.samples[odd];
        return Some(format!(
            "at {:.3} s the logged wind is {:?} m/s, which is not that of the scenario",
            sample.t_s, sample.wind_mps
        ));
    };
    let sigma_mps = largest_sigma_mps(asked);
    if let Some(odd) = gusts.iter().position(|gust| exceeds(gust.norm(), MAX_GUST * sigma_mps + AIR_MPS)) {
        let (t_s, gust_mps) = (log.samples[odd].t_s, gusts[odd].norm());
        return Some(format!("at {t_s:.3} s a gust of {gust_mps:.1} m/s, too strong for the scenario's turbulence"));
    }
    let mean_mps = gusts.iter().sum::<Vector3<f64>>() / gusts.len().max(1) as f64;
    if exceeds(mean_mps.norm(), MAX_MEAN * sigma_mps + AIR_MPS) {
        return Some(format!("the mean of its wind differs from the scenario's by {:.1} m/s", mean_mps.norm()));
    }
    let is_dead = sigma_mps > 0.0 && gusts.windows(2).all(|pair| pair[0] == pair[1]);
    is_dead.then(|| "the scenario has gusts, the log has none".to_owned())
}

/// The turbulence in a sample: its wind without the scenario's mean and single gusts, world frame, m/s.
fn gust_mps(wind: Option<&Wind>, sample: &Sample) -> Vector3<f64> {
    let prescribed_mps = wind.map_or_else(Vector3::zeros, |wind| {
        let pulses = wind.pulses.iter().map(|pulse| pulse_mps(pulse, sample.t_s));
        pulses.fold(Vector3::from(wind.mean_mps), |sum, pulse| sum + pulse)
    });
    Vector3::from(sample.wind_mps) - prescribed_mps
}

/// Velocity of a single gust, world frame, m/s: half its peak times 1 - cos.
fn pulse_mps(pulse: &GustPulse, t_s: f64) -> Vector3<f64> {
    let fraction = ((t_s - pulse.start_s) / pulse.duration_s).clamp(0.0, 1.0);
    Vector3::from(pulse.peak_mps) * (0.5 - 0.5 * (std::f64::consts::TAU * fraction).cos())
}

fn largest_sigma_mps(gusts: &Gusts) -> f64 {
    (LOW_ALTITUDE_SIGMA * gusts.wind_at_20ft_mps).max(gusts.sigma_aloft_mps)
}

fn sensor_defect(scenario: &Scenario, log: &VehicleLog) -> Option<String> {
    let asked = &scenario.simulation.sensors;
    let late = (asked.delay_s / scenario.simulation.step_s).round() as usize;
    let vehicle = |of: fn(&Sample) -> [[f64; 3]; 2]| log.samples.iter().map(of).collect::<Vec<_>>();
    let load = |of: fn(&sim::LoadSample) -> [[f64; 3]; 2]| log.loads.iter().map(of).collect::<Vec<_>>();
    let series = [
        ("position", asked.position_noise_m, vehicle(|it| [it.measured_position_m, it.position_m])),
        ("velocity", asked.velocity_noise_mps, vehicle(|it| [it.measured_velocity_mps, it.velocity_mps])),
        ("load's position", asked.load_position_noise_m, load(|it| [it.measured_position_m, it.position_m])),
        ("load's velocity", asked.load_velocity_noise_mps, load(|it| [it.measured_velocity_mps, it.velocity_mps])),
    ];
    series.iter().find_map(|(what, sigma, pairs)| {
        let errors = errors(pairs, late);
        // Until the delay has passed the first measurement is repeated, so that its noise counts once.
        let early = late.min(errors.len().saturating_sub(1));
        let is_changed = pairs[..early].iter().any(|[measured, _]| *measured != pairs[0][0]);
        let change = || format!("the measured {what} changes before the delay of the first measurement has passed");
        is_changed
            .then(change)
            .or_else(|| noise_defect(what, *sigma, if *sigma == 0.0 { &errors } else { &errors[early..] }))
    })
}

/// Errors of the measurements, each against the true value `late` samples before; those of the first `late` samples against
/// the first true value.
fn errors(pairs: &[[[f64; 3]; 2]], late: usize) -> Vec<[f64; 3]> {
    let error = |(index, [measured, _]): (usize, &[[f64; 3]; 2])| {
        let [_, truth] = pairs[index.saturating_sub(late)];
        std::array::from_fn(|axis| measured[axis] - truth[axis])
    };
    pairs.iter().enumerate().map(error).collect()
}

/// The defect of errors that are not noise of this standard deviation; without noise they must be 0.
fn noise_defect(what: &str, sigma: f64, errors: &[[f64; 3]]) -> Option<String> {
    let count = 3 * errors.len();
    let errors = errors.iter().copied().flatten();
    let largest =
        errors.clone().fold(0.0, |worst: f64, error| if exceeds(error.abs(), worst) { error.abs() } else { worst });
    if sigma == 0.0 {
        return (largest != 0.0)
            .then(|| format!("the measured {what} has an error of {largest:.3e}, but the scenario has no noise"));
    }
    if count == 0 {
        return None;
    }
    if largest == 0.0 {
        return Some(format!("the measured {what} has no error, but the scenario has noise"));
    }
    let estimate = (errors.map(|error| error * error).sum::<f64>() / count as f64).sqrt();
    let tolerance = MAX_ESTIMATE_ERROR / (2.0 * count as f64).sqrt();
    let is_off = exceeds((estimate / sigma - 1.0).abs(), tolerance);
    is_off.then(|| {
        format!("the noise of the measured {what} has a standard deviation of {estimate:.3e} instead of {sigma}")
    })
}

#[cfg(test)]
mod tests;
