//! From a path of straight legs to a motion with bounded speed and acceleration, from rest to rest.
//!
//! At every corner the vehicle leaves the path by a constant acceleration a_max that turns its velocity from one leg into
//! the next: with speed v and unit vectors u, w of the legs, for the time t = v |w - u|/a_max, over v t/2 of either leg,
//! and at most a_max t²/8 from the corner. On the legs it accelerates, cruises and brakes.

use crate::free_space::vector::{Point, distance, dot, minus, norm, scaled};
use crate::horizon::motion::{Motion, State};
use crate::horizon::question::Limits;

/// Share of a leg that the corners at its ends may take together.
const CORNER_SHARE: f64 = 0.9;

/// Speed below which a corner is taken standing, m/s.
const STANDING_MPS: f64 = 1e-6;

/// The motion along `path`, which leaves its corners by `deviation_m` at most.
///
/// - `path`: two points at least, no two the same in a row, m
pub fn motion(path: &[Point], limits: Limits, deviation_m: f64) -> Motion {
    let path = &without_straight_corners(path);
    let speeds_mps = corner_speeds_mps(path, limits, deviation_m);
    let directions: Vec<Point> = path.windows(2).map(|ends| direction(ends[0], ends[1])).collect();
    let mut motion = Motion::from(State::at_rest(path[0]));
    for (leg, &along) in directions.iter().enumerate() {
        let [from_mps, to_mps] = [speeds_mps[leg], speeds_mps[leg + 1]];
        run(&mut motion, along, straight_m(path, &speeds_mps, limits, leg), [from_mps, to_mps], limits);
        if let Some(&next) = directions.get(leg + 1) {
            turn(&mut motion, minus(next, along), to_mps, limits);
        }
    }
    motion.settle(path[path.len() - 1]);
    motion
}

/// Legs that go on in the same direction are one.
fn without_straight_corners(path: &[Point]) -> Vec<Point> {
    let mut corners: Vec<Point> = vec![path[0]];
    for (i, &point) in path.iter().enumerate().skip(1) {
        let is_corner = path.get(i + 1).is_none_or(|&next| {
            let before = corners[corners.len() - 1];
            dot(direction(before, point), direction(point, next)) < 1.0 - 1e-12
        });
        if is_corner {
            corners.push(point);
        }
    }
    corners
}

fn direction(from: Point, to: Point) -> Point {
    scaled(minus(to, from), 1.0 / distance(from, to))
}

/// Speed at every point of the path: zero at both ends, and such that each corner's arc stays within its bounds and the
/// speeds of neighbouring corners can be reached in between.
fn corner_speeds_mps(path: &[Point], limits: Limits, deviation_m: f64) -> Vec<f64> {
    let last = path.len() - 1;
    let mut speeds_mps = vec![0.0; path.len()];
    for i in 1..last {
        let legs_m = [distance(path[i - 1], path[i]), distance(path[i], path[i + 1])];
        let change = norm(minus(direction(path[i], path[i + 1]), direction(path[i - 1], path[i])));
        let by_deviation = (8.0 * limits.acceleration_mps2 * deviation_m).sqrt() / change;
        let shorter_m = legs_m[0].min(legs_m[1]);
        let by_length = (CORNER_SHARE * shorter_m * limits.acceleration_mps2 / change).sqrt();
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

fn reachable_mps(from_mps: f64, length_m: f64, limits: Limits) -> f64 {
    (from_mps * from_mps + 2.0 * limits.acceleration_mps2 * length_m).sqrt()
}

/// What the arcs at its ends leave of a leg, m.
fn straight_m(path: &[Point], speeds_mps: &[f64], limits: Limits, leg: usize) -> f64 {
    let arc_m = |i: usize| {
        if i == 0 || i == path.len() - 1 {
            return 0.0;
        }
        let change = norm(minus(direction(path[i], path[i + 1]), direction(path[i - 1], path[i])));
        speeds_mps[i] * speeds_mps[i] * change / (2.0 * limits.acceleration_mps2)
    };
    (distance(path[leg], path[leg + 1]) - arc_m(leg) - arc_m(leg + 1)).max(0.0)
}

/// Accelerates, cruises and brakes along a straight line.
fn run(motion: &mut Motion, along: Point, length_m: f64, [from_mps, to_mps]: [f64; 2], limits: Limits) {
    let a = limits.acceleration_mps2;
    let peak_mps = (a * length_m + 0.5 * (from_mps * from_mps + to_mps * to_mps)).sqrt().min(limits.speed_mps);
    let up_m = (peak_mps * peak_mps - from_mps * from_mps) / (2.0 * a);
    let down_m = (peak_mps * peak_mps - to_mps * to_mps) / (2.0 * a);
    let phases = [
        (a, (peak_mps - from_mps) / a),
        (0.0, if peak_mps > 0.0 { (length_m - up_m - down_m) / peak_mps } else { 0.0 }),
        (-a, (peak_mps - to_mps) / a),
    ];
    for (acceleration, time_s) in phases {
        if time_s > 1e-9 {
            motion.accelerate(scaled(along, acceleration), time_s);
        }
    }
}

/// Turns the velocity from one leg into the next, `change` being the difference of their directions.
fn turn(motion: &mut Motion, change: Point, speed_mps: f64, limits: Limits) {
    if speed_mps > STANDING_MPS {
        let time_s = speed_mps * norm(change) / limits.acceleration_mps2;
        motion.accelerate(scaled(change, speed_mps / time_s), time_s);
    }
}
