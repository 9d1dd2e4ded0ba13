//! Rest: the speed at the end of the plan.

use scenarios::{CheckSpec, Plan, Scenario};
use sim::Sample;

use crate::verdict::compare::is_larger;
use crate::verdict::evidence::{CheckResult, Decide, Measurement};
use crate::verdict::missing_evidence::MissingEvidence;
use crate::verdict::motion::Motion;
use crate::verdict::{Check, FlownMotions};

/// Times that differ by less are the same, s: rounding.
const SAME_TIME_S: f64 = 1e-6;

/// A remark on the recorded plan of an in-loop flight.
pub const RECORD: &str = "the plan of an in-loop flight is the record of the references that were followed, each of which \
                          begins at a measured state, until the vehicles arrived";

/// Speed at the end of the plan.
pub fn check_planned(spec: &CheckSpec, scenario: &Scenario, motions: &[Motion]) -> CheckResult {
    let check = check_fastest(spec, scenario, |index| {
        let last = motions.get(index)?.knots().last()?;
        Some((last.velocity_mps, last.t_s))
    })?;
    let remark = check.is_bad().then(|| format!("it ends in motion; {RECORD}"));
    Ok(Check { reason: remark.or(check.reason), ..check })
}

/// Speed in flight at the end of the plan.
pub fn check_flown(spec: &CheckSpec, scenario: &Scenario, plan: &Plan, flown: &FlownMotions<'_>) -> CheckResult {
    check_fastest(spec, scenario, |index| {
        let end_s = plan.trajectories.get(index)?.end_s()?;
        let is_end = |sample: &&Sample| sample.t_s >= end_s - SAME_TIME_S;
        let sample = flown.vehicles.get(index)?.judged.iter().find(is_end)?;
        Some((sample.velocity_mps, sample.t_s))
    })
}

/// - `end`: velocity, m/s, and time, s, at the end of a vehicle's plan
fn check_fastest(spec: &CheckSpec, scenario: &Scenario, end: impl Fn(usize) -> Option<([f64; 3], f64)>) -> CheckResult {
    let mut fastest: Option<(f64, f64, &str)> = None;
    for (index, vehicle) in scenario.vehicles.iter().enumerate() {
        let early = || MissingEvidence::EndsEarly { vehicle: vehicle.name.clone() };
        let (velocity_mps, t_s) = end(index).ok_or_else(early)?;
        let speed_mps = velocity_mps.iter().map(|component| component * component).sum::<f64>().sqrt();
        if fastest.is_none_or(|(worst_mps, ..)| is_larger(speed_mps, worst_mps)) {
            fastest = Some((speed_mps, t_s, &vehicle.name));
        }
    }
    let (speed_mps, t_s, vehicle) = fastest.ok_or(MissingEvidence::NoVehicle)?;
    Ok(spec.at_most(Measurement::value(speed_mps).at(t_s).with(vehicle), scenario.limits().rest_mps))
}
