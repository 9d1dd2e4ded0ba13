//! Clearance: the smallest distance from the body of any aircraft, a sphere, to the surface of any obstacle or to the ground,
//! over continuous time.
//!
//! Cylinders are unbounded, so that the distance from them is horizontal. The limit is 0: what is to be kept beyond the
//! airframe is part of a threat's radius.

use scenarios::{CheckSpec, Plan, Scenario, World};
use sim::{GROUND, Obstacles};

use crate::verdict::closest::{self, ClosestApproach};
use crate::verdict::collision::{body_radii_m, crash, is_contact};
use crate::verdict::compare::is_smaller;
use crate::verdict::evidence::{CheckResult, Decide, Evidence, Measurement};
use crate::verdict::map_bounds::extremes_m;
use crate::verdict::missing_evidence::MissingEvidence;
use crate::verdict::motion::Motion;
use crate::verdict::obstacle_approach;

/// Over continuous time.
///
/// - `coast`: how the vehicles go on after the first arrival, until the last
pub fn check<'a>(
    spec: &CheckSpec,
    scenario: &Scenario,
    motions: Evidence<'_, [Motion]>,
    coast: impl Fn(&[Motion]) -> Evidence<'a, [Motion]>,
) -> CheckResult {
    against_obstacles(spec, scenario, motions, |motions| {
        let coast = coast(motions)?;
        Ok([motions, coast].into_iter().filter_map(|part| closest(scenario, part)).reduce(closer))
    })
}

/// At the planner's nodes.
pub fn check_nodes(spec: &CheckSpec, scenario: &Scenario, plan: Evidence<'_, Plan>) -> CheckResult {
    against_obstacles(spec, scenario, plan, |plan| Ok(at_nodes(scenario, plan)))
}

fn against_obstacles<T: ?Sized>(
    spec: &CheckSpec,
    scenario: &Scenario,
    evidence: Evidence<'_, T>,
    measure: impl Fn(&T) -> Result<Option<ClosestApproach>, MissingEvidence>,
) -> CheckResult {
    let world = &scenario.world;
    if world.obstacle_names().next().is_none() && world.ground_m.is_none() {
        return Ok(spec.skip("there are no obstacles"));
    }
    let closest = measure(evidence?)?.ok_or(MissingEvidence::NoApproach)?;
    let [vehicle, obstacle] = names(scenario, &closest);
    Ok(spec.at_least(Measurement::approach(&closest).with(vehicle).with(obstacle), 0.0))
}

/// Names of the vehicle and the obstacle that an approach is between.
fn names<'a>(scenario: &'a Scenario, approach: &ClosestApproach) -> [&'a str; 2] {
    let [vehicle, obstacle] = approach.who;
    [&scenario.vehicles[vehicle].name, obstacle_name(&scenario.world, obstacle)]
}

/// Name of an obstacle by its index: cylinders, the ground, then boxes, prisms and the other shapes.
fn obstacle_name(world: &World, obstacle: usize) -> &str {
    let others = world.obstacle_lists().into_iter().filter(|(list, _)| !["cylinders", "moving"].contains(list));
    let cylinders = world.cylinders.iter().map(|cylinder| cylinder.name.as_str());
    cylinders.chain([GROUND]).chain(others.flat_map(|(_, names)| names)).nth(obstacle).unwrap_or_default()
}

/// The crash of the first airframe that enters an obstacle or touches the ground; `None` if none does.
pub fn entered_obstacle(scenario: &Scenario, motions: &[Motion]) -> Option<Measurement> {
    let radii_m = body_radii_m(scenario);
    let entered = motions.iter().zip(&radii_m).enumerate().find_map(|(index, (motion, &radius_m))| {
        let closest = closest_of(scenario, std::slice::from_ref(motion), &[radius_m])?;
        Some(ClosestApproach { who: [index, closest.who[1]], ..closest }).filter(is_contact)
    })?;
    Some(crash(entered.at_s, names(scenario, &entered)))
}

/// Closest approach of any body to an obstacle, by its index: cylinders, the ground, then boxes, prisms and the other shapes.
/// `None` without motions or obstacles.
pub fn closest(scenario: &Scenario, motions: &[Motion]) -> Option<ClosestApproach> {
    closest_of(scenario, motions, &body_radii_m(scenario))
}

