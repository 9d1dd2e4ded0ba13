use std::borrow::Cow;
use std::sync::OnceLock;

use super::obstacle_grid::ObstacleGrid;
use super::{CostToGo, LinkLimits, Roadmap};
use crate::free_space::{FreeSpace, Point, segment_clear};

/// Cost-to-go of thousands of points near one origin: the length of the shortest path that begins with a clear link to a node
/// (eq. 10).
#[derive(Clone, Debug)]
pub struct CostToGoQuery<'a> {
    space: &'a FreeSpace,
    grid: Cow<'a, ObstacleGrid>,
    limits: LinkLimits,
    origin: Point,
    roadmap: &'a Roadmap,
    /// Nodes that points near the origin reach by links of the preferred length.
    near: Vec<Node>,
    /// All nodes, if they are needed.
    all: OnceLock<Vec<Node>>,
}

/// Distance from the origin within which points count as near, m.
const NEAR_M: f64 = 12.0;

/// A node that reaches the goal.
#[derive(Clone, Copy, Debug)]
struct Node {
    index: usize,
    position: Point,
    /// Length of the path from the node to the goal, m.
    cost_to_go_m: f64,
    /// Length of the path from the origin by this node to the goal, m.
    from_origin_m: f64,
}

/// For each node the obstacle that last occluded it, which is tested first. Hints change the run time only.
pub type OccluderHints = Vec<usize>;

impl<'a> CostToGoQuery<'a> {
    /// Sorts the nodes by their path length from `origin`. The grid is that of the space, for at least the clearance of the
    /// links.
    pub(super) fn new(
        roadmap: &'a Roadmap,
        (space, grid): (&'a FreeSpace, Cow<'a, ObstacleGrid>),
        limits: LinkLimits,
        origin: Point,
    ) -> Self {
        let near = nodes_by_length(roadmap, origin, limits.preferred_length_m + NEAR_M);
        Self { space, grid, limits, origin, roadmap, near, all: OnceLock::new() }
    }

    /// Cost-to-go of `point`; `None` if no link to a node is clear.
    pub fn cost_to_go(&self, point: Point, hints: &mut OccluderHints) -> Option<CostToGo> {
        hints.resize(self.roadmap.nodes().len(), 0);
        if self.space.distance_to_bounds_m(point) < self.limits.clearance_m {
            return None;
        }
        let preferred_m = self.limits.preferred_length_m;
        let has_no_others = preferred_m == f64::INFINITY;
        let all = || self.all.get_or_init(|| nodes_by_length(self.roadmap, self.origin, f64::INFINITY));
        let is_near = has_no_others || (point - self.origin).norm() <= NEAR_M;
        let preferred = self.best_within(point, preferred_m, if is_near { &self.near } else { all() }, hints);
        if preferred.is_some() || has_no_others {
            return preferred;
        }
        self.best_within(point, f64::INFINITY, all(), hints)
    }

    fn best_within(
        &self,
        point: Point,
        max_link_m: f64,
        nodes: &[Node],
        hints: &mut OccluderHints,
    ) -> Option<CostToGo> {
        let moved_m = (self.origin - point).norm();
        let mut best: Option<CostToGo> = None;
        for node in nodes {
            let shortest_m = best.map_or(f64::INFINITY, |best| best.length_m);
            // triangle inequality: no later node can give a shorter path
            if node.from_origin_m - moved_m >= shortest_m {
                break;
            }
            let link_m = (point - node.position).norm();
            let length_m = link_m + node.cost_to_go_m;
            if link_m <= max_link_m
                && length_m < shortest_m
                && self.is_visible(point, node.position, &mut hints[node.index])
            {
                best = Some(CostToGo { length_m, node: node.index });
            }
        }
        best
    }

    fn is_visible(&self, point: Point, node: Point, hint: &mut usize) -> bool {
        let obstacles = &self.space.static_obstacles;
        let clearance_m = self.limits.clearance_m;
        if obstacles.get(*hint).is_some_and(|obstacle| !segment_clear(obstacle, point, node, clearance_m)) {
            return false;
        }
        match self.grid.occluder(self.space, point, node, clearance_m) {
            Some(occluder) => {
                *hint = occluder;
                false
            }
            None => true,
        }
    }
}

/// Nodes that reach the goal and are at most `max_distance_m` from the origin, in the order of the path length from there;
/// obstacles are ignored.
fn nodes_by_length(roadmap: &Roadmap, origin: Point, max_distance_m: f64) -> Vec<Node> {
    let all = roadmap.nodes().iter().zip(roadmap.cost_to_go_m()).enumerate();
    let node = |(index, (&position, &cost_to_go_m)): (usize, (&Point, &f64))| {
        let distance_m = (origin - position).norm();
        let is_within = cost_to_go_m.is_finite() && distance_m <= max_distance_m;
        is_within.then_some(Node { index, position, cost_to_go_m, from_origin_m: distance_m + cost_to_go_m })
    };
    let mut nodes: Vec<Node> = all.filter_map(node).collect();
    nodes.sort_by(|a, b| a.from_origin_m.total_cmp(&b.from_origin_m));
    nodes
}
