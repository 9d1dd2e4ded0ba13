//! Can the vehicle follow the plan?
//!
//! Distance between the true position and the one that the plan asks for, and the share of the time during which the
//! tracker's command was cut off at the vehicle's limits, both while the vehicle's own trajectory lasts. The root mean
//! square is over time, of the worst vehicle.

use scenarios::{CheckSpec, Scenario};
use sim::Sample;

use crate::verdict::Check;
use crate::verdict::compare::is_larger;
use crate::verdict::evidence::{Decide, Evidence, Measurement};
use crate::verdict::flown::FlownMotions;

/// Largest distance from the plan.
pub fn check_largest(spec: &CheckSpec, scenario: &Scenario, flown: Evidence<'_, FlownMotions<'_>>) -> Check {
    answer(spec, flown, largest, scenario.limits().tracking_max_m)
}

/// Largest root mean square of the distance from the plan.
pub fn check_root_mean_square(spec: &CheckSpec, scenario: &Scenario, flown: Evidence<'_, FlownMotions<'_>>) -> Check {
    answer(spec, flown, |samples| (root_mean_square(samples), None), scenario.limits().tracking_rms_m)
}

/// Largest share of the steps in which the command was cut off, in [0, 1].
pub fn check_saturation(spec: &CheckSpec, scenario: &Scenario, flown: Evidence<'_, FlownMotions<'_>>) -> Check {
    answer(spec, flown, |samples| (saturation(samples), None), scenario.limits().saturation)
}

/// Largest distance from the plan, m, and when, s. NaN is larger than anything.
pub fn largest(samples: &[Sample]) -> (f64, Option<f64>) {
    let mut worst = (f64::NEG_INFINITY, None);
    for sample in samples {
        let error_m = squared_error_m2(sample).sqrt();
        if is_larger(error_m, worst.0) {
            worst = (error_m, Some(sample.t_s));
        }
    }
    worst
}

/// Root mean square of the distance from the plan, m. NaN without samples.
pub fn root_mean_square(samples: &[Sample]) -> f64 {
    (samples.iter().map(squared_error_m2).sum::<f64>() / samples.len() as f64).sqrt()
}

/// Share of the samples whose command was cut off. NaN without samples.
pub fn saturation(samples: &[Sample]) -> f64 {
    samples.iter().filter(|sample| sample.is_saturated()).count() as f64 / samples.len() as f64
}

fn squared_error_m2(sample: &Sample) -> f64 {
    (0..3).map(|axis| (sample.position_m[axis] - sample.reference_position_m[axis]).powi(2)).sum()
}

fn answer(
    spec: &CheckSpec,
    flown: Evidence<'_, FlownMotions<'_>>,
    measure: impl Fn(&[Sample]) -> (f64, Option<f64>),
    limit: f64,
) -> Check {
    let flown = match flown {
        Err(reason) => return spec.fail(reason),
        Ok(flown) => flown,
    };
    let mut worst: Option<(f64, Option<f64>, &str)> = None;
    for vehicle in &flown.vehicles {
        let (value, at_s) = measure(vehicle.tracked);
        if worst.is_none_or(|(worst_value, ..)| is_larger(value, worst_value)) {
            worst = Some((value, at_s, vehicle.name));
        }
    }
    match worst {
        None => spec.fail("there is no vehicle"),
        Some((value, at_s, vehicle)) => {
            let measured = Measurement::value(value).with(vehicle);
            spec.at_most(at_s.map_or(measured.clone(), |at_s| measured.at(at_s)), limit)
        }
    }
}
