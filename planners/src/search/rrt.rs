//! Rapidly exploring random trees: RRT (LaValle 1998) and RRT* (Karaman, Frazzoli 2011). Edges are checked as whole
//! segments, not at samples.

use rand::{Rng, RngExt};

use super::PathProblem;
use crate::free_space::{Point, interpolate};

/// Growth of the tree.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RrtSettings {
    /// Maximum length of an edge, m.
    pub step_m: f64,
    /// Probability with which the goal is the sample.
    pub goal_bias: f64,
    /// Maximum number of samples.
    pub max_samples: usize,
    /// Radius within which RRT* chooses parents and rewires, m. Absent: RRT, which ends with the first path.
    pub rewire_radius_m: Option<f64>,
}

/// A path of straight legs from start to goal; `None` if the samples are used up before one is found.
///
/// # Panics
///
/// If a free coordinate is unbounded.
pub fn search(problem: &PathProblem, settings: &RrtSettings, stream: &mut impl Rng) -> Option<Vec<Point>> {
    let goal = problem.goal;
    let mut tree = Tree { problem, nodes: vec![Node { position: problem.start, parent: 0, length_m: 0.0 }] };
    let mut goal_parents: Vec<usize> = Vec::new();
    for _ in 0..settings.max_samples {
        let is_goal = stream.random_range(0.0..1.0) < settings.goal_bias;
        let sample = if is_goal { goal } else { uniform_sample(problem, stream) };
        let nearest = tree.nearest(sample);
        let from = tree.nodes[nearest].position;
        let distance_m = (from - sample).norm();
        if distance_m == 0.0 {
            continue;
        }
        let position = interpolate(from, sample, (settings.step_m / distance_m).min(1.0));
        let Some(new) = tree.add(position, nearest, settings.rewire_radius_m) else { continue };
        if (position - goal).norm() <= settings.step_m && problem.is_clear(position, goal) {
            goal_parents.push(new);
            if settings.rewire_radius_m.is_none() {
                break;
            }
        }
    }
    let length_m = |parent: &usize| tree.length_through_m(*parent, goal);
    let best = goal_parents.into_iter().min_by(|a, b| length_m(a).total_cmp(&length_m(b)))?;
    Some(tree.path_to(best))
}

/// A point uniformly distributed within the bounds; in the plane at the start's altitude.
fn uniform_sample(problem: &PathProblem, stream: &mut impl Rng) -> Point {
    let mut point = problem.start;
    for (coordinate, &[low, high]) in point.iter_mut().zip(&problem.space.bounds_m).take(problem.axes) {
        *coordinate = stream.random_range(low..high);
    }
    point
}

struct Tree<'a> {
    problem: &'a PathProblem,
    nodes: Vec<Node>,
}

#[derive(Clone, Copy, Debug)]
struct Node {
    position: Point,
    parent: usize,
    /// Length of the path from the start, m.
    length_m: f64,
}

impl Tree<'_> {
    fn nearest(&self, point: Point) -> usize {
        let distance_m = |i: &usize| (self.nodes[*i].position - point).norm();
        (0..self.nodes.len()).min_by(|a, b| distance_m(a).total_cmp(&distance_m(b))).expect("a tree has a root")
    }

    /// Length of the path from the start by node `i` to `point`, m.
    fn length_through_m(&self, i: usize, point: Point) -> f64 {
        self.nodes[i].length_m + (self.nodes[i].position - point).norm()
    }

    /// Adds a node below `nearest`, or with rewiring below the neighbour that gives the shortest path, and rewires the
    /// neighbours that are reached sooner by the new node. `None` if the edge from `nearest` is blocked.
    fn add(&mut self, position: Point, nearest: usize, rewire_radius_m: Option<f64>) -> Option<usize> {
        if !self.problem.is_clear(self.nodes[nearest].position, position) {
            return None;
        }
        let neighbours: Vec<usize> = rewire_radius_m.map_or_else(Vec::new, |radius_m| {
            (0..self.nodes.len()).filter(|&i| (self.nodes[i].position - position).norm() <= radius_m).collect()
        });
        let mut parent = nearest;
        for &i in &neighbours {
            if self.length_through_m(i, position) < self.length_through_m(parent, position)
                && self.problem.is_clear(self.nodes[i].position, position)
            {
                parent = i;
            }
        }
        let new = self.nodes.len();
        self.nodes.push(Node { position, parent, length_m: self.length_through_m(parent, position) });
        for i in neighbours {
            let length_m = self.length_through_m(new, self.nodes[i].position);
            if length_m < self.nodes[i].length_m && self.problem.is_clear(position, self.nodes[i].position) {
                self.reparent(i, new, length_m);
            }
        }
        Some(new)
    }

    /// Moves node `i` below `parent` and shortens the paths to all its descendants.
    fn reparent(&mut self, i: usize, parent: usize, length_m: f64) {
        let shorter_m = self.nodes[i].length_m - length_m;
        self.nodes[i].parent = parent;
        let mut subtree = vec![i];
        while let Some(node) = subtree.pop() {
            self.nodes[node].length_m -= shorter_m;
            subtree.extend((1..self.nodes.len()).filter(|&other| self.nodes[other].parent == node));
        }
    }

    /// The path from the start by node `end` to the goal.
    fn path_to(&self, end: usize) -> Vec<Point> {
        let mut path = vec![self.problem.goal];
        let mut at = end;
        loop {
            path.push(self.nodes[at].position);
            if at == 0 {
                break;
            }
            at = self.nodes[at].parent;
        }
        path.reverse();
        path.dedup_by(|a, b| (*a - *b).norm() == 0.0);
        path
    }
}
