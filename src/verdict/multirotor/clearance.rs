//! Clearance: the smallest distance from the surface of any vehicle's sphere to any obstacle, sensed or not, static or moving,
//! and to the map's frame, over continuous time.
//!
//! A flight is known at its samples only: its [deviation](Motion::deviation_m) from the curve through them enlarges the
//! vehicle in the [search](obstacle_approach) and widens the bounds.

use scenarios::{CheckSpec, Scenario};
use sim::Obstacles;

use crate::verdict::collision::{GRAZE_M, body_radii_m, crash};
use crate::verdict::compare::is_smaller;
use crate::verdict::evidence::{CheckResult, Decide, Measurement};
use crate::verdict::missing_evidence::MissingEvidence;
use crate::verdict::motion::Motion;
use crate::verdict::obstacle_approach::{self, ClosestApproach};

/// How close the bounds of a clearance are, m.
const RESOLUTION_M: f64 = 1e-4;
/// Name of the map's frame in reports.
pub const FRAME: &str = "map frame";

/// The closest approach of a vehicle to an obstacle.
#[derive(Clone, Debug, PartialEq)]
pub struct ObstacleApproach {
    /// Lower bound of the distance, m.
    pub lower_m: f64,
    /// Upper bound of the distance, m.
    pub upper_m: f64,
    /// Its time, s.
    pub at_s: f64,
    /// Index of the vehicle.
    pub vehicle: usize,
    /// Name of the obstacle.
    pub obstacle: String,
}

impl ObstacleApproach {
    fn exact(distance_m: f64, at_s: f64, vehicle: usize, obstacle: &str) -> Self {
        Self { lower_m: distance_m, upper_m: distance_m, at_s, vehicle, obstacle: obstacle.to_owned() }
    }
}

/// Over continuous time. The limit is 0.
pub fn check(spec: &CheckSpec, scenario: &Scenario, motions: &[Motion]) -> CheckResult {
    check_closest(spec, scenario, closest(scenario, motions))
}

/// At the planner's nodes.
pub fn check_nodes(spec: &CheckSpec, scenario: &Scenario, motions: &[Motion]) -> CheckResult {
    let clearances = Clearances::new(scenario);
    let mut best = None;
    for (vehicle, motion) in motions.iter().enumerate() {
        for knot in motion.knots() {
            let (distance_m, obstacle) = clearances.at(vehicle, knot.t_s, knot.position_m);
            consider(&mut best, distance_m, || ObstacleApproach::exact(distance_m, knot.t_s, vehicle, obstacle));
        }
    }
    check_closest(spec, scenario, best)
}

/// The closest approach of any vehicle to any obstacle or to the frame. `None` without vehicles.
pub fn closest(scenario: &Scenario, motions: &[Motion]) -> Option<ObstacleApproach> {
    let obstacles = Obstacles::new(&scenario.world);
    let (map, radii_m) = (&scenario.world.map, body_radii_m(scenario));
    let found = obstacle_approach::closest(&obstacles, Some(map), motions, &radii_m, |_| RESOLUTION_M)?;
    let obstacle = found.obstacle.map_or(FRAME, |obstacle| obstacles.name(obstacle)).to_owned();
    let ClosestApproach { lower_m, upper_m, at_s, vehicle, .. } = found;
    Some(ObstacleApproach { lower_m, upper_m, at_s, vehicle, obstacle })
}

fn check_closest(spec: &CheckSpec, scenario: &Scenario, closest: Option<ObstacleApproach>) -> CheckResult {
    let closest = closest.ok_or(MissingEvidence::NoApproach)?;
    let measured = Measurement::bounds(closest.lower_m, closest.upper_m).at(closest.at_s);
    Ok(spec.at_least(measured.with(&scenario.vehicles[closest.vehicle].name).with(&closest.obstacle), 0.0))
}

