//! Clearance: the smallest signed horizontal distance from any vehicle to the surface of any cylinder, over continuous time.
//!
//! The limit is 0, since the radius of a threat is the distance to keep.

use scenarios::{CheckSpec, Plan, Scenario, World};

use crate::verdict::closest::{self, ClosestApproach};
use crate::verdict::collision::{crash, is_contact};
use crate::verdict::compare::is_smaller;
use crate::verdict::evidence::{CheckResult, Decide, Evidence, Measurement};
use crate::verdict::missing_evidence::MissingEvidence;
use crate::verdict::motion::Motion;

/// Over continuous time.
pub fn check(spec: &CheckSpec, scenario: &Scenario, motions: Evidence<'_, [Motion]>) -> CheckResult {
    against_obstacles(spec, scenario, motions, |motions| closest::to_cylinders(motions, &scenario.world.cylinders))
}

/// At the planner's nodes.
pub fn check_nodes(spec: &CheckSpec, scenario: &Scenario, plan: Evidence<'_, Plan>) -> CheckResult {
    against_obstacles(spec, scenario, plan, |plan| at_nodes(&scenario.world, plan))
}

fn against_obstacles<T: ?Sized>(
    spec: &CheckSpec,
    scenario: &Scenario,
    evidence: Evidence<'_, T>,
    measure: impl Fn(&T) -> Option<ClosestApproach>,
) -> CheckResult {
    if scenario.world.cylinders.is_empty() {
        return Ok(spec.skip("there are no obstacles"));
    }
    let closest = measure(evidence?).ok_or(MissingEvidence::NoApproach)?;
    let [vehicle, obstacle] = names(scenario, &closest);
    Ok(spec.at_least(Measurement::approach(&closest).with(vehicle).with(obstacle), 0.0))
}

/// Names of the vehicle and the cylinder that an approach is between.
fn names<'a>(scenario: &'a Scenario, approach: &ClosestApproach) -> [&'a str; 2] {
    let [vehicle, obstacle] = approach.who;
    [&scenario.vehicles[vehicle].name, &scenario.world.cylinders[obstacle].name]
}

/// The crash of the first airframe that enters a cylinder; `None` if none does.
pub fn entered_cylinder(scenario: &Scenario, motions: &[Motion]) -> Option<Measurement> {
    let entered = scenario.vehicles.iter().zip(motions).enumerate().find_map(|(index, (vehicle, motion))| {
        let closest = closest::to_cylinders(std::slice::from_ref(motion), &scenario.world.cylinders)?;
        let upper_m = closest.upper_m - scenario.model(vehicle).body_radius_m();
        Some(ClosestApproach { upper_m, who: [index, closest.who[1]], ..closest }).filter(is_contact)
    })?;
    Some(crash(entered.at_s, names(scenario, &entered)))
}

/// Smallest distance of a node to an obstacle's surface. `None` without nodes or obstacles.
pub fn at_nodes(world: &World, plan: &Plan) -> Option<ClosestApproach> {
    let mut closest: Option<ClosestApproach> = None;
    for (i, trajectory) in plan.trajectories.iter().enumerate() {
        for (node, &at_s) in trajectory.times_s().iter().enumerate() {
            let [x_m, y_m, _] = trajectory.nodes().position_m(node);
            for (m, cylinder) in world.cylinders.iter().enumerate() {
                let distance_m = cylinder.signed_distance_m(x_m, y_m);
                if closest.is_none_or(|closest| is_smaller(distance_m, closest.upper_m)) {
                    closest = Some(ClosestApproach { lower_m: distance_m, upper_m: distance_m, at_s, who: [i, m] });
                }
            }
        }
    }
    closest
}
