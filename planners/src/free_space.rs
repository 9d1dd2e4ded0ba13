//! Where a vehicle may be: a frame without the obstacles in it, and how far everything is.
//!
//! Positions have three coordinates throughout. A world in the plane is one whose obstacles have neither bottom nor top,
//! in a frame without limits of altitude: the same code serves both.
//!
//! Distances hold between the samples, not at them: [`FreeSpace::is_clear`] asks for a whole segment, and
//! [`sweep`] bounds the distance of four segments at once from below.

pub mod known;
mod mover;
mod obstacle;
pub mod sweep;
pub mod vector;

pub use mover::{Mover, Track};
pub use obstacle::Obstacle;
use vector::{Point, distance, interpolate, minus};

/// Segments shorter than this are not divided any further, m: what is undecided then counts as blocked.
const SHORTEST_M: f64 = 1e-6;

/// The known world at time 0, and where what moves in it will be.
#[derive(Clone, Debug, PartialEq)]
pub struct FreeSpace {
    /// Limits of each coordinate, m; infinite where there is none. The frame is itself a border to keep clear of.
    pub frame_m: [[f64; 2]; 3],
    /// Obstacles that stand still.
    pub standing: Vec<Obstacle>,
    /// Obstacles that move.
    pub moving: Vec<Mover>,
}

impl FreeSpace {
    /// A frame with nothing in it.
    pub fn empty(frame_m: [[f64; 2]; 3]) -> Self {
        Self { frame_m, standing: Vec::new(), moving: Vec::new() }
    }

    /// Distance from a point to the frame, m: negative outside.
    pub fn distance_to_frame_m(&self, point: Point) -> f64 {
        let sides = self.frame_m.iter().zip(point).map(|([low, high], x)| (x - low).min(high - x));
        sides.fold(f64::INFINITY, f64::min)
    }

    /// Does a point keep `clearance_m` from the frame? Not if it is no number.
    fn is_in_frame(&self, point: Point, clearance_m: f64) -> bool {
        let mut sides = self.frame_m.iter().zip(point);
        sides.all(|([low, high], x)| x - low >= clearance_m && high - x >= clearance_m)
    }

    /// Signed distance from a point to the nearest of the frame and what stands still, m.
    pub fn distance_m(&self, point: Point) -> f64 {
        let obstacles = self.standing.iter().map(|obstacle| obstacle.distance_m(point));
        obstacles.fold(self.distance_to_frame_m(point), f64::min)
    }

    /// Signed distance from a point to the nearest moving obstacle at a time, m.
    pub fn distance_to_moving_m(&self, point: Point, time_s: f64) -> f64 {
        let distance = |mover: &Mover| mover.shape.distance_m(minus(point, mover.offset_m(time_s)));
        self.moving.iter().map(distance).fold(f64::INFINITY, f64::min)
    }

    /// Does every point between `from` and `to` keep `clearance_m` from the frame and from what stands still?
    pub fn is_clear(&self, from: Point, to: Point, clearance_m: f64) -> bool {
        // the frame is convex, so its distance is smallest at an end
        self.is_in_frame(from, clearance_m)
            && self.is_in_frame(to, clearance_m)
            && self.standing.iter().all(|obstacle| is_beside(obstacle, from, to, clearance_m))
    }

    /// The same for moving obstacles, from `from` at one time to `to` at another, both at constant velocity in between.
    pub fn is_clear_of_moving(&self, from: (Point, f64), to: (Point, f64), clearance_m: f64) -> bool {
        self.moving.iter().all(|mover| {
            let [from, to] = [from, to].map(|(point, time_s)| minus(point, mover.offset_m(time_s)));
            is_beside(&mover.shape, from, to, clearance_m)
        })
    }
}

/// Does every point between `from` and `to` keep `clearance_m` from an obstacle? Exact up to `SHORTEST_M`, and then to
/// the safe side: bounds of the distance decide, or the segment is divided.
pub fn is_beside(obstacle: &Obstacle, from: Point, to: Point, clearance_m: f64) -> bool {
    if !obstacle.may_be_within(from, to, clearance_m) || obstacle.least_distance_m(from, to) >= clearance_m {
        return true;
    }
    let middle = interpolate(from, to, 0.5);
    // a segment at one altitude has its distance from the bound itself
    let is_level = from[2] == to[2];
    !is_level
        && distance(from, to) > SHORTEST_M
        && obstacle.distance_m(middle) >= clearance_m
        && is_beside(obstacle, from, middle, clearance_m)
        && is_beside(obstacle, middle, to, clearance_m)
}

#[cfg(test)]
mod tests;
