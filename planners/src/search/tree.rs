//! Rapidly exploring random trees: RRT (LaValle 1998) and RRT* (Karaman, Frazzoli 2011). Every edge is clear from end to
//! end, not at samples of it.

use rand::{Rng, RngExt};

use crate::free_space::FreeSpace;
use crate::free_space::vector::{Point, distance, interpolate};

/// How a tree grows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rules {
    /// Longest edge, m.
    pub step_m: f64,
    /// Share of the samples that are the goal.
    pub goal_share: f64,
    /// Samples that may be drawn.
    pub samples: usize,
    /// Distance within which RRT* chooses parents and rewires, m. Absent: RRT, which ends with the first path.
    pub rewire_m: Option<f64>,
    /// Coordinates that are free: 2 in the plane, 3 in space.
    pub axes: usize,
}

/// A path of straight legs from start to goal; nothing if the samples are used up before.
pub fn grow(
    space: &FreeSpace,
    start: Point,
    goal: Point,
    clearance_m: f64,
    rules: &Rules,
    stream: &mut impl Rng,
) -> Option<Vec<Point>> {
    let mut tree = Tree { space, clearance_m, nodes: vec![Node { at: start, parent: 0, length_m: 0.0 }] };
    let mut ends: Vec<usize> = Vec::new();
    for _ in 0..rules.samples {
        let sample =
            if stream.random_range(0.0..1.0) < rules.goal_share { goal } else { draw(space, start, rules, stream) };
        let nearest = tree.nearest(sample);
        let from = tree.nodes[nearest].at;
        let away_m = distance(from, sample);
        if away_m == 0.0 {
            continue;
        }
        let at = interpolate(from, sample, (rules.step_m / away_m).min(1.0));
        let Some(new) = tree.add(at, nearest, rules.rewire_m) else { continue };
        if distance(at, goal) <= rules.step_m && tree.sees(at, goal) {
            ends.push(new);
            if rules.rewire_m.is_none() {
                break;
            }
        }
    }
    let whole_m = |end: &usize| tree.nodes[*end].length_m + distance(tree.nodes[*end].at, goal);
    let best = ends.into_iter().min_by(|a, b| whole_m(a).total_cmp(&whole_m(b)))?;
    Some(tree.path_to(best, goal))
}

/// A point anywhere in the frame, at the start's altitude in the plane.
fn draw(space: &FreeSpace, start: Point, rules: &Rules, stream: &mut impl Rng) -> Point {
    let mut point = start;
    for (coordinate, &[low, high]) in point.iter_mut().zip(&space.frame_m).take(rules.axes) {
        *coordinate = stream.random_range(low..high);
    }
    point
}

struct Tree<'a> {
    space: &'a FreeSpace,
    clearance_m: f64,
    nodes: Vec<Node>,
}

#[derive(Clone, Copy, Debug)]
struct Node {
    at: Point,
    parent: usize,
    /// Way from the start, m.
    length_m: f64,
}

impl Tree<'_> {
    fn sees(&self, from: Point, to: Point) -> bool {
        self.space.is_clear(from, to, self.clearance_m)
    }

    fn nearest(&self, point: Point) -> usize {
        let away_m = |i: &usize| distance(self.nodes[*i].at, point);
        (0..self.nodes.len()).min_by(|a, b| away_m(a).total_cmp(&away_m(b))).expect("a tree has a root")
    }

    /// Adds a node below `nearest`, or below whichever neighbour makes its way shortest, and leads neighbours through it
    /// where that is shorter.
    fn add(&mut self, at: Point, nearest: usize, rewire_m: Option<f64>) -> Option<usize> {
        if !self.sees(self.nodes[nearest].at, at) {
            return None;
        }
        let neighbours: Vec<usize> = rewire_m.map_or_else(Vec::new, |radius_m| {
            (0..self.nodes.len()).filter(|&i| distance(self.nodes[i].at, at) <= radius_m).collect()
        });
        let through_m = |tree: &Self, i: usize| tree.nodes[i].length_m + distance(tree.nodes[i].at, at);
        let mut parent = nearest;
        for &i in &neighbours {
            if through_m(self, i) < through_m(self, parent) && self.sees(self.nodes[i].at, at) {
                parent = i;
            }
        }
        let new = self.nodes.len();
        self.nodes.push(Node { at, parent, length_m: through_m(self, parent) });
        for i in neighbours {
            let by_new_m = self.nodes[new].length_m + distance(at, self.nodes[i].at);
            if by_new_m < self.nodes[i].length_m && self.sees(at, self.nodes[i].at) {
                self.hang(i, new, by_new_m);
            }
        }
        Some(new)
    }

    /// Hangs node `i` below `parent` and shortens the ways of all below it.
    fn hang(&mut self, i: usize, parent: usize, length_m: f64) {
        let shorter_m = self.nodes[i].length_m - length_m;
        self.nodes[i].parent = parent;
        let mut below = vec![i];
        while let Some(node) = below.pop() {
            self.nodes[node].length_m -= shorter_m;
            below.extend((1..self.nodes.len()).filter(|&other| self.nodes[other].parent == node));
        }
    }

    fn path_to(&self, end: usize, goal: Point) -> Vec<Point> {
        let mut path = vec![goal];
        let mut at = end;
        loop {
            path.push(self.nodes[at].at);
            if at == 0 {
                break;
            }
            at = self.nodes[at].parent;
        }
        path.reverse();
        path.dedup_by(|a, b| distance(*a, *b) == 0.0);
        path
    }
}
