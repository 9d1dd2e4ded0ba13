//! Free space: a bounded region minus its obstacles, with distance and collision queries for points and segments.
//!
//! Positions always have three coordinates. A planar world is one whose obstacles are unbounded in altitude, inside
//! bounds without altitude limits, so the same code serves the plane and space.
//!
//! Queries are about whole segments, not about samples of them: [`FreeSpace::is_clear`] decides one segment, and
//! [`simd_distance`] bounds the distance of four segments at once from below.

mod moving_obstacle;
mod no_fly;
mod obstacle;
pub mod outline;
pub mod simd_distance;
pub mod world;

pub use moving_obstacle::{Displacement, MovingObstacle};
pub use obstacle::Obstacle;

use nalgebra::Vector3;

/// A position in m, a velocity in m/s or an acceleration in m/s², in the world frame.
pub type Point = Vector3<f64>;

/// Length below which [`segment_clear`] stops subdividing and reports an undecided segment as blocked, m.
const MIN_SUBDIVISION_M: f64 = 1e-6;

/// The known world at time 0, with the predicted motion of its moving obstacles.
#[derive(Clone, Debug, PartialEq)]
pub struct FreeSpace {
    /// Lower and upper bound of each coordinate, m; infinite where unbounded. Clearance applies to the bounds too.
    pub bounds_m: [[f64; 2]; 3],
    /// Obstacles at rest.
    pub static_obstacles: Vec<Obstacle>,
    /// Obstacles that move.
    pub moving_obstacles: Vec<MovingObstacle>,
}

impl FreeSpace {
    /// Bounds without obstacles.
    pub fn empty(bounds_m: [[f64; 2]; 3]) -> Self {
        Self { bounds_m, static_obstacles: Vec::new(), moving_obstacles: Vec::new() }
    }

    /// Signed distance from a point to the bounds, m: negative outside.
    pub fn distance_to_bounds_m(&self, point: Point) -> f64 {
        let margins = self.bounds_m.iter().zip(&point).map(|([low, high], x)| (x - low).min(high - x));
        margins.fold(f64::INFINITY, f64::min)
    }

    /// Does a point keep `clearance_m` from the bounds? False for NaN.
    fn is_within_bounds(&self, point: Point, clearance_m: f64) -> bool {
        let mut axes = self.bounds_m.iter().zip(&point);
        axes.all(|([low, high], x)| x - low >= clearance_m && high - x >= clearance_m)
    }

    /// Signed distance from a point to the nearest static obstacle or bound, m.
    pub fn distance_m(&self, point: Point) -> f64 {
        let obstacles = self.static_obstacles.iter().map(|obstacle| obstacle.distance_m(point));
        obstacles.fold(self.distance_to_bounds_m(point), f64::min)
    }

    /// Signed distance from a point to the nearest moving obstacle at a time, m.
    pub fn distance_to_moving_m(&self, point: Point, time_s: f64) -> f64 {
        let distance_m = |obstacle: &MovingObstacle| obstacle.shape.distance_m(point - obstacle.displacement_m(time_s));
        self.moving_obstacles.iter().map(distance_m).fold(f64::INFINITY, f64::min)
    }

    /// Does every point between `from` and `to` keep `clearance_m` from the bounds and the static obstacles?
    pub fn is_clear(&self, from: Point, to: Point, clearance_m: f64) -> bool {
        // the bounds are convex, so the distance to them is smallest at an end
        self.is_within_bounds(from, clearance_m)
            && self.is_within_bounds(to, clearance_m)
            && self.static_obstacles.iter().all(|obstacle| segment_clear(obstacle, from, to, clearance_m))
    }

    /// Does a point that moves at constant velocity from `from` (position, time s) to `to` keep `clearance_m` from the
    /// moving obstacles? They too are taken to move at constant velocity in between.
    pub fn is_clear_of_moving(&self, from: (Point, f64), to: (Point, f64), clearance_m: f64) -> bool {
        self.moving_obstacles.iter().all(|obstacle| {
            let [from, to] = [from, to].map(|(point, time_s)| point - obstacle.displacement_m(time_s));
            segment_clear(&obstacle.shape, from, to, clearance_m)
        })
    }
}

/// Does every point between `from` and `to` keep `clearance_m` from an obstacle?
///
/// Lower bounds of the distance decide, or the segment is bisected. Conservative: a segment that is undecided at
/// 1 µm counts as blocked.
pub fn segment_clear(obstacle: &Obstacle, from: Point, to: Point, clearance_m: f64) -> bool {
    if !obstacle.may_be_within(from, to, clearance_m) || obstacle.distance_lower_bound_m(from, to) >= clearance_m {
        return true;
    }
    let middle = interpolate(from, to, 0.5);
    // for a segment at one altitude the bound is the distance itself
    let is_level = from.z == to.z;
    !is_level
        && (from - to).norm() > MIN_SUBDIVISION_M
        && obstacle.distance_m(middle) >= clearance_m
        && segment_clear(obstacle, from, middle, clearance_m)
        && segment_clear(obstacle, middle, to, clearance_m)
}

/// a + `fraction` (b - a). Unlike nalgebra's `lerp`, which computes (1 - t) a + t b, it returns `a` exactly if a = b.
pub fn interpolate(a: Point, b: Point, fraction: f64) -> Point {
    a + fraction * (b - a)
}

/// Length of a polyline, m.
pub fn path_length_m(path: &[Point]) -> f64 {
    path.windows(2).map(|ends| (ends[0] - ends[1]).norm()).sum()
}

#[cfg(test)]
mod tests;
