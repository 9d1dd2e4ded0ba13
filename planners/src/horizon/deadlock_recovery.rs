//! Recovery from deadlocks. Where a vehicle gets no nearer to its goal, because the sampler does not find the way through a
//! passage to which the cost map leads, it follows the roadmap until it has got past.

use super::problem::{CLEARANCE_TOLERANCE_M, HorizonProblem};
use crate::free_space::{FreeSpace, Obstacle, Point};
use crate::multirotor::PointMassMotion;
use crate::roadmap::CostMap;
use crate::search::timing::timed_motion;

/// Decrease of the cost-to-go that counts as progress, m.
const MIN_PROGRESS_M: f64 = 0.25;

/// Successive replans without progress after which the roadmap is followed.
const MAX_IDLE_REPLANS: usize = 8;

/// Decrease of the cost-to-go below that of the deadlock after which the sampler plans again, m.
const RECOVERY_M: f64 = 3.0;

/// Deviations from the roadmap's corners that are tried in this order, m.
const CORNER_DEVIATIONS_M: [f64; 3] = [0.1, 0.02, 0.0];

/// Distance below which two points of a path are one, m.
const MIN_LEG_M: f64 = 1e-6;

/// Observes the cost-to-go from replan to replan.
#[derive(Clone, Debug)]
pub struct ProgressMonitor {
    /// Smallest cost-to-go so far, m.
    best_m: f64,
    idle_replans: usize,
    /// Cost-to-go at which the recovery in progress ends, m.
    recovered_below_m: Option<f64>,
}

impl ProgressMonitor {
    /// Before the first replan.
    pub fn new() -> Self {
        Self { best_m: f64::INFINITY, idle_replans: 0, recovered_below_m: None }
    }

    /// Starts anew, as the cost-to-go of a changed map does not compare with that of the old one.
    pub fn reset(&mut self) {
        *self = Self::new();
    }

    /// Takes the present cost-to-go, m, and returns whether the vehicle is to follow the roadmap.
    pub fn is_deadlocked(&mut self, cost_to_go_m: f64) -> bool {
        if cost_to_go_m < self.best_m - MIN_PROGRESS_M {
            (self.best_m, self.idle_replans) = (cost_to_go_m, 0);
        } else {
            self.idle_replans += 1;
        }
        if self.recovered_below_m.is_some_and(|end_m| cost_to_go_m < end_m) {
            (self.recovered_below_m, self.idle_replans) = (None, 0);
        }
        // where the rest of the path is shorter than that, recovery leads to the goal
        if self.idle_replans > MAX_IDLE_REPLANS && cost_to_go_m > MIN_PROGRESS_M {
            self.recovered_below_m.get_or_insert(self.best_m - RECOVERY_M);
        }
        self.recovered_below_m.is_some()
    }
}

/// The cost map around vehicles that have come to rest. They are no static obstacles, as they may go on.
#[derive(Clone, Debug)]
pub struct DetourMap {
    /// The static obstacles and the resting vehicles.
    space: FreeSpace,
    map: CostMap,
}

/// Distance within which a moving obstacle counts as resting, m, if it stays there for so long, s.
const RESTING_WITHIN_M: f64 = 0.1;
const RESTING_S: f64 = 3.0;

impl DetourMap {
    /// The map around what rests in `space`; `None` if nothing does. `previous` is taken over if it is the same.
    ///
    /// - `map`: that of the static obstacles alone
    pub fn around_resting(previous: Option<Self>, space: &FreeSpace, map: &CostMap) -> Option<Self> {
        let moving = space.moving_obstacles.iter();
        let resting = moving.filter(|obstacle| obstacle.stays(RESTING_WITHIN_M, RESTING_S));
        let resting: Vec<Obstacle> = resting.map(|obstacle| obstacle.shape.clone()).collect();
        if resting.is_empty() {
            return None;
        }
        let static_obstacles = space.static_obstacles.iter().cloned().chain(resting).collect();
        let space = FreeSpace { static_obstacles, ..FreeSpace::empty(space.bounds_m) };
        previous.filter(|previous| previous.space == space).or_else(|| {
            let mut map = map.clone();
            map.update(&space);
            Some(Self { space, map })
        })
    }

