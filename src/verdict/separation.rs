//! Separation: the smallest distance between any two vehicles, over continuous time.
//!
//! By default it is horizontal between fixed wings, as in their papers, and in space between multirotors. A vehicle that has arrived counts until the
//! mission ends for all: a multirotor hovers at its goal, a fixed wing flies straight on.

use scenarios::{CheckSpec, Plan, Scenario, Separation, SeparationMeasure};

use crate::verdict::closest::{self, ClosestApproach};
use crate::verdict::compare::{exceeds, is_smaller};
use crate::verdict::evidence::{CheckResult, Decide, Evidence, Measurement};
use crate::verdict::missing_evidence::MissingEvidence;
use crate::verdict::motion::Motion;

/// Nodes of two vehicles are compared if their times differ by no more than this, s.
const SAME_TIME_S: f64 = 1e-6;

/// Over continuous time.
pub fn check(spec: &CheckSpec, scenario: &Scenario, motions: Evidence<'_, [Motion]>) -> CheckResult {
    against_rule(spec, scenario, motions, |motions| {
        Ok(closest::between_vehicles(motions, scenario.separation_measure()))
    })
}

/// Over continuous time, of motions that end at the arrivals.
///
/// - `coast`: the motions from the first arrival until the last; none if all arrive at once
pub fn check_with_coast<'a>(
    spec: &CheckSpec,
    scenario: &Scenario,
    motions: Evidence<'_, [Motion]>,
    coast: impl Fn(&[Motion]) -> Evidence<'a, [Motion]>,
) -> CheckResult {
    let measure = scenario.separation_measure();
    against_rule(spec, scenario, motions, |motions| {
        let coast = coast(motions)?;
        let parts = [motions, coast].into_iter().filter_map(|part| closest::between_vehicles(part, measure));
        Ok(parts.reduce(ClosestApproach::closer))
    })
}

/// At the planner's nodes. Skipped if the vehicles do not share their node times.
pub fn check_nodes(spec: &CheckSpec, scenario: &Scenario, plan: Evidence<'_, Plan>) -> CheckResult {
    match plan.ok().and_then(unequal_node_time) {
        Some(reason) if scenario.separation().is_some() => Ok(spec.skip(reason)),
        _ => against_rule(spec, scenario, plan, |plan| Ok(at_nodes(plan, scenario.separation_measure()))),
    }
}

fn against_rule<T: ?Sized>(
    spec: &CheckSpec,
    scenario: &Scenario,
    evidence: Evidence<'_, T>,
    measure: impl Fn(&T) -> Result<Option<ClosestApproach>, MissingEvidence>,
) -> CheckResult {
    let Some(Separation { limit_m, .. }) = scenario.separation() else {
        return Ok(spec.skip("the fleet has no separation rule"));
    };
    if scenario.vehicles.len() < 2 {
        return Ok(spec.skip("there is only one vehicle"));
    }
    let closest = measure(evidence?)?.ok_or(MissingEvidence::NoCommonTime)?;
    let [i, j] = closest.who.map(|index| scenario.vehicles[index].name.as_str());
    Ok(spec.at_least(Measurement::approach(&closest).with(i).with(j), limit_m))
}

/// Smallest distance between two vehicles at nodes that they share. `None` if they share none.
pub fn at_nodes(plan: &Plan, measure: SeparationMeasure) -> Option<ClosestApproach> {
    let mut closest: Option<ClosestApproach> = None;
    for (i, first) in plan.trajectories.iter().enumerate() {
        for (j, second) in plan.trajectories.iter().enumerate().skip(i + 1) {
            for (node, (&at_s, _)) in first.times_s().iter().zip(second.times_s()).enumerate() {
                let [a, b] = [first, second].map(|trajectory| trajectory.nodes().position_m(node));
                let distance_m = measure.distance_m([0, 1, 2].map(|axis| a[axis] - b[axis]));
                if closest.is_none_or(|closest| is_smaller(distance_m, closest.upper_m)) {
                    closest = Some(ClosestApproach { lower_m: distance_m, upper_m: distance_m, at_s, who: [i, j] });
                }
            }
        }
    }
    closest
}

/// The first node at which two vehicles do not share their times, in words.
fn unequal_node_time(plan: &Plan) -> Option<String> {
    let (first, others) = plan.trajectories.split_first()?;
    others.iter().find_map(|other| {
        let differs = |(a, b): (&f64, &f64)| exceeds((a - b).abs(), SAME_TIME_S);
        let node = first.times_s().iter().zip(other.times_s()).position(differs)?;
        Some(format!("node {node} of {} and of {} are at different times", first.vehicle(), other.vehicle()))
    })
}
