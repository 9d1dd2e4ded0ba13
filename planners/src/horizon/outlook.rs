//! The cost map as seen from one vehicle: the same answers as [`Roadmap::cost_to_go`], for thousands of points nearby.

use super::roadmap::{CostToGo, Roadmap, Sight};
use crate::free_space::vector::{Point, distance};
use crate::free_space::{FreeSpace, is_beside};

/// Nodes in the order of the way from the vehicle by them to the goal, as if all were seen.
#[derive(Clone, Debug)]
pub struct Outlook<'a> {
    space: &'a FreeSpace,
    sight: Sight,
    origin: Point,
    nodes: Vec<Node>,
}

#[derive(Clone, Copy, Debug)]
struct Node {
    index: usize,
    at: Point,
    /// Way from the node to the goal, m.
    left_m: f64,
    /// Way from the vehicle to the goal by the node, m.
    from_origin_m: f64,
}

/// For each node the obstacle that hid it the last time: it is asked first. Changes how long an answer takes, not the
/// answer.
pub type Hints = Vec<usize>;

impl<'a> Outlook<'a> {
    /// From `origin`.
    pub fn new(roadmap: &Roadmap, space: &'a FreeSpace, sight: Sight, origin: Point) -> Self {
        let all = roadmap.nodes().iter().zip(roadmap.cost_to_go_m()).enumerate();
        let reached = all.filter(|(_, (_, left_m))| left_m.is_finite());
        let mut nodes: Vec<Node> = reached
            .map(|(index, (&at, &left_m))| Node { index, at, left_m, from_origin_m: distance(origin, at) + left_m })
            .collect();
        nodes.sort_by(|a, b| a.from_origin_m.total_cmp(&b.from_origin_m));
        Self { space, sight, origin, nodes }
    }

    /// What is left from `point` by the best node that it sees; nothing if it sees none.
    pub fn cost_to_go(&self, point: Point, hints: &mut Hints) -> Option<CostToGo> {
        hints.resize(self.nodes.len(), 0);
        if self.space.distance_to_frame_m(point) < self.sight.clearance_m {
            return None;
        }
        let near = self.best_within(point, self.sight.reach_m, hints);
        if near.is_some() || self.sight.reach_m == f64::INFINITY {
            return near;
        }
        self.best_within(point, f64::INFINITY, hints)
    }

    fn best_within(&self, point: Point, reach_m: f64, hints: &mut Hints) -> Option<CostToGo> {
        let moved_m = distance(self.origin, point);
        let mut best: Option<CostToGo> = None;
        for (node, hint) in self.nodes.iter().zip(hints) {
            let shortest_m = best.map_or(f64::INFINITY, |best| best.length_m);
            // triangle inequality: no later node can be nearer
            if node.from_origin_m - moved_m >= shortest_m {
                break;
            }
            let away_m = distance(point, node.at);
            let length_m = away_m + node.left_m;
            if away_m <= reach_m && length_m < shortest_m && self.is_seen(point, node.at, hint) {
                best = Some(CostToGo { length_m, node: node.index });
            }
        }
        best
    }

    fn is_seen(&self, point: Point, node: Point, hint: &mut usize) -> bool {
        let standing = &self.space.standing;
        if standing.get(*hint).is_some_and(|obstacle| !is_beside(obstacle, point, node, self.sight.clearance_m)) {
            return false;
        }
        match standing.iter().position(|obstacle| !is_beside(obstacle, point, node, self.sight.clearance_m)) {
            Some(hidden_by) => {
                *hint = hidden_by;
                false
            }
            None => true,
        }
    }
}
