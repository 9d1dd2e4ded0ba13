//! Visibility graph: nodes at the obstacles' corners, edges where the straight segment is clear (Bellingham, Richards,
//! How 2002).
//!
//! Corners are offset by the clearance, so that the edges along them keep it. In space the corners are repeated at several
//! altitudes, with additional nodes along the upper and lower rims: shortest paths in space bend at interior points of
//! edges, which a finite graph can only approximate.

use rayon::prelude::*;

use super::Roadmap;
use super::obstacle_grid::ObstacleGrid;
use super::shadows::Shadows;
use crate::free_space::outline::{offset_polygon, subdivided};
use crate::free_space::{FreeSpace, Obstacle, Point, segment_clear};

/// Distance by which nodes stand off beyond the clearance, so that rounding does not block edges along a wall, m.
const NODE_STANDOFF_M: f64 = 0.02;

/// Largest distance between nodes along a rim, m.
const MAX_RIM_SPACING_M: f64 = 3.0;

/// Extends the graph by the obstacles `space.static_obstacles[known..]`: removes the nodes and edges that they block, and
/// adds their corners. The result is that of building the graph anew. Costs are not updated.
pub fn extend(roadmap: &mut Roadmap, space: &FreeSpace, known: usize, clearance_m: f64, altitudes_m: &[f64]) {
    let added = &space.static_obstacles[known..];
    let grid = ObstacleGrid::new(space, clearance_m);
    roadmap.retain(
        |node| added.iter().all(|obstacle| obstacle.distance_m(node) >= clearance_m),
        |from, to| added.iter().all(|obstacle| segment_clear(obstacle, from, to, clearance_m)),
    );
    let nodes =
        added.iter().flat_map(|obstacle| nodes_around(obstacle, space, clearance_m + NODE_STANDOFF_M, altitudes_m));
    let first = roadmap.nodes().len();
    for node in nodes {
        if is_visible(node, node, space, &grid, clearance_m) {
            roadmap.add_node(node);
        }
    }
    let all = roadmap.nodes();
    let visible: Vec<Vec<usize>> = (first..all.len())
        .into_par_iter()
        .map(|index| visible_from(&all[..index], all[index], space, &grid, clearance_m))
        .collect();
    for (index, others) in (first..).zip(visible) {
        others.into_iter().for_each(|other| roadmap.connect(other, index));
    }
}

/// Indices of the nodes to which the segment from a point is clear.
///
/// - `grid`: of the obstacles, for the clearance
fn visible_from(nodes: &[Point], eye: Point, space: &FreeSpace, grid: &ObstacleGrid, clearance_m: f64) -> Vec<usize> {
    let shadows = Shadows::from_eye(eye, space.static_obstacles.iter(), clearance_m);
    let sees = |node: Point| !shadows.hides(node) && is_visible(node, eye, space, grid, clearance_m);
    (0..nodes.len()).filter(|&other| sees(nodes[other])).collect()
}

/// Does the segment from a node to a point within the bounds keep the clearance?
fn is_visible(node: Point, eye: Point, space: &FreeSpace, grid: &ObstacleGrid, clearance_m: f64) -> bool {
    space.distance_to_bounds_m(node) >= clearance_m && grid.occluder(space, node, eye, clearance_m).is_none()
}

/// Adds a node and connects it with all nodes that are visible from it.
pub(super) fn add_node(roadmap: &mut Roadmap, node: Point, space: &FreeSpace, clearance_m: f64) {
    let index = roadmap.add_node(node);
    for other in 0..index {
        if space.is_clear(roadmap.nodes()[other], node, clearance_m) {
            roadmap.connect(other, index);
        }
    }
}

fn nodes_around(obstacle: &Obstacle, space: &FreeSpace, offset_m: f64, altitudes_m: &[f64]) -> Vec<Point> {
    let corners = offset_polygon(obstacle, offset_m + obstacle.rounding_radius_m());
    let [low_m, high_m] = obstacle.altitude_m();
    let levels = altitudes_m.iter().copied().filter(|z_m| (low_m - offset_m..=high_m + offset_m).contains(z_m));
    let rims = [low_m - offset_m, high_m + offset_m].into_iter().filter(|z_m| z_m.is_finite());
    let at = |corners: &[[f64; 2]], z_m: f64| corners.iter().map(|&[x, y]| Point::new(x, y, z_m)).collect::<Vec<_>>();
    let [x_m, y_m, _] = space.bounds_m;
    let rim = subdivided(&corners, MAX_RIM_SPACING_M, [x_m, y_m]);
    levels.flat_map(|z_m| at(&corners, z_m)).chain(rims.flat_map(|z_m| at(&rim, z_m))).collect()
}
