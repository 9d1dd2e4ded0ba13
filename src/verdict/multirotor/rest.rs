//! Rest: the speed at the end of the plan.

use nalgebra::Vector3;
use scenarios::{CheckSpec, Plan, Scenario};
use sim::Sample;

use crate::verdict::compare::is_worse;
use crate::verdict::evidence::{CheckResult, Decide, Measurement};
use crate::verdict::missing_evidence::MissingEvidence;
use crate::verdict::motion::Motion;
use crate::verdict::{Check, EndVelocity, FlownMotions, Provenance, Status};

/// Times that differ by less are the same, s: rounding.
const SAME_TIME_S: f64 = 1e-6;

/// A remark on the recorded plan of an in-loop flight.
pub const RECORD: &str = "the plan of an in-loop flight is the record of the references that were followed, each of which \
                          begins at a measured state, until the vehicles arrived";

/// Speed at the end of the plan. Of a plan of positions it is what they tell of the last velocity.
pub fn check_planned(
    spec: &CheckSpec,
    scenario: &Scenario,
    motions: &[Motion],
    provenance: &Provenance,
) -> CheckResult {
    let check = check_fastest(spec, scenario, |index| {
        let last = motions.get(index)?.knots().last()?;
        let given = EndVelocity { velocity_mps: last.velocity_mps, error_mps: 0.0 };
        Some((provenance.end_velocity(index).unwrap_or(given), last.t_s))
    })?;
    let remark = (check.status == Status::Fail).then(|| format!("it ends in motion; {RECORD}"));
    Ok(Check { reason: remark.or(check.reason), ..check })
}

/// Speed in flight at the end of the plan.
pub fn check_flown(
    spec: &CheckSpec,
    scenario: &Scenario,
    plan: &Plan,
    flown: &FlownMotions<'_>,
    provenance: &Provenance,
) -> CheckResult {
    check_fastest(spec, scenario, |index| {
        let end_s = plan.trajectories.get(index)?.end_s()?;
        let is_end = |sample: &&Sample| sample.t_s >= end_s - SAME_TIME_S;
        let sample = flown.vehicles.get(index)?.judged.iter().find(is_end)?;
        let error_mps = provenance.end_velocity(index).map_or(0.0, |planned| planned.error_mps);
        Some((EndVelocity { velocity_mps: sample.velocity_mps, error_mps }, sample.t_s))
    })
}

/// The check of the vehicle that is fastest at its end.
///
/// - `end`: velocity, and time, s, at the end of a vehicle's plan
pub fn check_fastest(
    spec: &CheckSpec,
    scenario: &Scenario,
    end: impl Fn(usize) -> Option<(EndVelocity, f64)>,
) -> CheckResult {
    let limit_mps = scenario.limits().rest_mps;
    let mut fastest: Option<([f64; 2], f64, &str)> = None;
    for (index, vehicle) in scenario.vehicles.iter().enumerate() {
        let early = || MissingEvidence::EndsEarly { vehicle: vehicle.name.clone() };
        let (EndVelocity { velocity_mps, error_mps }, t_s) = end(index).ok_or_else(early)?;
        let speed_mps = Vector3::from(velocity_mps).norm();
        let bounds_mps = [speed_mps - error_mps, speed_mps + error_mps];
        if fastest.is_none_or(|(worst_mps, ..)| is_worse(bounds_mps, worst_mps, limit_mps)) {
            fastest = Some((bounds_mps, t_s, &vehicle.name));
        }
    }
    let ([lower_mps, upper_mps], t_s, vehicle) = fastest.ok_or(MissingEvidence::NoVehicle)?;
    let speed = if lower_mps == upper_mps {
        Measurement::value(upper_mps)
    } else {
        Measurement::bounds(lower_mps.max(0.0), upper_mps)
    };
    Ok(spec.at_most(speed.at(t_s).with(vehicle), limit_mps))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_speed_that_is_certainly_too_high_fails_and_one_that_may_be_is_undecided() {
        let mut scenario = scenarios::load("shipped:crossing-4".as_ref()).expect("a shipped scenario");
        scenario.verdict.rest_mps = Some(0.2);
        let spec = scenarios::check_spec("plan.rest").expect("a declared check");
        let status = |speed_mps: f64, error_mps: f64| {
            let end = EndVelocity { velocity_mps: [0.0, 0.6 * speed_mps, 0.8 * speed_mps], error_mps };
            check_fastest(spec, &scenario, |_| Some((end, 9.0))).expect("a vehicle").status
        };
        assert_eq!(status(0.15, 0.0), Status::Pass);
        assert_eq!(status(0.15, 0.04), Status::Pass);
        assert_eq!(status(0.15, 0.1), Status::Undecided);
        assert_eq!(status(0.25, 0.04), Status::Fail);
        assert_eq!(status(0.25, 0.0), Status::Fail);
    }
}
