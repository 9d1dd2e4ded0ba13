//! Do the vehicles keep clear of the obstacles?
//!
//! The smallest signed horizontal distance from any vehicle to any cylinder's surface, over continuous time. The limit
//! is 0: a threat's radius is the distance to keep.

use scenarios::{CheckSpec, Plan, Scenario, World};

use crate::verdict::Check;
use crate::verdict::closest::{self, ClosestApproach};
use crate::verdict::compare::is_smaller;
use crate::verdict::evidence::{Decide, Evidence, Measurement};
use crate::verdict::motion::Motion;

/// Over continuous time.
pub fn check(spec: &CheckSpec, scenario: &Scenario, motions: Evidence<'_, [Motion]>) -> Check {
    answer(spec, scenario, motions, |motions| closest::to_cylinders(motions, &scenario.world.cylinders))
}

/// At the planner's own nodes.
pub fn check_nodes(spec: &CheckSpec, scenario: &Scenario, plan: Evidence<'_, Plan>) -> Check {
    answer(spec, scenario, plan, |plan| at_nodes(&scenario.world, plan))
}

fn answer<T: ?Sized>(
    spec: &CheckSpec,
    scenario: &Scenario,
    evidence: Evidence<'_, T>,
    measure: impl Fn(&T) -> Option<ClosestApproach>,
) -> Check {
    if scenario.world.cylinders.is_empty() {
        return spec.skip("there are no obstacles");
    }
    match evidence.map(measure) {
        Err(reason) => spec.fail(reason),
        Ok(None) => spec.fail("no vehicle could be compared with an obstacle at any time"),
        Ok(Some(nearest)) => {
            let [vehicle, obstacle] = nearest.who;
            let names = [&scenario.vehicles[vehicle].name, &scenario.world.cylinders[obstacle].name];
            spec.at_least(Measurement::approach(&nearest).with(names[0]).with(names[1]), 0.0)
        }
    }
}

/// Smallest distance of a node to an obstacle's surface. `None` without nodes or obstacles.
pub fn at_nodes(world: &World, plan: &Plan) -> Option<ClosestApproach> {
    let mut nearest: Option<ClosestApproach> = None;
    for (i, trajectory) in plan.trajectories.iter().enumerate() {
        for (node, &at_s) in trajectory.times_s().iter().enumerate() {
            let [x_m, y_m, _] = trajectory.nodes().position_m(node);
            for (m, cylinder) in world.cylinders.iter().enumerate() {
                let distance_m = cylinder.signed_distance_m(x_m, y_m);
                if nearest.is_none_or(|nearest| is_smaller(distance_m, nearest.upper_m)) {
                    nearest = Some(ClosestApproach { lower_m: distance_m, upper_m: distance_m, at_s, who: [i, m] });
                }
            }
        }
    }
    nearest
}
