//! Clearance: the smallest distance from the surface of any vehicle's sphere to any obstacle, sensed or not, static or moving,
//! and to the map's frame, over continuous time.
//!
//! The search is branch and bound. Within an interval of time a distance cannot decrease by more than vehicle and obstacle
//! move, which bounds it from below. Intervals that could contain a smaller distance are halved. Distances to the frame are
//! extremes of one coordinate. A flight is known at its samples only: its [deviation](Motion::deviation_m) from the curve
//! through them enlarges the vehicle in the search and widens the bounds.

use scenarios::{CheckSpec, Scenario};
use sim::multirotor::Obstacles;

use crate::verdict::collision::{GRAZE_M, crash};
use crate::verdict::compare::is_smaller;
use crate::verdict::evidence::{CheckResult, Decide, Measurement};
use crate::verdict::map_bounds::{Extreme, extremes_m};
use crate::verdict::missing_evidence::MissingEvidence;
use crate::verdict::motion::{Motion, Segment};

/// The search stops when the bounds are this close, m.
const RESOLUTION_M: f64 = 1e-4;
/// Largest number of intervals searched; beyond it the bounds stay apart and the check may be undecided.
const MAX_INTERVALS: usize = 20_000_000;
/// Name of the map's frame in reports.
const FRAME: &str = "map frame";

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
    let surroundings = Obstacles::new(&scenario.world);
    let mut best = None;
    let (mut intervals, mut given_up_m) = (0, f64::INFINITY);
    for (vehicle, motion) in motions.iter().enumerate() {
        let reach_m = scenario.multirotor_model(&scenario.vehicles[vehicle]).body_radius_m + motion.deviation_m();
        to_frame(scenario, vehicle, motion, reach_m, &mut best);
        for obstacle in 0..surroundings.count() {
            let mut search = Search {
                surroundings: &surroundings,
                obstacle,
                reach_m,
                vehicle,
                best: &mut best,
                intervals: &mut intervals,
                given_up_m: &mut given_up_m,
            };
            motion.segments().filter(Segment::lasts).for_each(|segment| search.search(&segment, [0.0, 1.0]));
        }
    }
    best.map(|best| ObstacleApproach {
        lower_m: (best.upper_m - RESOLUTION_M).min(given_up_m),
        upper_m: best.upper_m + 2.0 * motions[best.vehicle].deviation_m(),
        ..best
    })
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

fn to_frame(scenario: &Scenario, vehicle: usize, motion: &Motion, reach_m: f64, best: &mut Option<ObstacleApproach>) {
    for (axis, range) in scenario.world.map.axes().into_iter().enumerate() {
        for Extreme { value, t_s: at_s, .. } in extremes_m(motion, axis) {
            let distance_m = range.margin(value) - reach_m;
            consider(best, distance_m, || ObstacleApproach::exact(distance_m, at_s, vehicle, FRAME));
        }
    }
}

/// One vehicle against one obstacle.
struct Search<'a> {
    surroundings: &'a Obstacles,
    obstacle: usize,
    /// Radius of the vehicle plus the deviation of its motion from the curve, m.
    reach_m: f64,
    vehicle: usize,
    best: &'a mut Option<ObstacleApproach>,
    /// Number of intervals searched.
    intervals: &'a mut usize,
    /// Smallest lower bound of the intervals that were given up, m.
    given_up_m: &'a mut f64,
}

impl Search<'_> {
    /// Measures the distance at the middle of a part of a segment, and in its halves if they could contain a smaller one.
    fn search(&mut self, segment: &Segment, [from, to]: [f64; 2]) {
        let middle = f64::midpoint(from, to);
        let t_s = segment.instant_s(middle);
        let position_m = segment.during(segment.t_s[0], t_s).points_m[3];
        let distance_m = self.surroundings.distance_m(self.obstacle, t_s, position_m) - self.reach_m;
        consider(self.best, distance_m, || {
            ObstacleApproach::exact(distance_m, t_s, self.vehicle, self.surroundings.name(self.obstacle))
        });
        let duration_s = segment.t_s[1] - segment.t_s[0];
        let speed_mps = fastest_mps(segment) + self.surroundings.speed_mps(self.obstacle);
        let moved_m = speed_mps * duration_s * (to - from) / 2.0;
        let upper_m = self.best.as_ref().map_or(f64::INFINITY, |best| best.upper_m);
        *self.intervals += 1;
        if distance_m - moved_m < upper_m - RESOLUTION_M {
            if *self.intervals >= MAX_INTERVALS {
                *self.given_up_m = self.given_up_m.min(distance_m - moved_m);
                return;
            }
            self.search(segment, [from, middle]);
            self.search(segment, [middle, to]);
        }
    }
}

/// Upper bound of the speed in a segment: the derivative of a cubic lies in the convex hull of the differences of its control
/// points.
fn fastest_mps(segment: &Segment) -> f64 {
    let duration_s = segment.t_s[1] - segment.t_s[0];
    let difference_m = |pair: &[[f64; 3]]| (0..3).map(|i| (pair[1][i] - pair[0][i]).powi(2)).sum::<f64>().sqrt();
    segment.points_m.windows(2).map(|pair| difference_m(pair) * 3.0 / duration_s).fold(0.0, f64::max)
}
