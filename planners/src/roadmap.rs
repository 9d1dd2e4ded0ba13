//! Roadmaps: graphs of collision-free paths to one goal, with the cost-to-go of every node.
//!
//! [`visibility`], [`voronoi`] and [`voronoi_vertices`] build the graph, [`CostMap`] keeps it up to date with the known obstacles, and
//! [`CostToGoQuery`] answers many cost-to-go queries near one position.

mod cost_map;
mod cost_to_go_query;
mod obstacle_grid;
mod shadows;
pub mod visibility;
pub mod voronoi;
pub mod voronoi_vertices;

pub use cost_map::{CostMap, RoadmapKind};
pub use cost_to_go_query::{CostToGoQuery, OccluderHints};

use crate::free_space::Point;
use crate::open_list::OpenList;

/// Nodes and the collision-free straight edges between them. Node 0 is the goal.
#[derive(Clone, Debug, PartialEq)]
pub struct Roadmap {
    nodes: Vec<Point>,
    /// Neighbours of each node with the length of the edge, m.
    neighbours: Vec<Vec<(usize, f64)>>,
    /// Length of the shortest path to the goal along the graph, m; infinite where there is none.
    cost_to_go_m: Vec<f64>,
}

/// Cost-to-go of a point by way of the graph.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CostToGo {
    /// Length of the path to the goal, m.
    pub length_m: f64,
    /// Its first node.
    pub node: usize,
}

/// Requirements on the straight link from a point to its first node.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LinkLimits {
    /// Clearance of the link, m.
    pub clearance_m: f64,
    /// Preferred maximum length, m: longer links count only if no shorter one is clear.
    pub preferred_length_m: f64,
}

impl Roadmap {
    /// The goal alone.
    pub fn with_goal(goal: Point) -> Self {
        Self { nodes: vec![goal], neighbours: vec![Vec::new()], cost_to_go_m: vec![0.0] }
    }

    /// Nodes; the goal is the first.
    pub fn nodes(&self) -> &[Point] {
        &self.nodes
    }

    /// Length of the shortest path from each node to the goal, m; infinite where there is none.
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
        let length_m = (self.nodes[i] - self.nodes[j]).norm();
        self.neighbours[i].push((j, length_m));
        self.neighbours[j].push((i, length_m));
    }

    /// Keeps the goal, the nodes that pass `keeps_node` and the edges between them that pass `keeps_edge`. Costs are reset;
    /// see [`update_costs`](Self::update_costs).
    pub fn retain(&mut self, keeps_node: impl Fn(Point) -> bool, keeps_edge: impl Fn(Point, Point) -> bool) {
        let mut new_index = vec![None; self.nodes.len()];
        let mut kept = Self { nodes: Vec::new(), neighbours: Vec::new(), cost_to_go_m: Vec::new() };
        for (i, &node) in self.nodes.iter().enumerate() {
            if i == 0 || keeps_node(node) {
                new_index[i] = Some(kept.add_node(node));
            }
        }
        for (i, neighbours) in self.neighbours.iter().enumerate() {
            let Some(from) = new_index[i] else { continue };
            let edges = neighbours.iter().filter_map(|&(j, length_m)| Some((new_index[j]?, length_m)));
            let nodes = &kept.nodes;
            kept.neighbours[from] = edges.filter(|&(to, _)| keeps_edge(nodes[from], nodes[to])).collect();
        }
        *self = kept;
    }

    /// Computes the cost-to-go of every node by Dijkstra's algorithm from the goal.
    pub fn update_costs(&mut self) {
        self.cost_to_go_m.fill(f64::INFINITY);
        self.cost_to_go_m[0] = 0.0;
        let mut open = OpenList::new();
        open.push(0.0, 0);
        while let Some((length_m, node)) = open.pop() {
            if length_m > self.cost_to_go_m[node] {
                continue;
            }
            for &(next, step_m) in &self.neighbours[node] {
                let through_m = length_m + step_m;
                if through_m < self.cost_to_go_m[next] {
                    self.cost_to_go_m[next] = through_m;
                    open.push(through_m, next);
                }
            }
        }
    }

    /// Nodes on the shortest path from `node` to the goal, both included.
    pub fn path_from(&self, node: usize) -> Vec<Point> {
        let mut path = vec![self.nodes[node]];
        let mut at = node;
        while at != 0 {
            let length_m = |&(next, step_m): &(usize, f64)| step_m + self.cost_to_go_m[next];
            let next = self.neighbours[at].iter().min_by(|a, b| length_m(a).total_cmp(&length_m(b)));
            match next {
                Some(&(next, _)) if self.cost_to_go_m[next] < self.cost_to_go_m[at] => at = next,
                _ => break,
            }
            path.push(self.nodes[at]);
        }
        path
    }
}
