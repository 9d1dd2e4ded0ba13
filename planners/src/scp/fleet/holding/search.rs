//! Depth-first search for the turns of one vehicle that holds.
//!
//! The time until the last arrival is divided into intervals, in each of which the vehicle turns left, right or not, sharply or
//! gently. The same turn as before is tried first: without others around the hold is a circle, and where something is in the
//! way the turn is changed as late as possible. States that come close to one that led nowhere are not tried again.

use std::collections::HashSet;

use nalgebra::Vector2;
use scenarios::fixed_wing::GRAVITY_MPS2;
use scenarios::{Range, Scenario};

use super::super::super::dynamics::{Control, State};
use super::super::super::interval::Interval;
use super::super::super::iterate::Iterate;
use super::super::super::shooting::{self, Knots, SUBSTEPS};
use super::super::agility::Agility;
use super::super::avoidance_rows::AvoidanceConstraints;
use super::super::closest_approach;
use super::super::intersample_bounds::BOUNDED_STATES;
use super::super::motion::{TimeSlice, sample};
use super::track::Track;
use crate::convex::STAGE_LEN;

/// Lateral load factors, as fractions of the planning limits.
const TURNS: [f64; 5] = [0.9, 0.45, 0.0, -0.45, -0.9];
/// The turns that are tried first, as indices of [`TURNS`]: a search each.
const FIRST_TURNS: [usize; 3] = [0, 4, 2];
/// Number of intervals that one search tries.
const MAX_TRIED: usize = 1500;
/// States of one time are close within this distance, m, and this angle, rad.
const CELL: [f64; 2] = [20.0, 0.1];
/// Fraction of an interval during which the controls change.
const RAMP_FRACTION: f64 = 0.25;
/// Distance of the speed from its limits, as a fraction of its range.
const SPEED_MARGIN: f64 = 0.01;
/// Largest violation of a limit, as a fraction of its range: rounding.
const ROUNDING: f64 = 1e-12;

/// What one vehicle's hold is searched for with.
pub struct HoldSearch<'a> {
    pub scenario: &'a Scenario,
    pub constraints: &'a AvoidanceConstraints<'a>,
    pub vehicle: usize,
    /// Planning limits.
    pub bounds: &'a [Range; STAGE_LEN],
    /// Arrival of the last vehicle, s.
    pub end_s: f64,
}

/// A search under way.
struct Tree<'a> {
    problem: &'a HoldSearch<'a>,
    /// Per interval, the others that may be met in it.
    others: &'a [Vec<TimeSlice>],
    dt_s: f64,
    spare_m: f64,
    speed_mps: f64,
    states: Vec<State>,
    controls: Vec<Control>,
    visited: HashSet<(usize, usize, [i64; 3])>,
    tried: usize,
}

impl HoldSearch<'_> {
    /// The hold after `mission`; `None` if none is found.
    ///
    /// - `tracks`: of all vehicles, as far as they are planned
    /// - `spare_m`: distance to keep beyond separation and clearance
    pub fn run(&self, mission: &Iterate, tracks: &[Track], spare_m: f64) -> Option<Iterate> {
        let from_s = mission.flight_time_s();
        let limits = &self.scenario.fixed_wing_model(&self.scenario.vehicles[self.vehicle]).planning_limits;
        let count = ((self.end_s - from_s) / Agility::new(limits).interval_s()).ceil().max(1.0);
        let dt_s = (self.end_s - from_s) / count;
        let others: Vec<Vec<TimeSlice>> =
            (0..count as usize).map(|k| self.others(tracks, from_s + dt_s * k as f64, dt_s)).collect();
        let last = mission.intervals();
        let (state, control) = (mission.states[last], mission.controls[last]);
        let speed_margin_mps = SPEED_MARGIN * self.bounds[3].width();
        let speed_mps = state[3].max(self.bounds[3].min + speed_margin_mps).min(self.bounds[3].max - speed_margin_mps);
        FIRST_TURNS.into_iter().find_map(|first| {
            let mut tree = Tree {
                problem: self,
                others: &others,
                dt_s,
                spare_m,
                speed_mps,
                states: vec![state],
                controls: vec![control],
                visited: HashSet::new(),
                tried: 0,
            };
            let found = tree.grow(first);
            found.then_some(Iterate { states: tree.states, controls: tree.controls, dt_s, ramp: RAMP_FRACTION })
        })
    }

    /// The motion of the others during an interval. One of which nothing is planned any more counts as absent.
    fn others(&self, tracks: &[Track], from_s: f64, dt_s: f64) -> Vec<TimeSlice> {
        let slice = |track: &Track| std::array::from_fn(|m| track.at(from_s + dt_s * m as f64 / SUBSTEPS as f64));
        let others = tracks.iter().enumerate().filter(|(other, _)| *other != self.vehicle);
        others.filter(|(_, track)| track.end_s() > from_s).map(|(_, track)| slice(track)).collect()
    }
}

