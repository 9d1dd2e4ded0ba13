//! Time parametrisation of a path of straight legs: a motion from rest to rest with bounded speed and acceleration.
//!
//! On the legs the vehicle accelerates, cruises and brakes. At a corner it leaves the path for an arc of constant
//! acceleration a_max that turns its velocity from one leg into the next. With the speed v and the unit vectors u, w of the
//! legs, the arc takes
//!
//! ```text
//! t = v |w - u| / a_max
//! ```
//!
//! covers v t/2 of either leg, and deviates from the corner by at most a_max t²/8.

use crate::free_space::Point;
use crate::multirotor::{PlanningLimits, PointMassMotion, PointMassState};

/// Largest fraction of a leg that the arcs at its ends may cover together.
const MAX_CORNER_FRACTION: f64 = 0.9;

/// Speed below which a corner is passed at rest, without an arc, m/s.
const STANDSTILL_MPS: f64 = 1e-6;

/// Cosine from which on two legs count as parallel.
const COS_PARALLEL: f64 = 1.0 - 1e-12;

/// Duration of a jump of the velocity, s.
const JUMP_S: f64 = 0.01;

/// Phases of a leg shorter than this are left out, s.
const MIN_PHASE_S: f64 = 1e-9;

/// The motion along `path`.
///
/// - `path`: at least two points, consecutive ones distinct, m
/// - `limits`: bounds on speed and acceleration
/// - `deviation_m`: largest deviation of the motion from the path's corners, m
///
/// # Panics
///
/// If the path is empty.
pub fn timed_motion(path: &[Point], limits: PlanningLimits, deviation_m: f64) -> PointMassMotion {
    let path = &without_straight_corners(path);
    let speeds_mps = corner_speeds_mps(path, limits, deviation_m);
    let directions: Vec<Point> = path.windows(2).map(|ends| direction(ends[0], ends[1])).collect();
    let mut motion = PointMassMotion::from(PointMassState::at_rest(path[0]));
    for (leg, &along) in directions.iter().enumerate() {
        let [from_mps, to_mps] = [speeds_mps[leg], speeds_mps[leg + 1]];
        add_straight(&mut motion, along, straight_m(path, &speeds_mps, limits, leg), [from_mps, to_mps], limits);
        if let Some(&next) = directions.get(leg + 1) {
            add_corner_arc(&mut motion, next - along, to_mps, limits);
        }
    }
    motion.end_at_rest(path[path.len() - 1]);
    motion
}

/// The path as planned: at the largest speed along the legs, from start to goal. The velocity turns at each corner, and
/// changes from and to rest at the ends, within `JUMP_S`, half before and half after the corner; the accelerations of these
/// jumps are far beyond any limit.
///
/// # Panics
///
/// If the path is empty.
pub fn motion_at_constant_speed(path: &[Point], limits: PlanningLimits) -> PointMassMotion {
    let path = &without_straight_corners(path);
    let speed_mps = limits.speed_mps;
    let directions: Vec<Point> = path.windows(2).map(|ends| direction(ends[0], ends[1])).collect();
    let mut motion = PointMassMotion::from(PointMassState::at_rest(path[0]));
    let jump = |motion: &mut PointMassMotion, change: Point| motion.accelerate(change * (1.0 / JUMP_S), JUMP_S);
    for (leg, &along) in directions.iter().enumerate() {
        let previous = leg.checked_sub(1).map_or_else(Point::zeros, |leg| directions[leg]);
        jump(&mut motion, (along - previous) * speed_mps);
        // a jump covers v JUMP_S/2 of either leg
        let length_m = (path[leg] - path[leg + 1]).norm() - speed_mps * JUMP_S;
        motion.accelerate(Point::zeros(), (length_m / speed_mps).max(MIN_PHASE_S));
    }
    if let Some(&along) = directions.last() {
        jump(&mut motion, along * -speed_mps);
    }
    motion.end_at_rest(path[path.len() - 1]);
    motion
}

/// Merges consecutive parallel legs.
fn without_straight_corners(path: &[Point]) -> Vec<Point> {
    let mut corners: Vec<Point> = vec![path[0]];
    for (i, &point) in path.iter().enumerate().skip(1) {
        let is_corner = path.get(i + 1).is_none_or(|&next| {
            let previous = corners[corners.len() - 1];
            direction(previous, point).dot(&direction(point, next)) < COS_PARALLEL
        });
        if is_corner {
            corners.push(point);
        }
    }
    corners
}

