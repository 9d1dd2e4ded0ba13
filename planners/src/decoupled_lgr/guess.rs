//! Initial guesses: cubic curves from start to goal, bowed to either side so that their length fits the flight time.

use super::node_vector::{CLOCK, COORDINATES, STATES, VELOCITY};
use super::problem::Problem;
use std::f64::consts::PI;

/// Pieces in which the length of a curve is measured.
const PIECES: usize = 200;
/// Bisections for the bow, and the largest bow as a multiple of the distance from start to goal.
const BISECTIONS: usize = 30;
const MAX_BOW: f64 = 1.5;

/// A curve flown in a given time.
#[derive(Clone, Copy, Debug)]
pub struct Guess<'a> {
    problem: &'a Problem,
    /// Flight time.
    pub duration: f64,
    /// Largest lateral displacement, positive to the left of the chord.
    bow: f64,
}

impl<'a> Guess<'a> {
    /// The curve without a bow, at the mean of the initial and final speed.
    pub fn straight(problem: &'a Problem) -> Self {
        let guess = Self { problem, duration: 1.0, bow: 0.0 };
        let slow = Self { duration: chord(problem).0 / cruise(problem), ..guess };
        Self { duration: slow.length() / cruise(problem), ..slow }
    }

    /// The same, bowed by a fraction of the chord.
    pub fn bowed(problem: &'a Problem, fraction: f64) -> Self {
        let guess = Self { bow: fraction * chord(problem).0, ..Self::straight(problem) };
        Self { duration: guess.length() / cruise(problem), ..guess }
    }

    /// The curve to either side whose length is that of the flight time at the mean of the initial and final speed.
    pub fn lasting(problem: &'a Problem, duration: f64) -> [Self; 2] {
        let (mut low, mut high) = (0.0, MAX_BOW * chord(problem).0);
        for _ in 0..BISECTIONS {
            let bow = 0.5 * (low + high);
            let is_short = Self { problem, duration, bow }.length() < duration * cruise(problem);
            *(if is_short { &mut low } else { &mut high }) = bow;
        }
        [low, -low].map(|bow| Self { problem, duration, bow })
    }

    /// The same curve in another flight time.
    pub fn lasting_for(self, duration: f64) -> Self {
        Self { duration, ..self }
    }

    /// Writes the node vector at a fraction of the flight time.
    pub fn write(&self, fraction: f64, node: &mut [f64]) {
        let (position, velocity) = self.at(fraction);
        node[..3].copy_from_slice(&position);
        node[CLOCK] = fraction * self.duration;
        node[VELOCITY..VELOCITY + 3].copy_from_slice(&velocity);
        node[COORDINATES + CLOCK] = 1.0;
        node[STATES..].copy_from_slice(&[0.0, 0.0, 1.0]);
    }

    /// Position and velocity at a fraction of the flight time.
    fn at(&self, s: f64) -> ([f64; 3], [f64; 3]) {
        let [start, goal] = self.problem.ends;
        let values =
            [(1.0 + 2.0 * s) * (1.0 - s).powi(2), s * s * (3.0 - 2.0 * s), s * (1.0 - s).powi(2), s * s * (s - 1.0)];
        let slopes = [6.0 * s * s - 6.0 * s, 6.0 * s - 6.0 * s * s, 3.0 * s * s - 4.0 * s + 1.0, 3.0 * s * s - 2.0 * s];
        let combine = |basis: [f64; 4], k: usize| {
            basis[0] * start[k]
                + basis[1] * goal[k]
                + self.duration * (basis[2] * start[3 + k] + basis[3] * goal[3 + k])
        };
        let (_, [x, y]) = chord(self.problem);
        let left = [-y, x, 0.0];
        let (bump, slope) = ((PI * s).sin().powi(2), PI * (2.0 * PI * s).sin());
        let position = std::array::from_fn(|k| combine(values, k) + self.bow * bump * left[k]);
        (position, std::array::from_fn(|k| (combine(slopes, k) + self.bow * slope * left[k]) / self.duration))
    }

    fn length(&self) -> f64 {
        let point = |piece: usize| self.at(piece as f64 / PIECES as f64).0;
        (0..PIECES).map(|piece| distance(point(piece), point(piece + 1))).sum()
    }
}

/// Horizontal distance from start to goal and its direction; east if they coincide.
fn chord(problem: &Problem) -> (f64, [f64; 2]) {
    let [start, goal] = problem.ends;
    let [x, y] = [goal[0] - start[0], goal[1] - start[1]];
    let length = x.hypot(y);
    if length > 0.0 { (length, [x / length, y / length]) } else { (f64::MIN_POSITIVE, [1.0, 0.0]) }
}

/// Mean of the initial and final speed, within the bounds.
fn cruise(problem: &Problem) -> f64 {
    let speed = |end: [f64; 6]| distance([end[3], end[4], end[5]], [0.0; 3]);
    let [min, max] = problem.speed;
    (0.5 * (speed(problem.ends[0]) + speed(problem.ends[1]))).clamp(min, max)
}

fn distance(a: [f64; 3], b: [f64; 3]) -> f64 {
    (0..3).map(|k| (a[k] - b[k]).powi(2)).sum::<f64>().sqrt()
}
