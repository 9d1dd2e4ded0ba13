//! What is left to the goal from anywhere, by the whole map: the charge on the end of a horizon (eq. 10).

use super::outlook::Outlook;
use super::roadmap::{CostToGo, Roadmap, Sight};
use super::{visibility, voronoi};
use crate::free_space::FreeSpace;
use crate::free_space::vector::Point;

/// Which graph the ways to the goal follow.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ways {
    /// Obstacles' corners (Bellingham, Richards, How 2002): short, hugging the corners.
    Visibility,
    /// As far from everything as possible: longer, with room on both sides.
    Voronoi,
}

/// A graph of ways to one goal, kept up to date with the map.
#[derive(Clone, Debug)]
pub struct CostMap {
    ways: Ways,
    roadmap: Roadmap,
    goal: Point,
    clearance_m: f64,
    /// Altitudes at which nodes are placed, m: one in the plane.
    levels_m: Vec<f64>,
    /// The obstacles that the graph knows.
    known: usize,
}

impl CostMap {
    /// Of a world without obstacles; nodes are placed at `levels_m`, at least one.
    pub fn new(ways: Ways, goal: Point, clearance_m: f64, levels_m: Vec<f64>) -> Self {
        Self { ways, roadmap: Roadmap::to(goal), goal, clearance_m, levels_m, known: 0 }
    }

    /// Takes in what has been added to `space.standing` since the last time. Obstacles do not go away again.
    pub fn update(&mut self, space: &FreeSpace) {
        if space.standing.len() == self.known {
            return;
        }
        match self.ways {
            Ways::Visibility => {
                visibility::extend(&mut self.roadmap, space, self.known, self.clearance_m, &self.levels_m);
            }
            Ways::Voronoi => self.roadmap = voronoi::build(self.goal, space, self.clearance_m, &self.levels_m),
        }
        self.known = space.standing.len();
        self.roadmap.update_costs();
    }

    /// The graph.
    pub fn roadmap(&self) -> &Roadmap {
        &self.roadmap
    }

    /// What is left from `point`, which keeps the clearance; nothing if it sees no node from which the goal is reached.
    pub fn cost_to_go(&self, point: Point, space: &FreeSpace) -> Option<CostToGo> {
        self.roadmap.cost_to_go(point, space, self.sight())
    }

    /// The way from `point` to the goal; nothing if there is none.
    pub fn route(&self, point: Point, space: &FreeSpace) -> Vec<Point> {
        let rest = self.cost_to_go(point, space).map(|left| self.roadmap.way_from(left.node));
        rest.map_or_else(Vec::new, |rest| [point].into_iter().chain(rest).collect())
    }

    /// The same for many points around `origin`.
    pub fn outlook<'a>(&self, space: &'a FreeSpace, origin: Point) -> Outlook<'a> {
        Outlook::new(&self.roadmap, space, self.sight(), origin)
    }

    /// Along the middle ways one gets by joining them soon: from far away, straight lines to them pass close to corners.
    fn sight(&self) -> Sight {
        let reach_m = match self.ways {
            Ways::Visibility => f64::INFINITY,
            Ways::Voronoi => voronoi::JOIN_M,
        };
        Sight { clearance_m: self.clearance_m - ROUNDING_M, reach_m }
    }
}

/// What a point that just keeps the clearance may seem to fall short of it, m.
const ROUNDING_M: f64 = 1e-9;
