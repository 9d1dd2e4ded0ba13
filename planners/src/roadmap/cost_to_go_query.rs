use super::{CostToGo, LinkLimits, Roadmap};
use crate::free_space::{FreeSpace, Point, segment_clear};

/// [`Roadmap::cost_to_go`] for thousands of points near one origin, with the same results.
#[derive(Clone, Debug)]
pub struct CostToGoQuery<'a> {
    space: &'a FreeSpace,
    limits: LinkLimits,
    origin: Point,
    /// Nodes that reach the goal, in the order of the path length from the origin; obstacles are ignored.
    nodes: Vec<Node>,
}

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
    /// Sorts the nodes by their path length from `origin`.
    pub fn new(roadmap: &Roadmap, space: &'a FreeSpace, limits: LinkLimits, origin: Point) -> Self {
        let all = roadmap.nodes().iter().zip(roadmap.cost_to_go_m()).enumerate();
        let reaching_goal = all.filter(|(_, (_, cost_to_go_m))| cost_to_go_m.is_finite());
        let node = |(index, (&position, &cost_to_go_m)): (usize, (&Point, &f64))| {
            let from_origin_m = (origin - position).norm() + cost_to_go_m;
            Node { index, position, cost_to_go_m, from_origin_m }
        };
        let mut nodes: Vec<Node> = reaching_goal.map(node).collect();
        nodes.sort_by(|a, b| a.from_origin_m.total_cmp(&b.from_origin_m));
        Self { space, limits, origin, nodes }
    }

    /// Cost-to-go of `point`; `None` if no link to a node is clear.
    pub fn cost_to_go(&self, point: Point, hints: &mut OccluderHints) -> Option<CostToGo> {
        hints.resize(self.nodes.len(), 0);
        if self.space.distance_to_bounds_m(point) < self.limits.clearance_m {
            return None;
        }
        let preferred = self.best_within(point, self.limits.preferred_length_m, hints);
        if preferred.is_some() || self.limits.preferred_length_m == f64::INFINITY {
            return preferred;
        }
        self.best_within(point, f64::INFINITY, hints)
    }

    fn best_within(&self, point: Point, max_link_m: f64, hints: &mut OccluderHints) -> Option<CostToGo> {
        let moved_m = (self.origin - point).norm();
        let mut best: Option<CostToGo> = None;
        for (node, hint) in self.nodes.iter().zip(hints) {
            let shortest_m = best.map_or(f64::INFINITY, |best| best.length_m);
            // triangle inequality: no later node can give a shorter path
            if node.from_origin_m - moved_m >= shortest_m {
                break;
            }
            let link_m = (point - node.position).norm();
            let length_m = link_m + node.cost_to_go_m;
            if link_m <= max_link_m && length_m < shortest_m && self.is_visible(point, node.position, hint) {
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
        match obstacles.iter().position(|obstacle| !segment_clear(obstacle, point, node, clearance_m)) {
            Some(occluder) => {
                *hint = occluder;
                false
            }
            None => true,
        }
    }
}
