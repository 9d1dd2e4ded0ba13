//! Visibility graph: nodes at the obstacles' corners, edges where the straight segment is clear (Bellingham, Richards,
//! How 2002).
//!
//! Corners are offset by the clearance, so that the edges along them keep it. In space the corners are repeated at several
//! altitudes, with additional nodes along the upper and lower rims: shortest paths in space bend at interior points of
//! edges, which a finite graph can only approximate.

use super::Roadmap;
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
    roadmap.retain(
        |node| added.iter().all(|obstacle| obstacle.distance_m(node) >= clearance_m),
        |from, to| added.iter().all(|obstacle| segment_clear(obstacle, from, to, clearance_m)),
    );
    for obstacle in added {
        for node in nodes_around(obstacle, space, clearance_m + NODE_STANDOFF_M, altitudes_m) {
            if space.is_clear(node, node, clearance_m) {
                add_node(roadmap, node, space, clearance_m);
            }
        }
    }
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
