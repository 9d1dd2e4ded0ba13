//! Goals: the position in which a vehicle ends and, of fixed wings, its velocity.
//!
//! The parts of a goal have tolerances of different units, so that they are compared as fractions of their tolerances; the
//! check reports the worst one. Headings are compared modulo a full turn. Velocities are over ground. Of a vehicle
//! that hovers the position alone is asked here: whether it has come to rest is a check of its own.

use scenarios::{CheckSpec, Family, Plan, Scenario};
use sim::Sample;

use crate::verdict::Check;
use crate::verdict::arrival::not_arrived;
use crate::verdict::end::{End, Part, arrival_knot, arrival_node, node_knot};
use crate::verdict::evidence::{CheckResult, Decide, Measurement};
use crate::verdict::flown::FlownMotions;
use crate::verdict::missing_evidence::MissingEvidence;
use crate::verdict::motion::{Knot, Motion};
use crate::verdict::tube::EndError;

/// The nodes of arrival.
///
/// - `error`: of the end of the vehicle with this index
pub fn check_nodes(
    spec: &CheckSpec,
    scenario: &Scenario,
    plan: &Plan,
    error: impl Fn(usize, &Knot) -> EndError,
) -> CheckResult {
    check_worst(spec, scenario, |index| {
        let (vehicle, trajectory) = (&scenario.vehicles[index], &plan.trajectories[index]);
        let node = arrival_node(scenario, vehicle, trajectory).ok_or_else(|| ends_early(scenario, index))?;
        let end = node_knot(trajectory, node);
        Ok(End::at(vehicle, &end, error(index, &end)))
    })
}

/// The continuous plan at arrival.
///
/// - `error`: of the end of the vehicle with this index
pub fn check_planned(
    spec: &CheckSpec,
    scenario: &Scenario,
    plan: &Plan,
    motions: &[Motion],
    error: impl Fn(usize, &Knot) -> EndError,
) -> CheckResult {
    check_worst(spec, scenario, |index| {
        let vehicle = &scenario.vehicles[index];
        let end = arrival_knot(scenario, vehicle, &plan.trajectories[index], &motions[index]);
        let end = end.ok_or_else(|| ends_early(scenario, index))?;
        Ok(End::at(vehicle, end, error(index, end)))
    })
}

/// The closest approaches in flight.
///
/// - `error`: of the end of the plan of the vehicle with this index
pub fn check_flown(
    spec: &CheckSpec,
    scenario: &Scenario,
    flown: &FlownMotions<'_>,
    error: impl Fn(usize) -> EndError,
) -> CheckResult {
    check_worst(spec, scenario, |index| {
        let vehicle = &flown.vehicles[index];
        let approach = vehicle.approach.ok_or_else(|| not_arrived(vehicle))?;
        let velocity_mps = velocity_mps(vehicle.judged, approach.at_s).unwrap_or([f64::NAN; 3]);
        let distance_m = [approach.lower_m, approach.upper_m];
        Ok(End { t_s: approach.at_s, distance_m, velocity_mps, error: error(index) })
    })
}

/// The check of the part, of any vehicle, that uses most of its tolerance.
///
/// - `end`: of the vehicle with this index
pub(super) fn check_worst(
    spec: &CheckSpec,
    scenario: &Scenario,
    end: impl Fn(usize) -> Result<End, MissingEvidence>,
) -> CheckResult {
    let (family, limits) = (scenario.family(), scenario.limits());
    let mut worst: Option<(Part, f64, &str)> = None;
    for (index, vehicle) in scenario.vehicles.iter().enumerate() {
        let end = end(index)?;
        for part in end.parts(family, vehicle, &limits) {
            if worst.as_ref().is_none_or(|(worst, ..)| part.is_worse(worst)) {
                worst = Some((part, end.t_s, &vehicle.name));
            }
        }
    }
    let (part, t_s, vehicle) = worst.ok_or(MissingEvidence::NoVehicle)?;
    Ok(check_part(spec, family, &part, t_s, vehicle))
}

fn check_part(spec: &CheckSpec, family: Family, part: &Part, t_s: f64, vehicle: &str) -> Check {
    let [lower, upper] = part.off;
    let measured = if lower == upper { Measurement::value(upper) } else { Measurement::bounds(lower, upper) };
    let measured = measured.at(t_s).with(vehicle);
    let measured = if family.hovers() { measured } else { measured.with_reason(format!("it is the {}", part.name)) };
    let spec = CheckSpec { unit: part.unit, ..*spec };
    Check { limit_key: Some(part.key), ..spec.at_most(measured, part.tolerance) }
}

fn ends_early(scenario: &Scenario, index: usize) -> MissingEvidence {
    MissingEvidence::EndsEarly { vehicle: scenario.vehicles[index].name.clone() }
}

/// Velocity at `t_s`, between two samples the interpolated one, m/s.
fn velocity_mps(samples: &[Sample], t_s: f64) -> Option<[f64; 3]> {
    let after = samples.partition_point(|sample| sample.t_s < t_s);
    let [before, after] = [samples.get(after.saturating_sub(1))?, samples.get(after).or(samples.last())?];
    let span_s = after.t_s - before.t_s;
    let fraction = if span_s > 0.0 { (t_s - before.t_s) / span_s } else { 0.0 };
    Some(std::array::from_fn(|axis| {
        before.velocity_mps[axis] + fraction * (after.velocity_mps[axis] - before.velocity_mps[axis])
    }))
}

#[cfg(test)]
mod tests {
    use sim::Sample;

    use super::velocity_mps;
    use crate::verdict::still_sample::still_sample;

    /// Samples 0.5 s apart from 2 s on, with a velocity of (3 t, -t, 0).
    fn samples() -> Vec<Sample> {
        let sample = |t_s: f64| Sample { velocity_mps: [3.0 * t_s, -t_s, 0.0], ..still_sample(t_s) };
        (0..4).map(|step| sample(2.0 + 0.5 * f64::from(step))).collect()
    }

    #[test]
    fn a_velocity_is_interpolated_between_samples_and_kept_beyond_them() {
        let samples = samples();
        for (t_s, at_s) in [(2.0, 2.0), (2.5, 2.5), (2.75, 2.75), (3.4, 3.4), (3.5, 3.5)] {
            let found = velocity_mps(&samples, t_s).unwrap();
            let expected = [3.0 * at_s, -at_s, 0.0];
            assert!((0..3).all(|axis| (found[axis] - expected[axis]).abs() < 1e-12), "{found:?} at {t_s} s");
        }
        assert_eq!(velocity_mps(&samples, 9.0), Some([10.5, -3.5, 0.0]));
        assert_eq!(velocity_mps(&[], 2.0), None);
    }
}
