//! Separation: the smallest distance between any two vehicles, over continuous time.
//!
//! Of fixed wings it is horizontal, as in their papers, of multirotors in space. A vehicle that has arrived counts until the
//! mission ends for all: a multirotor hovers at its goal, a fixed wing flies straight on.

use scenarios::{CheckSpec, Plan, Scenario};

use crate::verdict::closest::{self, ClosestApproach};
use crate::verdict::compare::{exceeds, is_smaller};
use crate::verdict::evidence::{CheckResult, Decide, Evidence, Measurement};
use crate::verdict::missing_evidence::MissingEvidence;
use crate::verdict::motion::Motion;
use crate::verdict::separation_shape::SeparationShape;

/// Nodes of two vehicles are compared if their times differ by no more than this, s.
const SAME_TIME_S: f64 = 1e-6;

/// Over continuous time.
pub fn check(
    spec: &CheckSpec,
    scenario: &Scenario,
    motions: Evidence<'_, [Motion]>,
    shape: SeparationShape,
) -> CheckResult {
    against_rule(spec, scenario, motions, |motions| Ok(closest::between_vehicles(motions, shape)))
}

/// Over continuous time, of motions that end at the arrivals.
///
/// - `coast`: the motions from the first arrival until the last; none if all arrive at once
pub fn check_with_coast<'a>(
    spec: &CheckSpec,
    scenario: &Scenario,
    motions: Evidence<'_, [Motion]>,
    coast: impl Fn(&[Motion]) -> Evidence<'a, [Motion]>,
    shape: SeparationShape,
) -> CheckResult {
    against_rule(spec, scenario, motions, |motions| {
        let coast = coast(motions)?;
        let parts = [motions, coast].into_iter().filter_map(|part| closest::between_vehicles(part, shape));
        Ok(parts.reduce(ClosestApproach::closer))
    })
}

/// At the planner's nodes. Skipped if the vehicles do not share their node times.
pub fn check_nodes(
    spec: &CheckSpec,
    scenario: &Scenario,
    plan: Evidence<'_, Plan>,
    shape: SeparationShape,
) -> CheckResult {
    match plan.ok().and_then(unequal_node_time) {
        Some(reason) if scenario.fleet.separation_m.is_some() => Ok(spec.skip(reason)),
        _ => against_rule(spec, scenario, plan, |plan| Ok(at_nodes(plan, shape))),
    }
}

fn against_rule<T: ?Sized>(
    spec: &CheckSpec,
    scenario: &Scenario,
    evidence: Evidence<'_, T>,
    measure: impl Fn(&T) -> Result<Option<ClosestApproach>, MissingEvidence>,
) -> CheckResult {
    let Some(limit_m) = scenario.fleet.separation_m else {
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
pub fn at_nodes(plan: &Plan, shape: SeparationShape) -> Option<ClosestApproach> {
    let mut closest: Option<ClosestApproach> = None;
    for (i, first) in plan.trajectories.iter().enumerate() {
        for (j, second) in plan.trajectories.iter().enumerate().skip(i + 1) {
            for (node, (&at_s, _)) in first.times_s().iter().zip(second.times_s()).enumerate() {
                let [a, b] = [first, second].map(|trajectory| trajectory.nodes().position_m(node));
                let horizontal_m = (a[0] - b[0]).hypot(a[1] - b[1]);
                let distance_m = match shape {
                    SeparationShape::Horizontal => horizontal_m,
                    SeparationShape::Spatial => horizontal_m.hypot(a[2] - b[2]),
                };
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
