//! A motion of piecewise constant acceleration: what a double integrator does (eq. 18).

use crate::free_space::FreeSpace;
use crate::free_space::vector::{Point, dot, interpolate, minus, norm, plus, scaled};

/// Where a point mass is and how fast.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct State {
    /// m.
    pub position: Point,
    /// m/s.
    pub velocity: Point,
}

impl State {
    /// At rest.
    pub fn at_rest(position: Point) -> Self {
        Self { position, velocity: [0.0; 3] }
    }

    /// After `time_s` of constant acceleration.
    pub fn after(self, acceleration: Point, time_s: f64) -> Self {
        let velocity = plus(self.velocity, scaled(acceleration, time_s));
        let mean = interpolate(self.velocity, velocity, 0.5);
        Self { position: plus(self.position, scaled(mean, time_s)), velocity }
    }
}

/// States with the acceleration from each to the next; the last one stays as it is for ever.
#[derive(Clone, Debug, PartialEq)]
pub struct Motion {
    knots: Vec<(f64, State)>,
    accelerations: Vec<Point>,
}

/// Pieces into which the way of a step is divided where obstacles move, s at most.
const PIECE_S: f64 = 0.125;

/// Speed below which a vehicle stands, m/s.
const STANDING_MPS: f64 = 1e-9;

impl Motion {
    /// Begins with a state at time 0.
    pub fn from(state: State) -> Self {
        Self { knots: vec![(0.0, state)], accelerations: Vec::new() }
    }

    /// Through states at times, s, increasing; between two of them with their mean acceleration.
    pub fn through(knots: Vec<(f64, State)>) -> Self {
        assert!(!knots.is_empty(), "a motion has a state");
        let mean = |ends: &[(f64, State)]| {
            let [(from_s, from), (to_s, to)] = [ends[0], ends[1]];
            scaled(minus(to.velocity, from.velocity), 1.0 / (to_s - from_s))
        };
        let accelerations = knots.windows(2).map(mean).collect();
        Self { knots, accelerations }
    }

    /// Goes on at a constant acceleration, m/s².
    pub fn accelerate(&mut self, acceleration: Point, time_s: f64) {
        let &(at_s, state) = self.last();
        self.knots.push((at_s + time_s, state.after(acceleration, time_s)));
        self.accelerations.push(acceleration);
    }

    /// Comes to a stop at that deceleration, m/s², in equal steps of `step_s` at most.
    pub fn brake(&mut self, deceleration_mps2: f64, step_s: f64) {
        let velocity = self.last().1.velocity;
        let speed_mps = norm(velocity);
        if speed_mps > STANDING_MPS {
            let time_s = speed_mps / deceleration_mps2;
            let steps = (time_s / step_s).ceil();
            let acceleration = scaled(velocity, -deceleration_mps2 / speed_mps);
            for _ in 0..steps as usize {
                self.accelerate(acceleration, time_s / steps);
            }
        }
        self.settle(self.last().1.position);
    }

    /// Ends at rest at a place that it has come to but for rounding.
    pub fn settle(&mut self, place: Point) {
        self.knots.last_mut().expect("a motion has a state").1 = State::at_rest(place);
    }

    /// Times from the beginning, s, with the states there.
    pub fn knots(&self) -> &[(f64, State)] {
        &self.knots
    }

    /// Time and state of the last knot.
    pub fn last(&self) -> &(f64, State) {
        self.knots.last().expect("a motion has a state")
    }

    /// The state at a time; before the beginning the first, after the end the last.
    pub fn state_at(&self, time_s: f64) -> State {
        let next = self.knots.partition_point(|&(at_s, _)| at_s <= time_s);
        if next == 0 || next == self.knots.len() {
            return self.knots[next.min(self.knots.len() - 1)].1;
        }
        let (at_s, state) = self.knots[next - 1];
        state.after(self.accelerations[next - 1], time_s - at_s)
    }

    /// What is left of it from a time on, which becomes time 0.
    pub fn rest_from(&self, since_s: f64) -> Self {
        let mut knots = vec![(0.0, self.state_at(since_s))];
        let later = self.knots.iter().filter(|(at_s, _)| *at_s > since_s);
        knots.extend(later.map(|&(at_s, state)| (at_s - since_s, state)));
        Self::through(knots)
    }

    /// Mean accelerations over `count` steps of `step_s` from `from_s` on, m/s².
    pub fn mean_accelerations(&self, from_s: f64, step_s: f64, count: usize) -> Vec<Point> {
        let velocity = |step: usize| self.state_at(from_s + step as f64 * step_s).velocity;
        (0..count).map(|step| scaled(minus(velocity(step + 1), velocity(step)), 1.0 / step_s)).collect()
    }

    /// Does it keep `clearance_m` from everything at all times from `from_s` on, its arcs included?
    pub fn is_clear(&self, from_s: f64, space: &FreeSpace, clearance_m: f64) -> bool {
        self.knots.windows(2).zip(&self.accelerations).all(|(ends, &acceleration)| {
            let [(begin_s, _), (end_s, _)] = [ends[0], ends[1]];
            end_s <= from_s || self.is_piece_clear(begin_s.max(from_s), end_s, acceleration, space, clearance_m)
        })
    }

    fn is_piece_clear(&self, from_s: f64, to_s: f64, acceleration: Point, space: &FreeSpace, clearance_m: f64) -> bool {
        let pieces = if space.moving.is_empty() { 1.0 } else { ((to_s - from_s) / PIECE_S).ceil().max(1.0) };
        let time_s = |piece: usize| from_s + (to_s - from_s) * piece as f64 / pieces;
        (0..pieces as usize).all(|piece| {
            let times_s = [time_s(piece), time_s(piece + 1)];
            let [from, to] = times_s.map(|time_s| self.state_at(time_s).position);
            let duration_s = times_s[1] - times_s[0];
            let beside_m = clearance_m + sagitta_m(across(acceleration, minus(to, from)), duration_s);
            let along_m = clearance_m + sagitta_m(norm(acceleration), duration_s);
            space.is_clear(from, to, beside_m)
                && space.is_clear_of_moving((from, times_s[0]), (to, times_s[1]), along_m)
        })
    }
}

/// Largest distance of an arc of constant acceleration from its chord, m.
pub fn sagitta_m(acceleration_mps2: f64, time_s: f64) -> f64 {
    acceleration_mps2 * time_s * time_s / 8.0
}

/// Length of the part of `a` across a direction; all of it where there is no direction.
fn across(a: Point, direction: Point) -> f64 {
    let length2 = dot(direction, direction);
    let along2 = if length2 > 0.0 { dot(a, direction).powi(2) / length2 } else { 0.0 };
    (dot(a, a) - along2).max(0.0).sqrt()
}
