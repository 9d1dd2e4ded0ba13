//! Sparse A* (Szczerba et al. 2000): A* on a grid whose expansion respects the least length of a leg, the largest turn
//! between two legs and the largest length of the whole path.
//!
//! A state is a grid point together with the leg that led there; the grid has the start as a point. From a state one leg
//! leads to each grid point that is a leg away, straight, without passing another grid point, and within the turn limit.

use std::cmp::Reverse;
use std::collections::{BinaryHeap, HashMap};

use crate::free_space::FreeSpace;
use crate::free_space::vector::{Point, distance, dot, norm};

/// What the search respects.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rules {
    /// Distance between grid points, m.
    pub spacing_m: f64,
    /// Least and largest length of a leg in units of the grid.
    pub leg: [f64; 2],
    /// Cosine of the largest turn between two legs.
    pub turn_cosine: f64,
    /// Largest length of the path, m.
    pub longest_m: f64,
    /// Coordinates that are free: 2 in the plane, 3 in space.
    pub axes: usize,
    /// States that may be expanded.
    pub budget: usize,
    /// The distance to the goal guides the search; without it, it is Dijkstra's.
    pub is_guided: bool,
}

/// A grid point, relative to the start.
type Cell = [i32; 3];

/// A grid point, and the index of the leg that led there.
type State = (Cell, usize);

/// Index of the leg that leads to the start.
const NO_LEG: usize = usize::MAX;

/// What the search has found.
#[derive(Clone, Debug, PartialEq)]
pub struct Found {
    /// Corners from start to goal.
    pub path: Vec<Point>,
    /// States that were expanded.
    pub expanded: usize,
}

/// The shortest path on the grid; nothing if there is none within the rules.
pub fn search(space: &FreeSpace, start: Point, goal: Point, clearance_m: f64, rules: &Rules) -> Option<Found> {
    let mut search = Search {
        space,
        start,
        goal,
        clearance_m,
        rules,
        legs: legs(rules),
        reached: HashMap::new(),
        open: BinaryHeap::new(),
    };
    search.run()
}

/// Every leg: a primitive vector of the grid within the lengths.
fn legs(rules: &Rules) -> Vec<Cell> {
    let most = rules.leg[1].floor() as i32;
    let vertical = if rules.axes == 3 { most } else { 0 };
    let mut legs = Vec::new();
    for x in -most..=most {
        for y in -most..=most {
            for z in -vertical..=vertical {
                let length = norm([x, y, z].map(f64::from));
                let divisor = [x, y, z].into_iter().map(i32::unsigned_abs).fold(0, greatest_common_divisor);
                // a multiple of a shorter leg is left out unless that one is too short
                let is_primitive = divisor == 1 || length / f64::from(divisor.max(1)) < rules.leg[0];
                if is_primitive && (rules.leg[0]..=rules.leg[1]).contains(&length) {
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

struct Search<'a> {
    space: &'a FreeSpace,
    start: Point,
    goal: Point,
    clearance_m: f64,
    rules: &'a Rules,
    legs: Vec<Cell>,
    /// Length of the shortest path known, and where it comes from.
    reached: HashMap<State, (f64, State)>,
    open: BinaryHeap<Reverse<Open>>,
}

/// A state that waits to be expanded, or the goal, reached from one.
struct Open {
    bound_m: f64,
    length_m: f64,
    state: State,
    is_goal: bool,
}

impl Search<'_> {
    fn run(&mut self) -> Option<Found> {
        let start = ([0; 3], NO_LEG);
        self.reached.insert(start, (0.0, start));
        self.push(start, 0.0, false);
        let mut expanded = 0;
        while let Some(Reverse(open)) = self.open.pop() {
            if open.is_goal {
                return Some(Found { path: self.path_to(open.state), expanded });
            }
            if open.length_m > self.reached[&open.state].0 {
                continue;
            }
            expanded += 1;
            if expanded > self.rules.budget {
                return None;
            }
            self.expand(open.state, open.length_m);
        }
        None
    }

    fn expand(&mut self, state: State, length_m: f64) {
        let here = self.point(state.0);
        let to_goal_m = distance(here, self.goal);
        let direction = [0, 1, 2].map(|axis| self.goal[axis] - here[axis]);
        // the last leg may be as short as it has to be
        if to_goal_m <= self.rules.leg[1] * self.rules.spacing_m
            && self.may_turn(state.1, direction)
            && self.space.is_clear(here, self.goal, self.clearance_m)
        {
            self.push(state, length_m + to_goal_m, true);
        }
        for leg in 0..self.legs.len() {
            let step = self.legs[leg];
            let cell = [0, 1, 2].map(|axis| state.0[axis] + step[axis]);
            let next = self.point(cell);
            let through_m = length_m + distance(here, next);
            let is_shorter = self.reached.get(&(cell, leg)).is_none_or(|&(known_m, _)| through_m < known_m);
            if is_shorter
                && through_m + distance(next, self.goal) <= self.rules.longest_m
                && self.may_turn(state.1, step.map(f64::from))
                && self.space.is_clear(here, next, self.clearance_m)
            {
                self.reached.insert((cell, leg), (through_m, state));
                self.push((cell, leg), through_m, false);
            }
        }
    }

    fn push(&mut self, state: State, length_m: f64, is_goal: bool) {
        let left_m = if is_goal || !self.rules.is_guided { 0.0 } else { distance(self.point(state.0), self.goal) };
        self.open.push(Reverse(Open { bound_m: length_m + left_m, length_m, state, is_goal }));
    }

    fn may_turn(&self, leg: usize, direction: Point) -> bool {
        let Some(&before) = self.legs.get(leg) else { return true };
        let before = before.map(f64::from);
        let lengths = norm(before) * norm(direction);
        lengths == 0.0 || dot(before, direction) >= self.rules.turn_cosine * lengths
    }

    fn point(&self, cell: Cell) -> Point {
        [0, 1, 2].map(|axis| self.start[axis] + self.rules.spacing_m * f64::from(cell[axis]))
    }

    fn path_to(&self, state: State) -> Vec<Point> {
        let mut path = vec![self.goal];
        let mut at = state;
        while at.1 != NO_LEG {
            path.push(self.point(at.0));
            at = self.reached[&at].1;
        }
        path.push(self.start);
        path.reverse();
        path.dedup_by(|a, b| distance(*a, *b) == 0.0);
        path
    }
}

impl Open {
    fn key(&self) -> (State, bool) {
        (self.state, self.is_goal)
    }
}

impl Ord for Open {
    fn cmp(&self, other: &Self) -> std::cmp::Ordering {
        self.bound_m.total_cmp(&other.bound_m).then_with(|| self.key().cmp(&other.key()))
    }
}

impl PartialOrd for Open {
    fn partial_cmp(&self, other: &Self) -> Option<std::cmp::Ordering> {
        Some(self.cmp(other))
    }
}

impl PartialEq for Open {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other).is_eq()
    }
}

impl Eq for Open {}
