//! Do the vehicles keep their distance from each other?
//!
//! The smallest horizontal distance between any two vehicles, over continuous time, against the fleet's rule. A vehicle
//! counts until it has arrived: beyond the end of its trajectory it no longer exists for the others.

use scenarios::{CheckSpec, Plan, Scenario};

use crate::verdict::Check;
use crate::verdict::closest::{self, ClosestApproach};
use crate::verdict::compare::{exceeds, is_smaller};
use crate::verdict::evidence::{Decide, Evidence, Measurement};
use crate::verdict::motion::Motion;

/// Nodes of two vehicles are compared when their times agree within this, s.
const SAME_TIME_S: f64 = 1e-6;

/// Over continuous time.
pub fn check(spec: &CheckSpec, scenario: &Scenario, motions: Evidence<'_, [Motion]>) -> Check {
    answer(spec, scenario, motions, closest::between_vehicles)
}

/// At the planner's own nodes, which all vehicles must share: otherwise it is skipped.
pub fn check_nodes(spec: &CheckSpec, scenario: &Scenario, plan: Evidence<'_, Plan>) -> Check {
    match plan.ok().and_then(odd_node_time) {
        Some(reason) if scenario.fleet.separation_m.is_some() => spec.skip(reason),
        _ => answer(spec, scenario, plan, at_nodes),
    }
}

fn answer<T: ?Sized>(
    spec: &CheckSpec,
    scenario: &Scenario,
    evidence: Evidence<'_, T>,
    measure: impl Fn(&T) -> Option<ClosestApproach>,
) -> Check {
    let Some(limit_m) = scenario.fleet.separation_m else { return spec.skip("the fleet has no rule for it") };
    if scenario.vehicles.len() < 2 {
        return spec.skip("there is one vehicle only");
    }
    match evidence.map(measure) {
        Err(reason) => spec.fail(reason),
        Ok(None) => spec.fail("no two vehicles could be compared at any time"),
        Ok(Some(nearest)) => {
            let [i, j] = nearest.who.map(|index| scenario.vehicles[index].name.as_str());
            spec.at_least(Measurement::approach(&nearest).with(i).with(j), limit_m)
        }
    }
}

/// Smallest horizontal distance between two vehicles at nodes that they share. `None` if they share none.
pub fn at_nodes(plan: &Plan) -> Option<ClosestApproach> {
    let mut nearest: Option<ClosestApproach> = None;
    for (i, first) in plan.trajectories.iter().enumerate() {
        for (j, second) in plan.trajectories.iter().enumerate().skip(i + 1) {
            for (node, (&at_s, _)) in first.times_s().iter().zip(second.times_s()).enumerate() {
                let [a, b] = [first, second].map(|trajectory| trajectory.nodes().position_m(node));
                let distance_m = (a[0] - b[0]).hypot(a[1] - b[1]);
                if nearest.is_none_or(|nearest| is_smaller(distance_m, nearest.upper_m)) {
                    nearest = Some(ClosestApproach { lower_m: distance_m, upper_m: distance_m, at_s, who: [i, j] });
                }
            }
        }
    }
    nearest
}

/// Two vehicles whose nodes do not share their times, in words.
pub fn odd_node_time(plan: &Plan) -> Option<String> {
    let (first, others) = plan.trajectories.split_first()?;
    others.iter().find_map(|other| {
        let differs = |(a, b): (&f64, &f64)| exceeds((a - b).abs(), SAME_TIME_S);
        let odd = first.times_s().iter().zip(other.times_s()).position(differs)?;
        Some(format!("node {odd} of {} and of {} are at different times", first.vehicle(), other.vehicle()))
    })
}
