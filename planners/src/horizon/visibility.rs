//! The visibility graph: obstacles' corners, and edges where the straight way is free (Bellingham, Richards, How 2002).
//!
//! Corners are moved outwards by the clearance, so that the ways past them keep it. In space the corners stand at several
//! altitudes, and along the upper and lower rims there are nodes between the corners too: shortest ways in space bend at
//! points inside edges, which no finite graph has all of.

use std::f64::consts::{FRAC_PI_2, TAU};

use super::roadmap::Roadmap;
use crate::free_space::vector::Point;
use crate::free_space::{FreeSpace, Obstacle, is_beside};

/// Nodes stand off by this much more than the clearance, m, so that rounding blocks no way along a wall.
const STAND_OFF_M: f64 = 0.02;

/// Nodes around a cylinder.
const AROUND: usize = 8;

/// Largest distance between nodes along a rim, m.
const RIM_STEP_M: f64 = 3.0;

/// Extends the graph by the obstacles of `space.standing` from index `known` on: ways that they block go, and their own
/// corners are added. The result is that of building the graph anew. Costs are not updated.
pub fn extend(roadmap: &mut Roadmap, space: &FreeSpace, known: usize, clearance_m: f64, levels_m: &[f64]) {
    let added = &space.standing[known..];
    roadmap.retain(
        |node| added.iter().all(|obstacle| obstacle.distance_m(node) >= clearance_m),
        |from, to| added.iter().all(|obstacle| is_beside(obstacle, from, to, clearance_m)),
    );
    for obstacle in added {
        for node in nodes_around(obstacle, clearance_m + STAND_OFF_M, levels_m) {
            if space.is_clear(node, node, clearance_m) {
                add(roadmap, node, space, clearance_m);
            }
        }
    }
}

/// Adds a node and connects it with all that it sees.
fn add(roadmap: &mut Roadmap, node: Point, space: &FreeSpace, clearance_m: f64) {
    let index = roadmap.add_node(node);
    for other in 0..index {
        if space.is_clear(roadmap.nodes()[other], node, clearance_m) {
            roadmap.connect(other, index);
        }
    }
}

fn nodes_around(obstacle: &Obstacle, off_m: f64, levels_m: &[f64]) -> Vec<Point> {
    let outline = outline(obstacle, off_m + obstacle.round_m());
    let [low_m, high_m] = obstacle.altitude_m();
    let beside = levels_m.iter().copied().filter(|z_m| (low_m - off_m..=high_m + off_m).contains(z_m));
    let rims = [low_m - off_m, high_m + off_m].into_iter().filter(|z_m| z_m.is_finite());
    let at = |corners: &[[f64; 2]], z_m: f64| corners.iter().map(|&[x, y]| [x, y, z_m]).collect::<Vec<_>>();
    let rim = with_points_between(&outline);
    beside.flat_map(|z_m| at(&outline, z_m)).chain(rims.flat_map(|z_m| at(&rim, z_m))).collect()
}

/// Corners of a polygon around the obstacle whose edges keep `off_m` from its polygon: one for a turn of a quarter or less.
fn outline(obstacle: &Obstacle, off_m: f64) -> Vec<[f64; 2]> {
    let edges = obstacle.edges();
    let mut corners = Vec::new();
    for (i, edge) in edges.iter().enumerate() {
        let before = edges[(i + edges.len() - 1) % edges.len()].normal;
        let first = before[1].atan2(before[0]);
        let turn = if obstacle.is_cylinder() { TAU } else { turn(before, edge.normal) };
        let pieces = if obstacle.is_cylinder() { AROUND } else { (turn / FRAC_PI_2 - 1e-9).ceil().max(1.0) as usize };
        let half = 0.5 * turn / pieces as f64;
        for piece in 0..pieces {
            let angle = first + half * (2 * piece + 1) as f64;
            let reach = off_m / half.cos();
            corners.push([edge.corner[0] + reach * angle.cos(), edge.corner[1] + reach * angle.sin()]);
        }
    }
    corners
}

/// Angle from a to b counterclockwise, rad, in [0, π] for a convex corner.
fn turn(a: [f64; 2], b: [f64; 2]) -> f64 {
    (a[0] * b[1] - a[1] * b[0]).atan2(a[0] * b[0] + a[1] * b[1])
}

fn with_points_between(corners: &[[f64; 2]]) -> Vec<[f64; 2]> {
    let mut points = Vec::new();
    for (i, &from) in corners.iter().enumerate() {
        let to = corners[(i + 1) % corners.len()];
        let pieces = ((to[0] - from[0]).hypot(to[1] - from[1]) / RIM_STEP_M).ceil().max(1.0);
        for piece in 0..pieces as usize {
            let share = piece as f64 / pieces;
            points.push([0, 1].map(|axis| from[axis] + share * (to[axis] - from[axis])));
        }
    }
    points
}
