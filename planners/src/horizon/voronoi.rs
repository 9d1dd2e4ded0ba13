//! The Voronoi graph: ways as far from the obstacles as possible, the frame counted as one of them.
//!
//! The boundaries are sampled; of the Voronoi diagram of the samples, the edges between samples of different owners run
//! along the middle between the owners (their nodes are the paper's Voronoi vertices). In space there is one diagram for
//! each altitude, of the obstacles that stand in the way there, and nodes above each other are connected.

use std::collections::BTreeMap;

use spade::handles::VoronoiVertex;
use spade::{DelaunayTriangulation, HasPosition, Point2, Triangulation};

use super::roadmap::Roadmap;
use crate::free_space::vector::{Point, distance};
use crate::free_space::{FreeSpace, Obstacle};

/// Distance between samples of a boundary, m.
const SPACING_M: f64 = 1.0;

/// Length of a way from or to the graph, m at most, where there is one so short.
pub const JOIN_M: f64 = 4.0;

/// Samples around a cylinder, at least.
const AROUND: usize = 12;

/// Vertices nearer to each other than this are one, m.
const SAME_M: f64 = 1e-6;

/// Owner of the frame's samples.
const FRAME: usize = usize::MAX;

/// A sample of a boundary.
#[derive(Clone, Copy, Debug)]
struct Site {
    position: Point2<f64>,
    owner: usize,
}

impl HasPosition for Site {
    type Scalar = f64;
    fn position(&self) -> Point2<f64> {
        self.position
    }
}

/// Builds the graph with its edges at least `clearance_m` from everything. Costs are not computed.
pub fn build(goal: Point, space: &FreeSpace, clearance_m: f64, levels_m: &[f64]) -> Roadmap {
    let mut roadmap = Roadmap::to(goal);
    let mut below = 1..1;
    for &z_m in levels_m {
        let from = roadmap.nodes().len();
        add_level(&mut roadmap, space, z_m, clearance_m);
        let level = from..roadmap.nodes().len();
        for upper in level.clone() {
            connect_to_nearest(&mut roadmap, upper, below.clone(), space, clearance_m);
        }
        below = level;
    }
    join_goal(&mut roadmap, space, clearance_m);
    roadmap
}

/// Connects the goal with the nodes within [`JOIN_M`] that it sees, or else with the nearest that it sees.
fn join_goal(roadmap: &mut Roadmap, space: &FreeSpace, clearance_m: f64) {
    let goal = roadmap.nodes()[0];
    let all = 1..roadmap.nodes().len();
    let is_near = |node: &usize| distance(goal, roadmap.nodes()[*node]) <= JOIN_M;
    let is_seen = |node: &usize| space.is_clear(goal, roadmap.nodes()[*node], clearance_m);
    let near: Vec<usize> = all.clone().filter(is_near).filter(is_seen).collect();
    if near.is_empty() {
        connect_to_nearest(roadmap, 0, all, space, clearance_m);
    }
    near.into_iter().for_each(|node| roadmap.connect(0, node));
}

fn add_level(roadmap: &mut Roadmap, space: &FreeSpace, z_m: f64, clearance_m: f64) {
    // samples in a fixed order, none twice: the same diagram every time
    let Ok(diagram) = DelaunayTriangulation::<Site>::bulk_load(sites(space, z_m, clearance_m)) else {
        return;
    };
    let mut nodes = BTreeMap::new();
    for edge in diagram.undirected_voronoi_edges() {
        let [a, b] = edge.as_delaunay_edge().vertices().map(|vertex| vertex.data().owner);
        let [VoronoiVertex::Inner(from), VoronoiVertex::Inner(to)] = edge.vertices() else { continue };
        let [p, q] = [from, to].map(|face| face.circumcenter()).map(|center| [center.x, center.y, z_m]);
        if a == b || !space.is_clear(p, q, clearance_m) {
            continue;
        }
        let [i, j] = [p, q].map(|node| *nodes.entry(place(node)).or_insert_with(|| roadmap.add_node(node)));
        if i != j {
            roadmap.connect(i, j);
        }
    }
}

/// Where four samples or more lie on one circle, several vertices of the diagram are one point.
fn place([x, y, _]: Point) -> [i64; 2] {
    [x, y].map(|coordinate| (coordinate / SAME_M).round() as i64)
}

/// Connects a node with the nearest of `others` that it sees.
fn connect_to_nearest(
    roadmap: &mut Roadmap,
    node: usize,
    others: std::ops::Range<usize>,
    space: &FreeSpace,
    clearance_m: f64,
) {
    let at = roadmap.nodes()[node];
    let seen = others.filter(|&other| space.is_clear(at, roadmap.nodes()[other], clearance_m));
    let length_m = |other: usize| distance(at, roadmap.nodes()[other]);
    if let Some(nearest) = seen.min_by(|&i, &j| length_m(i).total_cmp(&length_m(j))) {
        roadmap.connect(node, nearest);
    }
}

/// Samples of every boundary that matters at an altitude.
fn sites(space: &FreeSpace, z_m: f64, clearance_m: f64) -> Vec<Site> {
    let mut sites = Vec::new();
    let [[west, east], [south, north], _] = space.frame_m;
    let corners = [[west, south], [east, south], [east, north], [west, north]];
    for i in 0..4 {
        sample(corners[i], corners[(i + 1) % 4], FRAME, &mut sites);
    }
    for (owner, obstacle) in space.standing.iter().enumerate() {
        let [low_m, high_m] = obstacle.altitude_m();
        if (low_m - clearance_m..=high_m + clearance_m).contains(&z_m) {
            let outline = outline(obstacle);
            for (i, &corner) in outline.iter().enumerate() {
                sample(corner, outline[(i + 1) % outline.len()], owner, &mut sites);
            }
        }
    }
    let [x, y] = [[west, east], [south, north]];
    sites.retain(|site| (x[0]..=x[1]).contains(&site.position.x) && (y[0]..=y[1]).contains(&site.position.y));
    sites
}

fn outline(obstacle: &Obstacle) -> Vec<[f64; 2]> {
    if !obstacle.is_cylinder() {
        return obstacle.edges().iter().map(|edge| edge.corner).collect();
    }
    let ([x, y], radius_m) = obstacle.circle();
    let count = ((std::f64::consts::TAU * radius_m / SPACING_M).ceil() as usize).max(AROUND);
    let angle = |i: usize| std::f64::consts::TAU * i as f64 / count as f64;
    (0..count).map(|i| [x + radius_m * angle(i).cos(), y + radius_m * angle(i).sin()]).collect()
}

/// Samples from `from` (with it) to `to` (without it).
fn sample(from: [f64; 2], to: [f64; 2], owner: usize, sites: &mut Vec<Site>) {
    let count = ((to[0] - from[0]).hypot(to[1] - from[1]) / SPACING_M).ceil().max(1.0);
    for i in 0..count as usize {
        let share = i as f64 / count;
        let [x, y] = [0, 1].map(|axis| from[axis] + share * (to[axis] - from[axis]));
        sites.push(Site { position: Point2::new(x, y), owner });
    }
}