fn direction(from: Point, to: Point) -> Point {
    (to - from) * (1.0 / (from - to).norm())
}

/// |w - u| at an inner corner with the unit vectors u, w of its legs.
fn direction_change(path: &[Point], corner: usize) -> f64 {
    (direction(path[corner], path[corner + 1]) - direction(path[corner - 1], path[corner])).norm()
}

/// Speed at every point of the path: zero at both ends. Each corner's arc respects `deviation_m` and
/// [`MAX_CORNER_FRACTION`], and a forward and a backward pass make the speeds of neighbouring corners reachable.
fn corner_speeds_mps(path: &[Point], limits: PlanningLimits, deviation_m: f64) -> Vec<f64> {
    let last = path.len() - 1;
    let mut speeds_mps = vec![0.0; path.len()];
    for i in 1..last {
        let legs_m = [(path[i - 1] - path[i]).norm(), (path[i] - path[i + 1]).norm()];
        let change = direction_change(path, i);
        let by_deviation = (8.0 * limits.acceleration_mps2 * deviation_m).sqrt() / change;
        let shorter_m = legs_m[0].min(legs_m[1]);
        let by_length = (MAX_CORNER_FRACTION * shorter_m * limits.acceleration_mps2 / change).sqrt();
        speeds_mps[i] = limits.speed_mps.min(by_deviation).min(by_length);
    }
    for leg in 0..last {
        let from_mps = speeds_mps[leg];
        let reached_mps = reachable_mps(from_mps, straight_m(path, &speeds_mps, limits, leg), limits);
        speeds_mps[leg + 1] = speeds_mps[leg + 1].min(reached_mps);
    }
    for leg in (0..last).rev() {
        let to_mps = speeds_mps[leg + 1];
        let reached_mps = reachable_mps(to_mps, straight_m(path, &speeds_mps, limits, leg), limits);
        speeds_mps[leg] = speeds_mps[leg].min(reached_mps);
    }
    speeds_mps
}

/// Speed after accelerating over a distance, √(v² + 2 a s), m/s.
fn reachable_mps(from_mps: f64, length_m: f64, limits: PlanningLimits) -> f64 {
    (from_mps * from_mps + 2.0 * limits.acceleration_mps2 * length_m).sqrt()
}

/// Length of a leg without the arcs at its ends, m.
fn straight_m(path: &[Point], speeds_mps: &[f64], limits: PlanningLimits, leg: usize) -> f64 {
    let arc_m = |i: usize| {
        if i == 0 || i == path.len() - 1 {
            return 0.0;
        }
        speeds_mps[i] * speeds_mps[i] * direction_change(path, i) / (2.0 * limits.acceleration_mps2)
    };
    ((path[leg] - path[leg + 1]).norm() - arc_m(leg) - arc_m(leg + 1)).max(0.0)
}

/// Appends a straight line with a trapezoidal speed profile.
fn add_straight(
    motion: &mut PointMassMotion,
    along: Point,
    length_m: f64,
    [from_mps, to_mps]: [f64; 2],
    limits: PlanningLimits,
) {
    let a = limits.acceleration_mps2;
    let peak_mps = (a * length_m + 0.5 * (from_mps * from_mps + to_mps * to_mps)).sqrt().min(limits.speed_mps);
    let accelerating_m = (peak_mps * peak_mps - from_mps * from_mps) / (2.0 * a);
    let braking_m = (peak_mps * peak_mps - to_mps * to_mps) / (2.0 * a);
    let cruise_s = if peak_mps > 0.0 { (length_m - accelerating_m - braking_m) / peak_mps } else { 0.0 };
    for (acceleration, time_s) in [(a, (peak_mps - from_mps) / a), (0.0, cruise_s), (-a, (peak_mps - to_mps) / a)] {
        if time_s > MIN_PHASE_S {
            motion.accelerate(along * acceleration, time_s);
        }
    }
}

/// Appends the arc at a corner, with the difference `change` = w - u of its legs' unit vectors.
fn add_corner_arc(motion: &mut PointMassMotion, change: Point, speed_mps: f64, limits: PlanningLimits) {
    if speed_mps > STANDSTILL_MPS {
        let time_s = speed_mps * change.norm() / limits.acceleration_mps2;
        motion.accelerate(change * (speed_mps / time_s), time_s);
    }
}
