use std::borrow::Cow;

use super::obstacle_grid::ObstacleGrid;
use super::{CostToGo, CostToGoQuery, LinkLimits, Roadmap, visibility, voronoi, voronoi_vertices};
use crate::free_space::{FreeSpace, Point};

/// How the roadmap is built.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RoadmapKind {
    /// Visibility graph (Bellingham, Richards, How 2002): shortest paths, which touch the obstacles' corners.
    Visibility,
    /// Voronoi graph: longer paths with maximum clearance.
    Voronoi,
    /// The paper's: a visibility graph over the Voronoi vertices of the obstacles' corners.
    VoronoiVertices,
}

/// The cost-to-go over the whole map, the terminal cost of a horizon (eq. 10): a roadmap to one goal that is kept up to
/// date with the known obstacles.
#[derive(Clone, Debug)]
pub struct CostMap {
    kind: RoadmapKind,
    roadmap: Roadmap,
    goal: Point,
    clearance_m: f64,
    /// Altitudes at which nodes are placed, m: one in the plane.
    node_altitudes_m: Vec<f64>,
    /// Number of obstacles that the roadmap takes into account.
    known_obstacles: usize,
    /// These obstacles, for links of the required clearance.
    grid: ObstacleGrid,
}

/// Rounding error by which the link from a point at exactly the clearance may fall short of it, m.
const CLEARANCE_TOLERANCE_M: f64 = 1e-9;

/// Number of nodes up to which the first link of a path may have any length, and its preferred maximum length beyond, m: on
/// large maps nearly all distant nodes are hidden, and to test them takes long.
const MAX_NODES: usize = 3000;
const LARGE_MAP_LINK_M: f64 = 15.0;

impl CostMap {
    /// The cost map of a world without obstacles. Nodes are placed at `node_altitudes_m`, at least one.
    pub fn new(kind: RoadmapKind, goal: Point, clearance_m: f64, node_altitudes_m: Vec<f64>) -> Self {
        let (roadmap, grid) = (Roadmap::with_goal(goal), ObstacleGrid::default());
        Self { kind, roadmap, goal, clearance_m, node_altitudes_m, known_obstacles: 0, grid }
    }

    /// Adds the static obstacles that were appended to `space` since the last update, and returns whether there are any.
    /// Obstacles are never removed.
    pub fn update(&mut self, space: &FreeSpace) -> bool {
        if space.static_obstacles.len() == self.known_obstacles {
            return false;
        }
        let altitudes_m = &self.node_altitudes_m;
        match self.kind {
            RoadmapKind::Visibility => {
                visibility::extend(&mut self.roadmap, space, self.known_obstacles, self.clearance_m, altitudes_m);
            }
            RoadmapKind::Voronoi => self.roadmap = voronoi::build(self.goal, space, self.clearance_m, altitudes_m),
            RoadmapKind::VoronoiVertices => {
                self.roadmap = voronoi_vertices::build(self.goal, space, self.clearance_m, altitudes_m);
            }
        }
        self.known_obstacles = space.static_obstacles.len();
        self.grid = ObstacleGrid::new(space, self.clearance_m);
        self.roadmap.update_costs();
        true
    }

    /// The roadmap.
    pub fn roadmap(&self) -> &Roadmap {
        &self.roadmap
    }

    /// Cost-to-go of `point`, which keeps the clearance; `None` if no node that reaches the goal is visible from it.
    pub fn cost_to_go(&self, point: Point, space: &FreeSpace) -> Option<CostToGo> {
        self.query_near(point, space).cost_to_go(point, &mut Vec::new())
    }

    /// The shortest path from `point` to the goal; empty if there is none.
    pub fn path_from(&self, point: Point, space: &FreeSpace) -> Vec<Point> {
        let rest = self.cost_to_go(point, space).map(|cost_to_go| self.roadmap.path_from(cost_to_go.node));
        rest.map_or_else(Vec::new, |rest| [point].into_iter().chain(rest).collect())
    }

    /// [`cost_to_go`](Self::cost_to_go), prepared for many points near `origin`.
    pub fn query_near<'a>(&'a self, origin: Point, space: &'a FreeSpace) -> CostToGoQuery<'a> {
        let is_present = space.static_obstacles.len() == self.known_obstacles;
        let grid =
            if is_present { Cow::Borrowed(&self.grid) } else { Cow::Owned(ObstacleGrid::new(space, self.clearance_m)) };
        CostToGoQuery::new(&self.roadmap, (space, grid), self.link_limits(), origin)
    }

    fn link_limits(&self) -> LinkLimits {
        let preferred_length_m = match self.kind {
            RoadmapKind::Visibility | RoadmapKind::VoronoiVertices if self.roadmap.nodes().len() <= MAX_NODES => {
                f64::INFINITY
            }
            RoadmapKind::Visibility | RoadmapKind::VoronoiVertices => LARGE_MAP_LINK_M,
            // a long link to a Voronoi edge may pass close to corners
            RoadmapKind::Voronoi => voronoi::PREFERRED_LINK_M,
        };
        LinkLimits { clearance_m: self.clearance_m - CLEARANCE_TOLERANCE_M, preferred_length_m }
    }
}
