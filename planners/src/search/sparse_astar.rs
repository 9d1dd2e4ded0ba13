//! Sparse A* (Szczerba et al. 2000): A* on a grid with a minimum leg length, a maximum turn between two legs and a maximum
//! length of the path.
//!
//! A state is a grid point together with the leg that led there; the start is a grid point. Successors of a state are the
//! grid points one leg away, within the turn limit. Legs are primitive grid vectors, which pass no other grid point.

use std::collections::HashMap;

use super::PathProblem;
use crate::free_space::Point;
use crate::open_list::{OpenList, TotalF64};

/// Grid and limits of the search.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SparseAstarSettings {
    /// Distance between grid points, m.
    pub spacing_m: f64,
    /// Minimum and maximum length of a leg, in grid spacings.
    pub leg_cells: [f64; 2],
    /// Cosine of the maximum turn between two legs.
    pub cos_max_turn: f64,
    /// Maximum length of the path, m.
    pub max_length_m: f64,
    /// Maximum number of expanded states.
    pub max_expansions: usize,
    /// Uses the distance to the goal as the heuristic; without it the search is Dijkstra's algorithm.
    pub uses_heuristic: bool,
}

/// A grid point, relative to the start.
type Cell = [i32; 3];

/// A grid point, and the index of the leg that led there.
type State = (Cell, usize);

/// Leg index of the start state.
const NO_LEG: usize = usize::MAX;

/// Result of a search.
#[derive(Clone, Debug, PartialEq)]
pub struct GridPath {
    /// Corners from start to goal, both included.
    pub path: Vec<Point>,
    /// Number of expanded states.
    pub expanded: usize,
}

/// The shortest path on the grid; `None` if there is none within the limits.
pub fn search(problem: &PathProblem, settings: &SparseAstarSettings) -> Option<GridPath> {
    let legs = legs(settings, problem.axes);
    Search { problem, settings, legs, reached: HashMap::new(), open: OpenList::new() }.run()
}

/// All legs: the primitive grid vectors within the length limits.
fn legs(settings: &SparseAstarSettings, axes: usize) -> Vec<Cell> {
    let [min_length, max_length] = settings.leg_cells;
    let max = max_length.floor() as i32;
    let max_z = if axes == 3 { max } else { 0 };
    let mut legs = Vec::new();
    for x in -max..=max {
        for y in -max..=max {
            for z in -max_z..=max_z {
                let length = vector([x, y, z]).norm();
                let divisor = [x, y, z].into_iter().map(i32::unsigned_abs).fold(0, greatest_common_divisor);
                // a multiple of a shorter leg counts only if that one is too short
                let is_primitive = divisor == 1 || length / f64::from(divisor.max(1)) < min_length;
                if is_primitive && (min_length..=max_length).contains(&length) {
                    legs.push([x, y, z]);
                }
            }
        }
    }
    legs
}

fn greatest_common_divisor(a: u32, b: u32) -> u32 {
    if b == 0 { a } else { greatest_common_divisor(b, a % b) }
}

fn vector(cell: Cell) -> Point {
    cell.map(f64::from).into()
}

struct Search<'a> {
    problem: &'a PathProblem,
    settings: &'a SparseAstarSettings,
    legs: Vec<Cell>,
    /// Length of the shortest known path to each state, m, and its last state but one.
    reached: HashMap<State, (f64, State)>,
    open: OpenList<Open>,
}

/// An entry of the open list, ordered by state. The goal is represented by the state before it.
type Open = (State, IsGoal, TotalF64);
type IsGoal = bool;

impl Search<'_> {
    fn run(&mut self) -> Option<GridPath> {
        let start = ([0; 3], NO_LEG);
        self.reached.insert(start, (0.0, start));
        self.push(start, 0.0, false);
        let mut expanded = 0;
        while let Some((_, (state, is_goal, TotalF64(length_m)))) = self.open.pop() {
            if is_goal {
                return Some(GridPath { path: self.path_to(state), expanded });
            }
            if length_m > self.reached[&state].0 {
                continue;
            }
            expanded += 1;
            if expanded > self.settings.max_expansions {
                return None;
            }
            self.expand(state, length_m);
        }
        None
    }

    fn expand(&mut self, state: State, length_m: f64) {
        let here = self.point(state.0);
        let to_goal = self.problem.goal - here;
        let to_goal_m = to_goal.norm();
        // the last leg may be shorter than the minimum
        if to_goal_m <= self.settings.leg_cells[1] * self.settings.spacing_m
            && self.is_turn_allowed(state.1, to_goal)
            && self.problem.is_clear(here, self.problem.goal)
        {
            self.push(state, length_m + to_goal_m, true);
        }
        for leg in 0..self.legs.len() {
            let step = self.legs[leg];
            let cell = [0, 1, 2].map(|axis| state.0[axis] + step[axis]);
            let next = self.point(cell);
            let through_m = length_m + (here - next).norm();
            let is_shorter = self.reached.get(&(cell, leg)).is_none_or(|&(known_m, _)| through_m < known_m);
            if is_shorter
                && through_m + self.distance_to_goal_m(next) <= self.settings.max_length_m
                && self.is_turn_allowed(state.1, vector(step))
                && self.problem.is_clear(here, next)
            {
                self.reached.insert((cell, leg), (through_m, state));
                self.push((cell, leg), through_m, false);
            }
        }
    }

    fn push(&mut self, state: State, length_m: f64, is_goal: bool) {
        let has_heuristic = self.settings.uses_heuristic && !is_goal;
        let heuristic_m = if has_heuristic { self.distance_to_goal_m(self.point(state.0)) } else { 0.0 };
        self.open.push(length_m + heuristic_m, (state, is_goal, TotalF64(length_m)));
    }

    fn is_turn_allowed(&self, leg: usize, direction: Point) -> bool {
        let Some(&previous) = self.legs.get(leg) else { return true };
        let previous = vector(previous);
        let lengths = previous.norm() * direction.norm();
        lengths == 0.0 || previous.dot(&direction) >= self.settings.cos_max_turn * lengths
    }

    fn point(&self, cell: Cell) -> Point {
        self.problem.start + self.settings.spacing_m * vector(cell)
    }

    fn distance_to_goal_m(&self, point: Point) -> f64 {
        (point - self.problem.goal).norm()
    }

    fn path_to(&self, state: State) -> Vec<Point> {
        let mut path = vec![self.problem.goal];
        let mut at = state;
        while at.1 != NO_LEG {
            path.push(self.point(at.0));
            at = self.reached[&at].1;
        }
        path.push(self.problem.start);
        path.reverse();
        path.dedup_by(|a, b| (*a - *b).norm() == 0.0);
        path
    }
}
