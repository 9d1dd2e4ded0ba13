//! Tracking: the distance from the plan, and the fraction of steps in which the tracker's command was saturated.
//!
//! Both are measured while the vehicle's own trajectory lasts. The root mean square is over time, of the worst vehicle.

use scenarios::{CheckSpec, Scenario};
use sim::Sample;

use crate::verdict::compare::is_larger;
use crate::verdict::evidence::{CheckResult, Decide, Measurement};
use crate::verdict::flown::FlownMotions;
use crate::verdict::missing_evidence::MissingEvidence;

/// Largest distance from the plan.
pub fn check_largest(spec: &CheckSpec, scenario: &Scenario, flown: &FlownMotions<'_>) -> CheckResult {
    check_worst(spec, flown, largest, scenario.limits().tracking_max_m)
}

/// Largest root mean square of the distance from the plan.
pub fn check_root_mean_square(spec: &CheckSpec, scenario: &Scenario, flown: &FlownMotions<'_>) -> CheckResult {
    check_worst(spec, flown, |samples| (root_mean_square(samples), None), scenario.limits().tracking_rms_m)
}

/// Largest fraction of saturated steps, in [0, 1].
pub fn check_saturation(spec: &CheckSpec, scenario: &Scenario, flown: &FlownMotions<'_>) -> CheckResult {
    check_worst(spec, flown, |samples| (saturation(samples), None), scenario.limits().saturation)
}

/// Largest distance from the plan, m, and its time, s. NaN counts as the largest.
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

/// Fraction of the samples whose command was saturated. NaN without samples.
pub fn saturation(samples: &[Sample]) -> f64 {
    samples.iter().filter(|sample| sample.is_saturated()).count() as f64 / samples.len() as f64
}

fn squared_error_m2(sample: &Sample) -> f64 {
    (0..3).map(|axis| (sample.position_m[axis] - sample.reference_position_m[axis]).powi(2)).sum()
}

/// The check of the worst vehicle.
fn check_worst(
    spec: &CheckSpec,
    flown: &FlownMotions<'_>,
    measure: impl Fn(&[Sample]) -> (f64, Option<f64>),
    limit: f64,
) -> CheckResult {
    let mut worst: Option<(f64, Option<f64>, &str)> = None;
    for vehicle in &flown.vehicles {
        let (value, at_s) = measure(vehicle.tracked);
        if worst.is_none_or(|(worst_value, ..)| is_larger(value, worst_value)) {
            worst = Some((value, at_s, vehicle.name));
        }
    }
    let (value, at_s, vehicle) = worst.ok_or(MissingEvidence::NoVehicle)?;
    let measured = Measurement::value(value).with(vehicle);
    Ok(spec.at_most(at_s.into_iter().fold(measured, Measurement::at), limit))
}