impl Tree<'_> {
    /// Extends the hold to its end, after an interval with the turn `last`. Is there one?
    fn grow(&mut self, last: usize) -> bool {
        let k = self.states.len() - 1;
        if k == self.others.len() {
            return true;
        }
        let mut turns: [usize; TURNS.len()] = std::array::from_fn(|turn| turn);
        turns.sort_by_key(|turn| turn.abs_diff(last));
        for turn in turns {
            self.tried += 1;
            if self.tried > MAX_TRIED {
                return false;
            }
            let interval = self.interval(k, TURNS[turn]);
            let knots = shooting::flow(&interval);
            let end = shooting::accurate_end(&interval);
            if !self.is_within_limits(&knots) || !self.is_clear(k, &knots) || !self.visited.insert(cell(k, turn, &end))
            {
                continue;
            }
            self.states.push(end);
            self.controls.push(interval.controls[1]);
            if self.grow(turn) {
                return true;
            }
            self.states.pop();
            self.controls.pop();
        }
        false
    }

    /// The interval after node k, with a turn. Its end is not known yet.
    fn interval(&self, k: usize, turn: f64) -> Interval {
        let (state, control) = (self.states[k], self.controls[k]);
        let n_y = self.problem.bounds[7];
        let n_y = (if turn < 0.0 { -turn * n_y.min } else { turn * n_y.max }).clamp(n_y.min, n_y.max);
        let [n_x, n_z] = self.level(&state, &control);
        let next = Control::new(n_x, n_y, n_z);
        Interval { states: [state, state], controls: [control, next], dt_s: self.dt_s, ramp: RAMP_FRACTION }
    }

    /// The load factors (n_x, n_z) with which an interval ends level and at the speed of the hold, if the limits permit.
    ///
    /// ```text
    /// V' = g (n_x - sin γ)        γ' = g (n_z - cos γ)/V
    /// ```
    fn level(&self, state: &State, control: &Control) -> [f64; 2] {
        let (v, γ) = (state[3], state[5]);
        let per_s = 1.0 / (GRAVITY_MPS2 * self.dt_s);
        let mean = [0.5 * γ.sin() + (self.speed_mps - v) * per_s, γ.cos() - γ * v * per_s];
        let ranges = [self.problem.bounds[6], self.problem.bounds[8]];
        std::array::from_fn(|i| {
            let own = control[2 * i];
            let next = (mean[i] - 0.5 * RAMP_FRACTION * own) / (1.0 - 0.5 * RAMP_FRACTION);
            next.clamp(ranges[i].min, ranges[i].max)
        })
    }

    fn is_within_limits(&self, knots: &Knots) -> bool {
        BOUNDED_STATES.iter().all(|&i| {
            let range = self.problem.bounds[i];
            let rounding = if range.width().is_finite() { ROUNDING * range.width() } else { 0.0 };
            knots[1..].iter().all(|state| range.min - rounding <= state[i] && state[i] <= range.max + rounding)
        })
    }

    fn is_clear(&self, k: usize, knots: &Knots) -> bool {
        let constraints = self.problem.constraints;
        let slice = knots.map(|state| sample(&state));
        let reach_m = slice.iter().map(|at| (at.position_m - slice[0].position_m).norm()).fold(0.0, f64::max);
        let is_off =
            |others_reach_m: f64, start_m: f64, required_m: f64| start_m > required_m + reach_m + others_reach_m;
        let clearance_m = constraints.clearance_m + self.spare_m;
        let clears_obstacles = constraints.cylinders.iter().all(|cylinder| {
            let required_m = cylinder.radius_m + clearance_m;
            let center_m = Vector2::from(cylinder.center_m);
            is_off(0.0, (slice[0].position_m - center_m).norm(), required_m)
                || closest_approach::to_point(&slice, center_m, self.dt_s).distance_m >= required_m
        });
        let required_m = constraints.separation_m + self.spare_m;
        clears_obstacles
            && self.others[k].iter().all(|other| {
                let others_reach_m =
                    other.iter().map(|at| (at.position_m - other[0].position_m).norm()).fold(0.0, f64::max);
                is_off(others_reach_m, (slice[0].position_m - other[0].position_m).norm(), required_m)
                    || closest_approach::of_vehicles(&slice, other, self.dt_s, 1.0).distance_m >= required_m
            })
    }
}

fn cell(k: usize, turn: usize, state: &State) -> (usize, usize, [i64; 3]) {
    let [position_m, angle_rad] = CELL;
    let index = |value: f64, width: f64| (value / width).round() as i64;
    (k, turn, [index(state[0], position_m), index(state[1], position_m), index(state[4], angle_rad)])
}
