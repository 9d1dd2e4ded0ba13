//! Motion of a double integrator with piecewise-constant acceleration (eq. 18).

use crate::free_space::{FreeSpace, Point, interpolate};

/// Position and velocity of a point mass.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PointMassState {
    /// m.
    pub position: Point,
    /// m/s.
    pub velocity: Point,
}

impl PointMassState {
    /// At rest.
    pub fn at_rest(position: Point) -> Self {
        Self { position, velocity: Point::zeros() }
    }

    /// After `time_s` of constant acceleration.
    pub fn after(self, acceleration: Point, time_s: f64) -> Self {
        let velocity = self.velocity + acceleration * time_s;
        let mean = interpolate(self.velocity, velocity, 0.5);
        Self { position: self.position + mean * time_s, velocity }
    }
}

/// A motion with constant acceleration between its knots. It holds the first state before the first knot and the last
/// state after the last knot.
#[derive(Clone, Debug, PartialEq)]
pub struct PointMassMotion {
    knots: Vec<(f64, PointMassState)>,
    accelerations: Vec<Point>,
}

/// Longest piece into which an arc is divided for the check against moving obstacles, s.
const MAX_MOVING_CHECK_S: f64 = 0.125;

/// Speed below which the vehicle counts as at rest, m/s.
const STANDSTILL_MPS: f64 = 1e-9;

impl PointMassMotion {
    /// A motion that consists of one state at time 0.
    pub fn from(state: PointMassState) -> Self {
        Self { knots: vec![(0.0, state)], accelerations: Vec::new() }
    }

    /// Through states at increasing times, s, with the mean acceleration between two of them.
    ///
    /// # Panics
    ///
    /// If there is no state.
    pub fn through(knots: Vec<(f64, PointMassState)>) -> Self {
        assert!(!knots.is_empty(), "a motion has a state");
        let mean = |ends: &[(f64, PointMassState)]| {
            let [(from_s, from), (to_s, to)] = [ends[0], ends[1]];
            (to.velocity - from.velocity) * (1.0 / (to_s - from_s))
        };
        let accelerations = knots.windows(2).map(mean).collect();
        Self { knots, accelerations }
    }

    /// Appends an arc of constant acceleration, m/s².
    pub fn accelerate(&mut self, acceleration: Point, time_s: f64) {
        let &(at_s, state) = self.last();
        self.knots.push((at_s + time_s, state.after(acceleration, time_s)));
        self.accelerations.push(acceleration);
    }

    /// Appends a motion, which begins at the last state.
    pub fn append(&mut self, next: &Self) {
        let (end_s, _) = *self.last();
        self.knots.extend(next.knots.iter().skip(1).map(|&(at_s, state)| (end_s + at_s, state)));
        self.accelerations.extend_from_slice(&next.accelerations);
    }

    /// Appends a straight stop at a constant deceleration, m/s², in equal steps of at most `step_s`.
    pub fn brake(&mut self, deceleration_mps2: f64, step_s: f64) {
        let velocity = self.last().1.velocity;
        let speed_mps = velocity.norm();
        if speed_mps > STANDSTILL_MPS {
            let time_s = speed_mps / deceleration_mps2;
            let steps = (time_s / step_s).ceil();
            let acceleration = velocity * (-deceleration_mps2 / speed_mps);
            for _ in 0..steps as usize {
                self.accelerate(acceleration, time_s / steps);
            }
        }
        self.end_at_rest(self.last().1.position);
    }

    /// Replaces the last state by rest at `position`, which it equals up to rounding.
    pub fn end_at_rest(&mut self, position: Point) {
        self.knots.last_mut().expect("a motion has a state").1 = PointMassState::at_rest(position);
    }

    /// Times, s, with the states there.
    pub fn knots(&self) -> &[(f64, PointMassState)] {
        &self.knots
    }

    /// Time and state of the last knot.
    pub fn last(&self) -> &(f64, PointMassState) {
        self.knots.last().expect("a motion has a state")
    }

    /// The state at a time.
    pub fn state_at(&self, time_s: f64) -> PointMassState {
        let next = self.knots.partition_point(|&(at_s, _)| at_s <= time_s);
        if next == 0 || next == self.knots.len() {
            return self.knots[next.min(self.knots.len() - 1)].1;
        }
        let (at_s, state) = self.knots[next - 1];
        state.after(self.accelerations[next - 1], time_s - at_s)
    }

    /// The motion from a time on, which becomes time 0.
    pub fn tail_from(&self, from_s: f64) -> Self {
        let mut knots = vec![(0.0, self.state_at(from_s))];
        let later = self.knots.iter().filter(|(at_s, _)| *at_s > from_s);
        knots.extend(later.map(|&(at_s, state)| (at_s - from_s, state)));
        Self::through(knots)
    }

    /// Mean accelerations over `count` steps of `step_s` from `from_s` on, m/s².
    pub fn mean_accelerations(&self, from_s: f64, step_s: f64, count: usize) -> Vec<Point> {
        let velocity = |step: usize| self.state_at(from_s + step as f64 * step_s).velocity;
        (0..count).map(|step| (velocity(step + 1) - velocity(step)) * (1.0 / step_s)).collect()
    }

    /// Does the motion keep `clearance_m` from everything from `from_s` on? Whole arcs are checked, by their chords and
    /// sagittas.
    pub fn is_clear(&self, from_s: f64, space: &FreeSpace, clearance_m: f64) -> bool {
        self.knots.windows(2).zip(&self.accelerations).all(|(ends, &acceleration)| {
            let [(begin_s, _), (end_s, _)] = [ends[0], ends[1]];
            end_s <= from_s || self.is_arc_clear([begin_s.max(from_s), end_s], acceleration, space, clearance_m)
        })
    }

    fn is_arc_clear(&self, [from_s, to_s]: [f64; 2], acceleration: Point, space: &FreeSpace, clearance_m: f64) -> bool {
        let pieces = if space.moving_obstacles.is_empty() {
            1.0
        } else {
            ((to_s - from_s) / MAX_MOVING_CHECK_S).ceil().max(1.0)
        };
        let time_s = |piece: usize| from_s + (to_s - from_s) * piece as f64 / pieces;
        (0..pieces as usize).all(|piece| {
            let times_s = [time_s(piece), time_s(piece + 1)];
            let [from, to] = times_s.map(|time_s| self.state_at(time_s).position);
            let duration_s = times_s[1] - times_s[0];
            let static_m = clearance_m + sagitta_m(normal_component(acceleration, to - from), duration_s);
            // relative to a moving obstacle the chord has another direction
            let moving_m = clearance_m + sagitta_m(acceleration.norm(), duration_s);
            space.is_clear(from, to, static_m)
                && space.is_clear_of_moving((from, times_s[0]), (to, times_s[1]), moving_m)
        })
    }
}

/// Largest distance of an arc of constant acceleration from its chord, a t²/8, m.
pub fn sagitta_m(acceleration_mps2: f64, time_s: f64) -> f64 {
    acceleration_mps2 * time_s * time_s / 8.0
}

/// Length of the component of `a` normal to `direction`; |a| if the direction is zero.
fn normal_component(a: Point, direction: Point) -> f64 {
    let length2 = direction.dot(&direction);
    let along2 = if length2 > 0.0 { a.dot(&direction).powi(2) / length2 } else { 0.0 };
    (a.dot(&a) - along2).max(0.0).sqrt()
}