/// The crash of the first sample inside an obstacle, static or moving; `None` if there is none. What happens between two
/// samples is left to the clearance.
pub fn entered_obstacle(scenario: &Scenario, motions: &[Motion]) -> Option<Measurement> {
    let surroundings = Obstacles::new(&scenario.world);
    scenario.vehicles.iter().zip(motions).find_map(|(vehicle, motion)| {
        let radius_m = scenario.multirotor_model(vehicle).body_radius_m;
        motion.knots().iter().find_map(|knot| {
            let distance_m = |obstacle| surroundings.distance_m(obstacle, knot.t_s, knot.position_m) - radius_m;
            let entered = (0..surroundings.count()).find(|obstacle| distance_m(*obstacle) < -GRAZE_M)?;
            Some(crash(knot.t_s, [&vehicle.name, surroundings.name(entered)]))
        })
    })
}

fn consider(best: &mut Option<ObstacleApproach>, distance_m: f64, found: impl FnOnce() -> ObstacleApproach) {
    if best.as_ref().is_none_or(|best| is_smaller(distance_m, best.upper_m)) {
        *best = Some(found());
    }
}

/// Distances at one instant.
pub struct Clearances<'a> {
    scenario: &'a Scenario,
    surroundings: Obstacles,
}

impl<'a> Clearances<'a> {
    /// Clearances in the world of a scenario.
    pub fn new(scenario: &'a Scenario) -> Self {
        Self { scenario, surroundings: Obstacles::new(&scenario.world) }
    }

    /// Distance from the surface of a vehicle at `position_m` to the closest obstacle or the frame, m, and the name of that.
    pub fn at(&self, vehicle: usize, t_s: f64, position_m: [f64; 3]) -> (f64, &str) {
        let Self { scenario, surroundings } = self;
        let radius_m = scenario.multirotor_model(&scenario.vehicles[vehicle]).body_radius_m;
        let margins = scenario.world.map.axes().into_iter().zip(position_m).map(|(range, value)| range.margin(value));
        let mut nearest = (margins.fold(f64::INFINITY, f64::min), FRAME);
        for obstacle in 0..surroundings.count() {
            let distance_m = surroundings.distance_m(obstacle, t_s, position_m);
            if is_smaller(distance_m, nearest.0) {
                nearest = (distance_m, surroundings.name(obstacle));
            }
        }
        (nearest.0 - radius_m, nearest.1)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::verdict::motion::Knot;

    #[test]
    fn a_cart_that_passes_a_hovering_vehicle_between_its_knots_is_found() {
        let mut scenario = scenarios::load("shipped:corridor-moving".as_ref()).expect("a shipped scenario");
        scenario.world.boxes.clear();
        scenario.world.prisms.clear();
        scenario.world.cylinders.clear();
        scenario.world.moving.truncate(1);
        let [x_m, y_m, z_m] = scenario.world.map.axes().map(|axis| f64::midpoint(axis.min, axis.max));
        let cart = &mut scenario.world.moving[0];
        // It passes at 1 m, at 5 s, and is 100 m away at the knots, at 0 s and 10 s.
        cart.path_m = vec![[x_m - 100.0, y_m + 1.0], [x_m + 100.0, y_m + 1.0]];
        (cart.speed_mps, cart.offset_m, cart.z_m, cart.radius_m) = (20.0, 0.0, None, 0.5);
        let knot = |t_s| Knot { t_s, position_m: [x_m, y_m, z_m], velocity_mps: [0.0; 3] };
        let motion = Motion::new(&scenario.vehicles[0].name, vec![knot(0.0), knot(5.2), knot(10.0)]).unwrap();
        let reach_m = scenario.multirotor_model(&scenario.vehicles[0]).body_radius_m;
        let found = closest(&scenario, &[motion]).expect("an approach");
        assert!((found.at_s - 5.0).abs() < 0.01 && found.obstacle == scenario.world.moving[0].name, "{found:?}");
        let distance_m = 1.0 - 0.5 - reach_m;
        assert!(found.lower_m <= distance_m && distance_m <= found.upper_m + 1e-9, "{found:?}, not {distance_m}");
        assert!(found.upper_m - found.lower_m < 1e-3, "{found:?}");
    }
}
