//! Voronoi graph: paths with maximum clearance from the obstacles and the bounds.
//!
//! The boundaries are sampled. Of the Voronoi diagram of the samples, the edges between samples of different owners run
//! midway between the owners (their ends are the paper's Voronoi vertices). In space there is one diagram per altitude, of
//! the obstacles that block this altitude, and nearby nodes of neighbouring altitudes are connected.

use std::collections::BTreeMap;
use std::f64::consts::TAU;

use spade::handles::VoronoiVertex;
use spade::{DelaunayTriangulation, HasPosition, Point2, Triangulation};

use super::Roadmap;
use crate::free_space::outline::subdivided;
use crate::free_space::{FreeSpace, Obstacle, Point};

/// Largest distance between samples of a boundary, m.
const MAX_SAMPLE_SPACING_M: f64 = 1.0;

/// Preferred maximum length of a link between a point and the graph, m.
pub const PREFERRED_LINK_M: f64 = 4.0;

/// Smallest number of samples around a cylinder.
const MAX_CYLINDER_SAMPLES: usize = 10_000;
const MIN_CYLINDER_SAMPLES: usize = 12;

/// Grid width on which Voronoi vertices are identified with each other, m.
const VERTEX_MERGE_M: f64 = 1e-6;

/// Owner of the samples on the bounds.
const BOUNDS_OWNER: usize = usize::MAX;

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

/// Builds the graph, with all edges at least `clearance_m` from obstacles and bounds. Costs are not computed.
pub fn build(goal: Point, space: &FreeSpace, clearance_m: f64, altitudes_m: &[f64]) -> Roadmap {
    let mut roadmap = Roadmap::with_goal(goal);
    let mut below = 1..1;
    for &z_m in altitudes_m {
        let first = roadmap.nodes().len();
        add_level(&mut roadmap, space, z_m, clearance_m);
        let level = first..roadmap.nodes().len();
        for upper in level.clone() {
            connect_to_nearest(&mut roadmap, upper, below.clone(), space, clearance_m);
        }
        below = level;
    }
    connect_goal(&mut roadmap, space, clearance_m);
    roadmap
}

/// Connects the goal with all visible nodes within [`PREFERRED_LINK_M`], or with the nearest visible node if there are none.
fn connect_goal(roadmap: &mut Roadmap, space: &FreeSpace, clearance_m: f64) {
    let goal = roadmap.nodes()[0];
    let all = 1..roadmap.nodes().len();
    let is_near = |node: &usize| (goal - roadmap.nodes()[*node]).norm() <= PREFERRED_LINK_M;
    let is_visible = |node: &usize| space.is_clear(goal, roadmap.nodes()[*node], clearance_m);
    let near: Vec<usize> = all.clone().filter(is_near).filter(is_visible).collect();
    if near.is_empty() {
        connect_to_nearest(roadmap, 0, all, space, clearance_m);
    }
    near.into_iter().for_each(|node| roadmap.connect(0, node));
}

fn add_level(roadmap: &mut Roadmap, space: &FreeSpace, z_m: f64, clearance_m: f64) {
    let Ok(diagram) = DelaunayTriangulation::<Site>::bulk_load(sites(space, z_m, clearance_m)) else { return };
    let mut nodes = BTreeMap::new();
    for edge in diagram.undirected_voronoi_edges() {
        let [a, b] = edge.as_delaunay_edge().vertices().map(|vertex| vertex.data().owner);
        let [VoronoiVertex::Inner(from), VoronoiVertex::Inner(to)] = edge.vertices() else { continue };
        let [p, q] = [from, to].map(|face| face.circumcenter()).map(|center| Point::new(center.x, center.y, z_m));
        if a == b || !space.is_clear(p, q, clearance_m) {
            continue;
        }
        let [i, j] = [p, q].map(|node| *nodes.entry(merge_key(node)).or_insert_with(|| roadmap.add_node(node)));
        if i != j {
            roadmap.connect(i, j);
        }
    }
}

/// Key of a vertex in the plane. Four or more cocircular samples give several vertices at one point, which share a node.
fn merge_key(vertex: Point) -> [i64; 2] {
    [vertex.x, vertex.y].map(|coordinate| (coordinate / VERTEX_MERGE_M).round() as i64)
}

/// Connects a node with the nearest of `others` that is visible from it.
fn connect_to_nearest(
    roadmap: &mut Roadmap,
    node: usize,
    others: std::ops::Range<usize>,
    space: &FreeSpace,
    clearance_m: f64,
) {
    let position = roadmap.nodes()[node];
    let visible = others.filter(|&other| space.is_clear(position, roadmap.nodes()[other], clearance_m));
    let length_m = |other: usize| (position - roadmap.nodes()[other]).norm();
    if let Some(nearest) = visible.min_by(|&i, &j| length_m(i).total_cmp(&length_m(j))) {
        roadmap.connect(node, nearest);
    }
}

/// Samples of the boundaries that matter at an altitude, in a fixed order.
fn sites(space: &FreeSpace, z_m: f64, clearance_m: f64) -> Vec<Site> {
    let [[west, east], [south, north], _] = space.bounds_m;
    let mut sites = Vec::new();
    let mut add = |corners: &[[f64; 2]], owner: usize| {
        let samples = subdivided(corners, MAX_SAMPLE_SPACING_M, [[west, east], [south, north]]).into_iter();
        sites.extend(samples.map(|[x, y]| Site { position: Point2::new(x, y), owner }));
    };
    add(&[[west, south], [east, south], [east, north], [west, north]], BOUNDS_OWNER);
    for (owner, obstacle) in space.static_obstacles.iter().enumerate() {
        let [low_m, high_m] = obstacle.altitude_m();
        if (low_m - clearance_m..=high_m + clearance_m).contains(&z_m) {
            add(&boundary(obstacle), owner);
        }
    }
    sites.retain(|site| (west..=east).contains(&site.position.x) && (south..=north).contains(&site.position.y));
    sites
}

/// Corners of the obstacle's boundary; of a cylinder points on its circle.
pub(super) fn boundary(obstacle: &Obstacle) -> Vec<[f64; 2]> {
    if !obstacle.is_cylinder() {
        return obstacle.edges().iter().map(|edge| edge.corner).collect();
    }
    let ([x, y], radius_m) = obstacle.bounding_circle();
    let count = (TAU * radius_m / MAX_SAMPLE_SPACING_M).ceil() as usize;
    let count = count.clamp(MIN_CYLINDER_SAMPLES, MAX_CYLINDER_SAMPLES);
    let angle = |i: usize| TAU * i as f64 / count as f64;
    (0..count).map(|i| [x + radius_m * angle(i).cos(), y + radius_m * angle(i).sin()]).collect()
}