    /// The shortest path from a point to the goal; empty if there is none.
    pub fn path_from(&self, point: Point) -> Vec<Point> {
        self.map.path_from(point, &self.space)
    }
}

/// A stop, and from there a path of the roadmap as far as the vehicle sees, as a motion that keeps the clearance; `None` if
/// there is none.
///
/// - `path_from`: the path to the goal from a point
/// - `known_radius_m`: distance within which all static obstacles are known, m
pub fn roadmap_motion(
    problem: &HorizonProblem<'_>,
    path_from: impl Fn(Point) -> Vec<Point>,
    known_radius_m: f64,
) -> Option<PointMassMotion> {
    let mut stop = PointMassMotion::from(problem.start);
    stop.brake(problem.limits.acceleration_mps2, problem.step_s);
    let rest = stop.last().1.position;
    let horizon_m = problem.limits.speed_mps * problem.grid.steps as f64 * problem.step_s;
    let in_sight_m = known_radius_m - (rest - problem.start.position).norm() - problem.clearance_m;
    let path = beginning(&path_from(rest), horizon_m.min(in_sight_m));
    if path.len() < 2 {
        return None;
    }
    CORNER_DEVIATIONS_M.iter().find_map(|&deviation_m| {
        let mut motion = stop.clone();
        motion.append(&timed_motion(&path, problem.limits, deviation_m));
        motion.is_clear(0.0, problem.space, problem.clearance_m - CLEARANCE_TOLERANCE_M).then_some(motion)
    })
}

/// The first `length_m` of a path, without repeated points.
fn beginning(path: &[Point], length_m: f64) -> Vec<Point> {
    let mut points: Vec<Point> = path.first().copied().into_iter().collect();
    let mut rest_m = length_m;
    for &point in path.iter().skip(1) {
        let from = points[points.len() - 1];
        let leg_m = (point - from).norm();
        if rest_m < MIN_LEG_M {
            break;
        }
        if leg_m > MIN_LEG_M {
            points.push(from + (point - from) * (rest_m / leg_m).min(1.0));
            rest_m -= leg_m;
        }
    }
    points
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_vehicle_that_gets_no_nearer_follows_the_roadmap_until_it_has_got_past() {
        let mut monitor = ProgressMonitor::new();
        assert!((0..20).all(|replan| !monitor.is_deadlocked(30.0 - f64::from(replan))));
        let circling = (0..20).map(|replan| monitor.is_deadlocked(11.0 + f64::from(replan % 3)));
        assert_eq!(circling.filter(|&is_deadlocked| !is_deadlocked).count(), MAX_IDLE_REPLANS);
        assert!(monitor.is_deadlocked(8.5), "2.5 m nearer than where it got stuck");
        assert!(!monitor.is_deadlocked(7.9));
    }

    #[test]
    fn rest_at_the_goal_is_no_deadlock() {
        let mut monitor = ProgressMonitor::new();
        assert!((0..50).all(|_| !monitor.is_deadlocked(0.01)));
    }

    #[test]
    fn a_path_is_cut_to_a_length() {
        let path = [0.0, 0.0, 2.0, 5.0].map(|x| Point::new(x, 0.0, 0.0));
        let cut = |length_m: f64| beginning(&path, length_m).iter().map(|point| point.x).collect::<Vec<_>>();
        assert_eq!(cut(3.5), [0.0, 2.0, 3.5]);
        assert_eq!(cut(9.0), [0.0, 2.0, 5.0]);
        assert_eq!(cut(0.0), [0.0]);
        assert!(beginning(&[], 1.0).is_empty());
    }
}
