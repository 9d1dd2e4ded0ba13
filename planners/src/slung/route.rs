//! Routes around the obstacles: shortest polylines in the plane, one per homotopy class.
//!
//! Dijkstra's algorithm on the visibility graph of the offset corners, augmented by a signature of the homotopy class
//! (Bhattacharya, Kumar, Likhachev 2010): a ray from each obstacle's centre, perpendicular to the line from start to
//! goal, contributes one bit, the parity of its crossings.

use std::cmp::Reverse;
use std::collections::BTreeMap;

use nalgebra::Vector2;

use super::polygon::Polygon;
use crate::open_list::OpenList;

/// Offset of the visibility graph's vertices beyond the required distance from the obstacles, as a fraction of it.
const VERTEX_MARGIN: f64 = 0.25;

/// Fraction of the required distance that the legs keep at least.
const MIN_LEG_CLEARANCE: f64 = 0.7;

/// Maximum number of obstacles that distinguish homotopy classes; the others are passed on the shorter side.
const MAX_SIGNATURE_BITS: usize = 6;

/// A vertex and a signature: the state of the search.
type Key = (usize, u32);

const START: usize = 0;
const GOAL: usize = 1;

/// A polyline from start to goal.
#[derive(Clone, Debug, PartialEq)]
pub struct Route {
    /// Corners, m, start and goal included.
    pub points_m: Vec<[f64; 2]>,
    /// Indices of the obstacles that distinguish routes, the nearest to the straight line first.
    pub obstacles: Vec<usize>,
    /// For each of them, whether the route passes it on the right, as seen along the straight line from start to goal.
    pub on_right: Vec<bool>,
}

impl Route {
    /// Length, m.
    pub fn length_m(&self) -> f64 {
        self.legs().map(|(a, b)| length(b - a)).sum()
    }

    /// The point at a fraction of the length, m.
    pub fn at(&self, fraction: f64) -> [f64; 2] {
        let mut remaining_m = fraction.clamp(0.0, 1.0) * self.length_m();
        for (a, b) in self.legs() {
            let leg = b - a;
            let length_m = length(leg);
            if remaining_m <= length_m && length_m > 0.0 {
                return [a.x + leg.x * remaining_m / length_m, a.y + leg.y * remaining_m / length_m];
            }
            remaining_m -= length_m;
        }
        self.points_m[self.points_m.len() - 1]
    }

    fn legs(&self) -> impl Iterator<Item = (Vector2<f64>, Vector2<f64>)> {
        self.points_m.windows(2).map(|leg| (leg[0].into(), leg[1].into()))
    }
}

/// The shortest route of each homotopy class, shortest first.
///
/// - `distance_m`: distance that the routes keep, approximately, from the obstacles
/// - `max_routes`: maximum number of routes
///
/// # Examples
///
/// ```
/// use planners::slung::{Polygon, routes};
///
/// let obstacle = Polygon::rectangle([0.0, 0.5], [1.0, 2.0], 0.0);
/// let routes = routes([-2.0, 0.0], [2.0, 0.0], &[obstacle], 0.3, 4);
/// assert_eq!(routes.len(), 2);
/// assert_eq!(routes[0].on_right, [true]);
/// ```
pub fn routes(
    start: [f64; 2],
    goal: [f64; 2],
    obstacles: &[Polygon],
    distance_m: f64,
    max_routes: usize,
) -> Vec<Route> {
    Graph::new(start.into(), goal.into(), obstacles, distance_m).search(max_routes)
}

/// The visibility graph.
struct Graph<'a> {
    /// Start, goal, and the offset corners.
    vertices: Vec<Vector2<f64>>,
    obstacles: &'a [Polygon],
    /// Distance that legs keep from each obstacle, m.
    clearances_m: Vec<f64>,
    rays: Vec<Ray>,
}

/// A ray from the centre of an obstacle.
struct Ray {
    obstacle: usize,
    from: Vector2<f64>,
    direction: Vector2<f64>,
}

/// An edge to another vertex.
struct Edge {
    to: usize,
    length_m: f64,
    signature: u32,
}

impl<'a> Graph<'a> {
    fn new(start: Vector2<f64>, goal: Vector2<f64>, obstacles: &'a [Polygon], distance_m: f64) -> Self {
        let mut vertices = vec![start, goal];
        for obstacle in obstacles {
            vertices.extend(obstacle.offset_corners((1.0 + VERTEX_MARGIN) * distance_m));
        }
        let ahead = goal - start;
        let right = Vector2::new(ahead.y, -ahead.x);
        let from_line = |index: usize| obstacles[index].distance_to_segment(start, goal);
        let mut by_distance: Vec<usize> = (0..obstacles.len()).collect();
        by_distance.sort_by(|&a, &b| from_line(a).total_cmp(&from_line(b)));
        let ray = |obstacle: usize| Ray { obstacle, from: obstacles[obstacle].center(), direction: right };
        let rays = by_distance.into_iter().take(MAX_SIGNATURE_BITS).map(ray).collect();
        // a start or goal closer than the required distance must still be reachable
        let ends = |obstacle: &Polygon| [start, goal].map(|point| obstacle.distance(point.into()).value);
        let clearance = |obstacle: &Polygon| ends(obstacle).into_iter().fold(distance_m, f64::min) * MIN_LEG_CLEARANCE;
        Self { vertices, obstacles, clearances_m: obstacles.iter().map(clearance).collect(), rays }
    }

