//! The paper's Voronoi map: the sites are the vertices of the obstacles, of which the frame is one. The nodes are the Voronoi
//! vertices, each as far from three sites as from any; the edges are those of a visibility graph over the nodes. The number
//! of nodes grows linearly with that of the sites (the paper's theorem 1): at most 2 n - 5 of n sites.
//!
//! Distances are to corners, not to walls, so that a node may be close to the middle of a long wall, and an edge may pass
//! close to a corner: both keep the clearance and no more. In space there is one diagram per altitude.

use spade::{DelaunayTriangulation, Point2, Triangulation};

use super::{Roadmap, visibility, voronoi};
use crate::free_space::{FreeSpace, Point};

/// Builds the graph, with all nodes and edges at least `clearance_m` from obstacles and bounds. Costs are not computed.
pub fn build(goal: Point, space: &FreeSpace, clearance_m: f64, altitudes_m: &[f64]) -> Roadmap {
    let mut roadmap = Roadmap::with_goal(goal);
    for &z_m in altitudes_m {
        for node in vertices(space, z_m, clearance_m) {
            if space.is_clear(node, node, clearance_m) && !roadmap.nodes().contains(&node) {
                visibility::add_node(&mut roadmap, node, space, clearance_m);
            }
        }
    }
    roadmap
}

/// The Voronoi vertices at an altitude.
fn vertices(space: &FreeSpace, z_m: f64, clearance_m: f64) -> Vec<Point> {
    let Ok(diagram) = DelaunayTriangulation::<Point2<f64>>::bulk_load(sites(space, z_m, clearance_m)) else {
        return Vec::new();
    };
    let center = |face: spade::handles::FaceHandle<'_, spade::handles::InnerTag, Point2<f64>, (), (), ()>| {
        let center = face.circumcenter();
        Point::new(center.x, center.y, z_m)
    };
    diagram.inner_faces().map(center).collect()
}

/// Corners of the frame and of the obstacles that block an altitude, in a fixed order.
fn sites(space: &FreeSpace, z_m: f64, clearance_m: f64) -> Vec<Point2<f64>> {
    let [[west, east], [south, north], _] = space.bounds_m;
    let mut corners = vec![[west, south], [east, south], [east, north], [west, north]];
    for obstacle in &space.static_obstacles {
        let [low_m, high_m] = obstacle.altitude_m();
        if (low_m - clearance_m..=high_m + clearance_m).contains(&z_m) {
            corners.extend(voronoi::boundary(obstacle));
        }
    }
    corners.retain(|[x, y]| (west..=east).contains(x) && (south..=north).contains(y));
    corners.into_iter().map(|[x, y]| Point2::new(x, y)).collect()
}
