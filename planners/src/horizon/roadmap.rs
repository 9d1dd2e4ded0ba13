//! A graph of ways to the goal.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use crate::free_space::FreeSpace;
use crate::free_space::vector::{Point, distance};

/// Points and the free straight ways between them. Node 0 is the goal.
#[derive(Clone, Debug, PartialEq)]
pub struct Roadmap {
    nodes: Vec<Point>,
    /// Neighbours of each node with the distance, m.
    neighbours: Vec<Vec<(usize, f64)>>,
    /// Shortest way to the goal along the graph, m; infinite where there is none.
    cost_to_go_m: Vec<f64>,
}

/// What is left from a point to the goal, by way of the graph.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CostToGo {
    /// Length of the way, m.
    pub length_m: f64,
    /// The node that it begins with.
    pub node: usize,
}

/// Which nodes a point may go to first.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sight {
    /// Distance that the way keeps from everything, m.
    pub clearance_m: f64,
    /// Length that the way has at most, m; if no node is seen within it, any node will do.
    pub reach_m: f64,
}

impl Roadmap {
    /// The goal alone.
    pub fn to(goal: Point) -> Self {
        Self { nodes: vec![goal], neighbours: vec![Vec::new()], cost_to_go_m: vec![0.0] }
    }

    /// Nodes; the goal is the first.
    pub fn nodes(&self) -> &[Point] {
        &self.nodes
    }

    /// Shortest way from each node to the goal, m; infinite where there is none.
    pub fn cost_to_go_m(&self) -> &[f64] {
        &self.cost_to_go_m
    }

    /// Every edge once.
    pub fn edges(&self) -> impl Iterator<Item = [Point; 2]> {
        self.neighbours.iter().enumerate().flat_map(move |(i, neighbours)| {
            let later = neighbours.iter().filter(move |(j, _)| i < *j);
            later.map(move |&(j, _)| [self.nodes[i], self.nodes[j]])
        })
    }

    /// Adds a node without neighbours and returns its index.
    pub fn add_node(&mut self, node: Point) -> usize {
        self.nodes.push(node);
        self.neighbours.push(Vec::new());
        self.cost_to_go_m.push(f64::INFINITY);
        self.nodes.len() - 1
    }

    /// Connects two nodes.
    pub fn connect(&mut self, i: usize, j: usize) {
        let length_m = distance(self.nodes[i], self.nodes[j]);
        self.neighbours[i].push((j, length_m));
        self.neighbours[j].push((i, length_m));
    }

    /// Keeps the goal, the nodes that pass `keeps_node` and the edges between them that pass `keeps_edge`.
    pub fn retain(&mut self, keeps_node: impl Fn(Point) -> bool, keeps_edge: impl Fn(Point, Point) -> bool) {
        let mut renumbered = vec![None; self.nodes.len()];
        let mut kept = Self { nodes: Vec::new(), neighbours: Vec::new(), cost_to_go_m: Vec::new() };
        for (i, &node) in self.nodes.iter().enumerate() {
            if i == 0 || keeps_node(node) {
                renumbered[i] = Some(kept.add_node(node));
            }
        }
        for (i, neighbours) in self.neighbours.iter().enumerate() {
            let Some(from) = renumbered[i] else { continue };
            let edges = neighbours.iter().filter_map(|&(j, length_m)| Some((renumbered[j]?, length_m)));
            let nodes = &kept.nodes;
            kept.neighbours[from] = edges.filter(|&(to, _)| keeps_edge(nodes[from], nodes[to])).collect();
        }
        *self = kept;
    }

    /// Dijkstra's algorithm from the goal.
    pub fn update_costs(&mut self) {
        self.cost_to_go_m.fill(f64::INFINITY);
        self.cost_to_go_m[0] = 0.0;
        let mut open = BinaryHeap::from([Reverse(Reached { length_m: 0.0, node: 0 })]);
        while let Some(Reverse(Reached { length_m, node })) = open.pop() {
            if length_m > self.cost_to_go_m[node] {
                continue;
            }
            for &(next, step_m) in &self.neighbours[node] {
                let through_m = length_m + step_m;
                if through_m < self.cost_to_go_m[next] {
                    self.cost_to_go_m[next] = through_m;
                    open.push(Reverse(Reached { length_m: through_m, node: next }));
                }
            }
        }
    }

    /// The shortest way from `point` to a node that it sees by that rule, and on along the graph (eq. 10); nothing if it
    /// sees none.
    ///
    /// Nodes are tried in the order of what the way by them would cost, so that the first one that is seen is the best.
    pub fn cost_to_go(&self, point: Point, space: &FreeSpace, sight: Sight) -> Option<CostToGo> {
        let within = |reach_m: f64| {
            let mut tried: Option<Reached> = None;
            loop {
                let best = self.next_best(point, reach_m, tried)?;
                if space.is_clear(point, self.nodes[best.node], sight.clearance_m) {
                    return Some(CostToGo { length_m: best.length_m, node: best.node });
                }
                tried = Some(best);
            }
        };
        within(sight.reach_m).or_else(|| within(f64::INFINITY))
    }

    /// The nodes from `node` to the goal.
    pub fn way_from(&self, node: usize) -> Vec<Point> {
        let mut way = vec![self.nodes[node]];
        let mut at = node;
        while at != 0 {
            let left_m = |&(next, step_m): &(usize, f64)| step_m + self.cost_to_go_m[next];
            let next = self.neighbours[at].iter().min_by(|a, b| left_m(a).total_cmp(&left_m(b)));
            match next {
                Some(&(next, _)) if self.cost_to_go_m[next] < self.cost_to_go_m[at] => at = next,
                _ => break,
            }
            way.push(self.nodes[at]);
        }
        way
    }

    /// The best node after the one that has been tried last, as if all were seen.
    fn next_best(&self, point: Point, reach_m: f64, tried: Option<Reached>) -> Option<Reached> {
        let mut best: Option<Reached> = None;
        for (node, (&at, &rest_m)) in self.nodes.iter().zip(&self.cost_to_go_m).enumerate() {
            let away_m = distance(point, at);
            let way = Reached { length_m: away_m + rest_m, node };
            let is_next = tried.is_none_or(|tried| way > tried) && best.is_none_or(|best| way < best);
            if is_next && away_m <= reach_m && way.length_m < f64::INFINITY {
                best = Some(way);
            }
        }
        best
    }
}

/// A node and the length of the way to it, in the order of the length.
#[derive(Clone, Copy, Debug)]
struct Reached {
    length_m: f64,
    node: usize,
}

impl Ord for Reached {
    fn cmp(&self, other: &Self) -> std::cmp::Ordering {
        self.length_m.total_cmp(&other.length_m).then(self.node.cmp(&other.node))
    }
}

impl PartialOrd for Reached {
    fn partial_cmp(&self, other: &Self) -> Option<std::cmp::Ordering> {
        Some(self.cmp(other))
    }
}

impl PartialEq for Reached {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other).is_eq()
    }
}

impl Eq for Reached {}