    fn is_free(&self, a: Vector2<f64>, b: Vector2<f64>) -> bool {
        let mut obstacles = self.obstacles.iter().zip(&self.clearances_m);
        obstacles.all(|(obstacle, &clearance_m)| obstacle.distance_to_segment(a, b) > clearance_m)
    }

    /// One bit per ray: whether the leg crosses it.
    fn signature(&self, a: Vector2<f64>, b: Vector2<f64>) -> u32 {
        let crosses = |Ray { from, direction, .. }: &Ray| {
            let side = |point: Vector2<f64>| direction.perp(&(point - from)) > 0.0;
            // the leg meets the ray's line ahead of its origin
            let leg = b - a;
            let denominator = leg.perp(direction);
            side(a) != side(b) && leg.perp(&(from - a)) * -denominator.signum() > 0.0
        };
        self.rays.iter().enumerate().map(|(bit, ray)| u32::from(crosses(ray)) << bit).sum()
    }

    fn edges(&self) -> Vec<Vec<Edge>> {
        let count = self.vertices.len();
        let edge = |i: usize, to: usize| {
            let (a, b) = (self.vertices[i], self.vertices[to]);
            let is_edge = i != to && self.is_free(a, b);
            is_edge.then(|| Edge { to, length_m: length(b - a), signature: self.signature(a, b) })
        };
        (0..count).map(|i| (0..count).filter_map(|j| edge(i, j)).collect()).collect()
    }

    /// Dijkstra's algorithm over (vertex, signature); of equal lengths the larger key comes first.
    fn search(&self, max_routes: usize) -> Vec<Route> {
        let edges = self.edges();
        let start: Key = (START, 0);
        let mut queue = OpenList::new();
        queue.push(0.0, Reverse((start, start)));
        let mut predecessors: BTreeMap<Key, Key> = BTreeMap::new();
        let mut found = Vec::new();
        while let Some((length_m, Reverse((key, predecessor)))) = queue.pop() {
            if predecessors.contains_key(&key) {
                continue;
            }
            predecessors.insert(key, predecessor);
            let (vertex, signature) = key;
            if vertex == GOAL {
                found.push(self.route(&predecessors, signature));
                if found.len() == max_routes {
                    break;
                }
                continue;
            }
            for edge in &edges[vertex] {
                let next: Key = (edge.to, signature ^ edge.signature);
                queue.push(length_m + edge.length_m, Reverse((next, key)));
            }
        }
        found
    }

    fn route(&self, predecessors: &BTreeMap<Key, Key>, signature: u32) -> Route {
        let mut key = (GOAL, signature);
        let mut points_m = vec![self.vertices[GOAL].into()];
        while key.0 != START {
            key = predecessors[&key];
            points_m.push(self.vertices[key.0].into());
        }
        points_m.reverse();
        let obstacles = self.rays.iter().map(|ray| ray.obstacle).collect();
        Route { points_m, obstacles, on_right: (0..self.rays.len()).map(|bit| signature >> bit & 1 == 1).collect() }
    }
}

fn length(a: Vector2<f64>) -> f64 {
    a.x.hypot(a.y)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_obstacle_is_passed_on_both_sides() {
        let obstacle = Polygon::rectangle([0.0, 0.0], [3.0, 2.0], -std::f64::consts::FRAC_PI_4);
        let routes = routes([-2.0, 0.0], [2.0, 0.0], &[obstacle], 0.4, 4);
        assert_eq!(routes.len(), 2, "{routes:?}");
        let right = routes.iter().find(|route| route.on_right == [true]).expect("one on the right");
        let left = routes.iter().find(|route| route.on_right == [false]).expect("one on the left");
        assert!(
            right.points_m.iter().all(|point| point[1] <= 0.5) && left.points_m.iter().all(|point| point[1] >= -0.5)
        );
        assert!((right.length_m() - left.length_m()).abs() < 1e-9, "the case is symmetric about the origin");
    }

    #[test]
    fn two_obstacles_give_four_classes_and_free_space_one() {
        let obstacles = [-1.5, 1.5].map(|x| Polygon::rectangle([x, 0.0], [0.6, 1.0], 0.0));
        assert_eq!(routes([-4.0, 0.0], [4.0, 0.0], &obstacles, 0.3, 9).len(), 4);
        let straight = routes([-4.0, 0.0], [4.0, 0.0], &[], 0.3, 9);
        assert_eq!(straight.len(), 1);
        assert_eq!(straight[0].at(0.25), [-2.0, 0.0]);
    }
}
