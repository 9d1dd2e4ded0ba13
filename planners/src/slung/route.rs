//! Ways round the obstacles: shortest polylines in the plane, one for every choice of sides.
//!
//! Dijkstra's method on the visibility graph of the inflated corners, with the sides passed as part of the vertex
//! (Bhattacharya, Kumar, Likhachev 2010): a ray from each obstacle's middle, square to the line from start to goal, is
//! crossed or is not.

use std::cmp::Reverse;
use std::collections::{BTreeMap, BinaryHeap};

use super::polygon::Polygon;

/// Distance of the corners' turning points beyond what the obstacles demand, as a share of it.
const ROOM: f64 = 0.25;

/// Share of the demanded distance that the straight legs keep at least.
const LEG: f64 = 0.7;

/// So many obstacles at most tell routes apart; the others are gone round on the shorter side.
const MOST_SIDES: usize = 6;

/// A polyline from start to goal.
#[derive(Clone, Debug, PartialEq)]
pub struct Route {
    /// Its corners, m, start and goal included.
    pub points_m: Vec<[f64; 2]>,
    /// The obstacles that tell routes apart, by index, nearest to the straight line first.
    pub obstacles: Vec<usize>,
    /// For each of them, whether it is passed on the right, seen along the straight line from start to goal.
    pub on_right: Vec<bool>,
}

impl Route {
    /// Its length, m.
    pub fn length_m(&self) -> f64 {
        self.points_m.windows(2).map(|leg| length(minus(leg[1], leg[0]))).sum()
    }

    /// The point at a share of its length.
    pub fn at(&self, share: f64) -> [f64; 2] {
        let mut left = share.clamp(0.0, 1.0) * self.length_m();
        for leg in self.points_m.windows(2) {
            let along = minus(leg[1], leg[0]);
            let whole = length(along);
            if left <= whole && whole > 0.0 {
                return [leg[0][0] + along[0] * left / whole, leg[0][1] + along[1] * left / whole];
            }
            left -= whole;
        }
        self.points_m[self.points_m.len() - 1]
    }
}

/// The shortest routes, at most `most`, one per choice of sides, shortest first; they keep about `distance_m` from the
/// obstacles.
pub fn routes(start: [f64; 2], goal: [f64; 2], obstacles: &[Polygon], distance_m: f64, most: usize) -> Vec<Route> {
    let graph = Graph::new(start, goal, obstacles, distance_m);
    graph.search(most)
}

struct Graph<'a> {
    vertices: Vec<[f64; 2]>,
    obstacles: &'a [Polygon],
    /// Obstacles by index, and a ray from each.
    rays: Vec<(usize, [f64; 2], [f64; 2])>,
    clear_m: Vec<f64>,
}

impl<'a> Graph<'a> {
    fn new(start: [f64; 2], goal: [f64; 2], obstacles: &'a [Polygon], distance_m: f64) -> Self {
        let mut vertices = vec![start, goal];
        for obstacle in obstacles {
            vertices.extend(inflated(obstacle, (1.0 + ROOM) * distance_m));
        }
        let ahead = minus(goal, start);
        let right = [ahead[1], -ahead[0]];
        let nearness = |obstacle: &Polygon| distance_to_leg(obstacle, start, goal);
        let mut by_nearness: Vec<usize> = (0..obstacles.len()).collect();
        by_nearness.sort_by(|&a, &b| nearness(&obstacles[a]).total_cmp(&nearness(&obstacles[b])));
        let ray = |index: usize| (index, middle(&obstacles[index]), right);
        let rays = by_nearness.into_iter().take(MOST_SIDES).map(ray).collect();
        // a start close to an obstacle must still be able to leave it
        let ends = |obstacle: &Polygon| [start, goal].map(|point| obstacle.distance(point).value);
        let clear = |obstacle: &Polygon| ends(obstacle).into_iter().fold(distance_m, f64::min) * LEG;
        Self { vertices, obstacles, rays, clear_m: obstacles.iter().map(clear).collect() }
    }

    fn is_free(&self, a: [f64; 2], b: [f64; 2]) -> bool {
        self.obstacles.iter().zip(&self.clear_m).all(|(obstacle, &clear)| distance_to_leg(obstacle, a, b) > clear)
    }

    fn crossings(&self, a: [f64; 2], b: [f64; 2]) -> u32 {
        let crosses = |(_, from, along): &(usize, [f64; 2], [f64; 2])| {
            let side = |point: [f64; 2]| cross(*along, minus(point, *from)) > 0.0;
            // where the leg meets the ray's line, ahead of its beginning or behind
            let leg = minus(b, a);
            let denominator = cross(leg, *along);
            side(a) != side(b) && cross(leg, minus(*from, a)) * -denominator.signum() > 0.0
        };
        self.rays.iter().enumerate().map(|(bit, ray)| u32::from(crosses(ray)) << bit).sum()
    }

