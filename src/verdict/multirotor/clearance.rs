//! Do the vehicles keep clear of everything: obstacles, sensed or not, those that move, and the map's frame?
//!
//! The smallest distance from the surface of any vehicle's sphere to any obstacle, over continuous time, by branch and
//! bound: within a span of time a distance cannot fall by more than vehicle and obstacle can move, which bounds it from
//! below. Spans that could hold something closer are halved until nothing could. Distances to the frame are extremes of one
//! coordinate. A flight is known at samples only: what it may [deviate](Motion::deviation_m) from the curve through them
//! makes a vehicle larger in the search, and widens the bounds.

use scenarios::{CheckSpec, Scenario};
use sim::multirotor::Obstacles;

use crate::verdict::Check;
use crate::verdict::compare::is_smaller;
use crate::verdict::evidence::{Decide, Evidence, Measurement};
use crate::verdict::map_bounds::extremes_m;
use crate::verdict::motion::{Motion, Segment};

/// Distance between the bounds that counts as close enough, m.
const RESOLUTION_M: f64 = 1e-4;
/// Most spans looked at: beyond them the bounds stay apart, and the check becomes undecided rather than wrong.
const MOST_SPANS: usize = 20_000_000;
/// What the map's frame is called.
const FRAME: &str = "map frame";

/// The closest that a vehicle came to something.
#[derive(Clone, Debug, PartialEq)]
pub struct ObstacleApproach {
    /// The distance is not smaller than this, m.
    pub lower_m: f64,
    /// It is not larger than this, m.
    pub upper_m: f64,
    /// When, s.
    pub at_s: f64,
    /// Index of the vehicle.
    pub vehicle: usize,
    /// Name of the obstacle.
    pub obstacle: String,
}

/// Over continuous time; the limit is 0.
pub fn check(spec: &CheckSpec, scenario: &Scenario, motions: Evidence<'_, [Motion]>) -> Check {
    answer(spec, scenario, motions.map(|motions| closest(scenario, motions)))
}

/// At the planner's own nodes.
pub fn check_nodes(spec: &CheckSpec, scenario: &Scenario, motions: Evidence<'_, [Motion]>) -> Check {
    let clearances = Clearances::new(scenario);
    answer(
        spec,
        scenario,
        motions.map(|motions| {
            let mut best = None;
            for (vehicle, motion) in motions.iter().enumerate() {
                for knot in motion.knots() {
                    let (distance_m, obstacle) = clearances.at(vehicle, knot.t_s, knot.position_m);
                    consider(&mut best, distance_m, || ObstacleApproach {
                        lower_m: distance_m,
                        upper_m: distance_m,
                        at_s: knot.t_s,
                        vehicle,
                        obstacle: obstacle.to_owned(),
                    });
                }
            }
            best
        }),
    )
}

/// The closest that any vehicle comes to anything. `None` without vehicles.
pub fn closest(scenario: &Scenario, motions: &[Motion]) -> Option<ObstacleApproach> {
    let surroundings = Obstacles::new(&scenario.world);
    let mut best = None;
    let (mut spans, mut unsure_m) = (0, f64::INFINITY);
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
                spans: &mut spans,
                unsure_m: &mut unsure_m,
            };
            motion.segments().filter(Segment::lasts).for_each(|segment| search.look(&segment, [0.0, 1.0]));
        }
    }
    // Whatever was not looked at more closely is no nearer than this.
    best.map(|best| ObstacleApproach {
        lower_m: (best.upper_m - RESOLUTION_M).min(unsure_m),
        upper_m: best.upper_m + 2.0 * motions[best.vehicle].deviation_m(),
        ..best
    })
}

fn answer(spec: &CheckSpec, scenario: &Scenario, closest: Result<Option<ObstacleApproach>, &str>) -> Check {
    match closest {
        Err(reason) => spec.fail(reason),
        Ok(None) => spec.fail("no vehicle could be compared with an obstacle at any time"),
        Ok(Some(closest)) => {
            let measured = Measurement::bounds(closest.lower_m, closest.upper_m).at(closest.at_s);
            spec.at_least(measured.with(&scenario.vehicles[closest.vehicle].name).with(&closest.obstacle), 0.0)
        }
    }
}

fn consider(best: &mut Option<ObstacleApproach>, distance_m: f64, found: impl FnOnce() -> ObstacleApproach) {
    if best.as_ref().is_none_or(|best| is_smaller(distance_m, best.upper_m)) {
        *best = Some(found());
    }
}

/// Distances at single instants.
pub struct Clearances<'a> {
    scenario: &'a Scenario,
    surroundings: Obstacles,
}

impl<'a> Clearances<'a> {
    /// In the world of a scenario.
    pub fn new(scenario: &'a Scenario) -> Self {
        Self { scenario, surroundings: Obstacles::new(&scenario.world) }
    }

    /// Distance of the surface of a vehicle at a place from what is nearest, m, and the name of that.
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
        for (value, at_s) in extremes_m(motion, axis) {
            let distance_m = range.margin(value) - reach_m;
            consider(best, distance_m, || ObstacleApproach {
                lower_m: distance_m,
                upper_m: distance_m,
                at_s,
                vehicle,
                obstacle: FRAME.to_owned(),
            });
        }
    }
}

/// One vehicle against one obstacle.
struct Search<'a> {
    surroundings: &'a Obstacles,
    obstacle: usize,
    /// How far the vehicle reaches from its curve, m.
    reach_m: f64,
    vehicle: usize,
    best: &'a mut Option<ObstacleApproach>,
    /// How many spans were looked at.
    spans: &'a mut usize,
    /// What a span could hold that was given up, m.
    unsure_m: &'a mut f64,
}

impl Search<'_> {
    /// Looks at the middle of a span of a segment, and at its halves if they could hold something closer.
    fn look(&mut self, segment: &Segment, [from, to]: [f64; 2]) {
        let middle = f64::midpoint(from, to);
        let t_s = segment.instant_s(middle);
        let position_m = segment.during(segment.t_s[0], t_s).points_m[3];
        let distance_m = self.surroundings.distance_m(self.obstacle, t_s, position_m) - self.reach_m;
        consider(self.best, distance_m, || ObstacleApproach {
            lower_m: distance_m,
            upper_m: distance_m,
            at_s: t_s,
            vehicle: self.vehicle,
            obstacle: self.surroundings.name(self.obstacle).to_owned(),
        });
        let duration_s = segment.t_s[1] - segment.t_s[0];
        let speed_mps = fastest_mps(segment) + self.surroundings.speed_mps(self.obstacle);
        let moved_m = speed_mps * duration_s * (to - from) / 2.0;
        let upper_m = self.best.as_ref().map_or(f64::INFINITY, |best| best.upper_m);
        *self.spans += 1;
        if distance_m - moved_m < upper_m - RESOLUTION_M {
            if *self.spans >= MOST_SPANS {
                *self.unsure_m = self.unsure_m.min(distance_m - moved_m);
                return;
            }
            self.look(segment, [from, middle]);
            self.look(segment, [middle, to]);
        }
    }
}

/// A speed that nothing in a segment exceeds: a cubic's derivative lies in the hull of its control points' differences.
fn fastest_mps(segment: &Segment) -> f64 {
    let duration_s = segment.t_s[1] - segment.t_s[0];
    let difference_m = |pair: &[[f64; 3]]| (0..3).map(|i| (pair[1][i] - pair[0][i]).powi(2)).sum::<f64>().sqrt();
    segment.points_m.windows(2).map(|pair| difference_m(pair) * 3.0 / duration_s).fold(0.0, f64::max)
}