fn closest_of(scenario: &Scenario, motions: &[Motion], radii_m: &[f64]) -> Option<ClosestApproach> {
    let cylinders = &scenario.world.cylinders;
    let to_ground = scenario.world.ground_m.and_then(|ground_m| {
        let heights = motions.iter().zip(radii_m).enumerate().map(|(index, (motion, radius_m))| {
            let lowest = extremes_m(motion, 2)[0];
            let height_m = lowest.value - radius_m - ground_m;
            let deviation_m = if motion.is_reconstructed() { lowest.error } else { motion.deviation_m() };
            ClosestApproach {
                lower_m: height_m - deviation_m,
                upper_m: height_m + deviation_m,
                at_s: lowest.t_s,
                who: [index, cylinders.len()],
            }
        });
        heights.reduce(closer)
    });
    let to_others = to_others(&scenario.world, motions, radii_m);
    closest::to_cylinders(motions, radii_m, cylinders).into_iter().chain(to_ground).chain(to_others).reduce(closer)
}

/// How close the bounds of a distance from an obstacle that is not a cylinder are, m: 1 mm, or 1/1000 of a larger distance. In
/// level flight over level ground every instant is the closest one, and the search visits all of them.
fn resolution_m(distance_m: f64) -> f64 {
    1e-3 * distance_m.abs().max(1.0)
}

/// Closest approach of any body to an obstacle that is not a cylinder. `None` without either.
fn to_others(world: &World, motions: &[Motion], radii_m: &[f64]) -> Option<ClosestApproach> {
    let obstacles = Obstacles::beyond_cylinders(world);
    let found = obstacle_approach::closest(&obstacles, None, motions, radii_m, resolution_m)?;
    let obstacle = world.cylinders.len() + 1 + found.obstacle?;
    let obstacle_approach::ClosestApproach { lower_m, upper_m, at_s, vehicle, .. } = found;
    Some(ClosestApproach { lower_m, upper_m, at_s, who: [vehicle, obstacle] })
}

/// Closest obstacle of a body at a node. `None` without nodes or obstacles.
pub fn at_nodes(scenario: &Scenario, plan: &Plan) -> Option<ClosestApproach> {
    let nodes = plan.trajectories.iter().enumerate().flat_map(|(vehicle, trajectory)| {
        let at_node = move |(node, &at_s)| at_instant(scenario, vehicle, at_s, trajectory.nodes().position_m(node));
        trajectory.times_s().iter().enumerate().filter_map(at_node)
    });
    nodes.reduce(closer)
}

/// Closest obstacle of the body of a vehicle, by its index, at a position. `None` without obstacles.
pub fn at_instant(scenario: &Scenario, vehicle: usize, at_s: f64, position_m: [f64; 3]) -> Option<ClosestApproach> {
    let (world, [x_m, y_m, z_m]) = (&scenario.world, position_m);
    let cylinders = world.cylinders.iter().map(|cylinder| cylinder.signed_distance_m(x_m, y_m));
    let to_ground = world.ground_m.map(|ground_m| (world.cylinders.len(), z_m - ground_m));
    let others = Obstacles::beyond_cylinders(world);
    let to_others =
        (0..others.count()).map(|it| (world.cylinders.len() + 1 + it, others.distance_m(it, at_s, position_m)));
    let distances_m = cylinders.enumerate().chain(to_ground).chain(to_others);
    let radius_m = scenario.fixed_wing_model(scenario.vehicles.get(vehicle)?).body_radius_m;
    let approaches = distances_m.map(|(obstacle, distance_m)| {
        let distance_m = distance_m - radius_m;
        ClosestApproach { lower_m: distance_m, upper_m: distance_m, at_s, who: [vehicle, obstacle] }
    });
    approaches.reduce(closer)
}

/// Bounds of the smaller one of two distances.
fn closer(so_far: ClosestApproach, next: ClosestApproach) -> ClosestApproach {
    let upper_m = if is_smaller(next.upper_m, so_far.upper_m) { next.upper_m } else { so_far.upper_m };
    let closest = if is_smaller(next.lower_m, so_far.lower_m) { next } else { so_far };
    ClosestApproach { upper_m, ..closest }
}