    fn search(&self, most: usize) -> Vec<Route> {
        let count = self.vertices.len();
        let mut edges = vec![Vec::new(); count];
        for (i, j) in (0..count).flat_map(|i| (0..count).map(move |j| (i, j))).filter(|(i, j)| i != j) {
            let (a, b) = (self.vertices[i], self.vertices[j]);
            if self.is_free(a, b) {
                edges[i].push((j, length(minus(b, a)), self.crossings(a, b)));
            }
        }
        let mut heap = BinaryHeap::from([(Reverse(Metres(0.0)), 0_usize, 0_u32, (0, 0))]);
        let mut before: BTreeMap<(usize, u32), (usize, u32)> = BTreeMap::new();
        let mut found = Vec::new();
        while let Some((Reverse(Metres(so_far)), vertex, sides, from)) = heap.pop() {
            if before.contains_key(&(vertex, sides)) {
                continue;
            }
            before.insert((vertex, sides), from);
            if vertex == 1 {
                found.push(self.route(&before, sides));
                if found.len() == most {
                    break;
                }
                continue;
            }
            for &(next, step, crossings) in &edges[vertex] {
                heap.push((Reverse(Metres(so_far + step)), next, sides ^ crossings, (vertex, sides)));
            }
        }
        found
    }

    fn route(&self, before: &BTreeMap<(usize, u32), (usize, u32)>, sides: u32) -> Route {
        let mut key = (1, sides);
        let mut points_m = vec![self.vertices[1]];
        while key.0 != 0 {
            key = before[&key];
            points_m.push(self.vertices[key.0]);
        }
        points_m.reverse();
        let obstacles = self.rays.iter().map(|ray| ray.0).collect();
        Route { points_m, obstacles, on_right: (0..self.rays.len()).map(|bit| sides >> bit & 1 == 1).collect() }
    }
}

/// A length with a total order.
#[derive(Clone, Copy, PartialEq)]
struct Metres(f64);
impl Eq for Metres {}
impl PartialOrd for Metres {
    fn partial_cmp(&self, other: &Self) -> Option<std::cmp::Ordering> {
        Some(self.cmp(other))
    }
}
impl Ord for Metres {
    fn cmp(&self, other: &Self) -> std::cmp::Ordering {
        self.0.total_cmp(&other.0)
    }
}

/// Corners of the polygon whose edges are `distance_m` further out.
fn inflated(polygon: &Polygon, distance_m: f64) -> Vec<[f64; 2]> {
    let corners = polygon.corners();
    let n = corners.len();
    let normal = |i: usize| {
        let along = minus(corners[(i + 1) % n], corners[i]);
        [along[1] / length(along), -along[0] / length(along)]
    };
    let corner = |i: usize| {
        let (a, b) = (normal((i + n - 1) % n), normal(i));
        let stretch = distance_m / (1.0 + a[0] * b[0] + a[1] * b[1]);
        [corners[i][0] + stretch * (a[0] + b[0]), corners[i][1] + stretch * (a[1] + b[1])]
    };
    (0..n).map(corner).collect()
}

/// Distance from a polygon to a leg, zero where they meet.
fn distance_to_leg(polygon: &Polygon, a: [f64; 2], b: [f64; 2]) -> f64 {
    let corners = polygon.corners();
    let n = corners.len();
    let (mut nearest, mut meets) = (f64::INFINITY, false);
    for i in 0..n {
        let (c, d) = (corners[i], corners[(i + 1) % n]);
        let apart = |p: [f64; 2], q: [f64; 2], r: [f64; 2], s: [f64; 2]| {
            cross(minus(q, p), minus(r, p)) * cross(minus(q, p), minus(s, p)) < 0.0
        };
        meets |= apart(a, b, c, d) && apart(c, d, a, b);
        nearest = nearest.min(point_to_leg(c, a, b));
    }
    let ends = polygon.distance(a).value.min(polygon.distance(b).value);
    if meets { 0.0 } else { nearest.min(ends).max(0.0) }
}

fn point_to_leg(point: [f64; 2], a: [f64; 2], b: [f64; 2]) -> f64 {
    let (leg, to_point) = (minus(b, a), minus(point, a));
    let share =
        (leg[0] * to_point[0] + leg[1] * to_point[1]) / (leg[0] * leg[0] + leg[1] * leg[1]).max(f64::MIN_POSITIVE);
    let share = share.clamp(0.0, 1.0);
    length(minus(to_point, [share * leg[0], share * leg[1]]))
}

fn middle(polygon: &Polygon) -> [f64; 2] {
    let count = polygon.corners().len() as f64;
    let sum = polygon.corners().iter().fold([0.0; 2], |sum, corner| [sum[0] + corner[0], sum[1] + corner[1]]);
    sum.map(|sum| sum / count)
}

fn minus(a: [f64; 2], b: [f64; 2]) -> [f64; 2] {
    [a[0] - b[0], a[1] - b[1]]
}

fn length(a: [f64; 2]) -> f64 {
    a[0].hypot(a[1])
}

fn cross(a: [f64; 2], b: [f64; 2]) -> f64 {
    a[0] * b[1] - a[1] * b[0]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn both_ways_round_one_obstacle_are_found() {
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
    fn two_obstacles_give_four_ways_and_free_space_one() {
        let obstacles = [-1.5, 1.5].map(|x| Polygon::rectangle([x, 0.0], [0.6, 1.0], 0.0));
        assert_eq!(routes([-4.0, 0.0], [4.0, 0.0], &obstacles, 0.3, 9).len(), 4);
        let straight = routes([-4.0, 0.0], [4.0, 0.0], &[], 0.3, 9);
        assert_eq!(straight.len(), 1);
        assert_eq!(straight[0].at(0.25), [-2.0, 0.0]);
    }
}
