//! The closest approach of vehicles, as balls, to obstacles of any shape, over continuous time.
//!
//! A signed distance changes by no more than vehicle and obstacle move, whatever the shape: that is all that the [search]
//! needs. A motion that is known up to a [deviation](Motion::deviation_m) enlarges the vehicle and widens the bounds.

pub mod search;

use scenarios::Map;
use sim::Obstacles;

use self::search::{Approach, Body, Effort, PathLengths, Search};
use crate::verdict::compare::is_smaller;
use crate::verdict::motion::Motion;

/// Largest number of intervals; beyond it the bounds stay apart and the check may be undecided.
const MAX_INTERVALS: usize = 20_000_000;

/// The closest approach of a ball to an obstacle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ClosestApproach {
    /// Lower bound of the distance, m.
    pub lower_m: f64,
    /// Upper bound of the distance, m.
    pub upper_m: f64,
    /// Its time, s.
    pub at_s: f64,
    /// Index of the vehicle.
    pub vehicle: usize,
    /// Index of the obstacle; `None` for the frame of the map.
    pub obstacle: Option<usize>,
}

/// The closest approach of any of `motions`, balls of `radii_m`, to any obstacle. `None` without motions, or without anything
/// to approach.
///
/// - `frame`: the map, if its frame counts as an obstacle
/// - `resolution_m`: how close the bounds have to be, m, for a smallest distance, m
pub fn closest(
    obstacles: &Obstacles,
    frame: Option<&Map>,
    motions: &[Motion],
    radii_m: &[f64],
    resolution_m: fn(f64) -> f64,
) -> Option<ClosestApproach> {
    let effort = Effort { resolution_m, uses_convexity: false, max_intervals: MAX_INTERVALS };
    let mut search = Search::new(obstacles, effort);
    let mut lengths = PathLengths::default();
    for (vehicle, (motion, radius_m)) in motions.iter().zip(radii_m).enumerate() {
        lengths.measure(motion);
        let body = Body { vehicle, motion, lengths: &lengths, reach_m: radius_m + motion.deviation_m() };
        frame.into_iter().for_each(|map| search.add_frame(map, body));
        search.add_obstacles(body);
    }
    let (Approach { distance_m, at_s, vehicle, obstacle }, lower_m) = search.found()?;
    let upper_m = distance_m + 2.0 * motions[vehicle].deviation_m();
    let closest = ClosestApproach { lower_m, upper_m, at_s, vehicle, obstacle };
    let enclosed = motions.iter().zip(radii_m).enumerate().filter_map(|it| enclosed_at_start(obstacles, it));
    Some(enclosed.fold(closest, |a, b| if is_smaller(b.lower_m, a.lower_m) { b } else { a }))
}

/// The start of a motion inside an obstacle whose distances have no sign, because its surface intersects itself or has small
/// holes. Whoever enters one later passes its surface.
fn enclosed_at_start(
    obstacles: &Obstacles,
    (vehicle, (motion, radius_m)): (usize, (&Motion, &f64)),
) -> Option<ClosestApproach> {
    let start = motion.knots().first()?;
    let obstacle = (0..obstacles.count()).find(|obstacle| obstacles.encloses(*obstacle, start.position_m))?;
    let distance_m = -obstacles.distance_m(obstacle, start.t_s, start.position_m).abs() - radius_m;
    Some(ClosestApproach {
        lower_m: distance_m - motion.deviation_m(),
        upper_m: distance_m + motion.deviation_m(),
        at_s: start.t_s,
        vehicle,
        obstacle: Some(obstacle),
    })
}
