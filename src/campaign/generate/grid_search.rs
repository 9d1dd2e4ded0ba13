//! Certificates: paths on a grid between obstacles.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use scenarios::{Range, World};

/// Cells with the nodes of a path at their centres. A node is free if every point of its cell keeps the clearance, so that
/// every point between two free neighbours does, too.
pub struct Grid {
    low_m: [f64; 3],
    step_m: f64,
    counts: [usize; 3],
    is_free: Vec<bool>,
}

/// An obstacle: its signed distance and the region outside which that is positive.
type Obstacle<'a> = (Box<dyn Fn([f64; 3]) -> f64 + 'a>, [Range; 3]);

impl Grid {
    /// The grid of a world's static obstacles, hidden or not, and of its bounds.
    ///
    /// - `level_m`: altitude of a level grid; `None`: a grid in space
    /// - `clearance_m`: distance that the path keeps from obstacles and bounds
    pub fn new(world: &World, level_m: Option<f64>, step_m: f64, clearance_m: f64) -> Self {
        let axes = world.map.axes();
        let level = |axis: usize| level_m.filter(|_| axis == 2);
        let counts = [0, 1, 2].map(|axis| match level(axis) {
            Some(_) => 1,
            None => ((axes[axis].max - axes[axis].min) / step_m).floor() as usize + 1,
        });
        let low_m = [0, 1, 2].map(|axis| level(axis).unwrap_or(axes[axis].min));
        let mut grid = Self { low_m, step_m, counts, is_free: vec![true; counts.iter().product()] };
        let needed_m = clearance_m + grid.half_diagonal_m();
        for node in 0..grid.is_free.len() {
            let position_m = grid.position_m(node);
            let is_inside = |(axis, range): (usize, &Range)| range.margin(position_m[axis]) >= needed_m;
            grid.is_free[node] = axes.iter().enumerate().all(is_inside);
        }
        obstacles(world).iter().for_each(|obstacle| grid.block(obstacle, needed_m));
        grid
    }

    /// Half of the diagonal of a cell, m.
    pub fn half_diagonal_m(&self) -> f64 {
        let axes = self.counts.iter().filter(|count| **count > 1).count();
        self.step_m / 2.0 * (axes as f64).sqrt()
    }

    /// Number of nodes.
    pub fn len(&self) -> usize {
        self.is_free.len()
    }

    /// Whether a node keeps the clearance.
    pub fn is_free(&self, node: usize) -> bool {
        self.is_free[node]
    }

    /// Position of a node, m.
    pub fn position_m(&self, node: usize) -> [f64; 3] {
        let index = self.index(node);
        std::array::from_fn(|axis| self.low_m[axis] + self.step_m * index[axis] as f64)
    }

    /// The node of the cell that holds a position on the map.
    pub fn nearest(&self, position_m: [f64; 3]) -> usize {
        let index: [usize; 3] = std::array::from_fn(|axis| {
            let cell = ((position_m[axis] - self.low_m[axis]) / self.step_m).round().max(0.0) as usize;
            cell.min(self.counts[axis] - 1)
        });
        self.node(index)
    }

    /// The up to 26 neighbours of a node and their distances in steps.
    pub fn neighbours(&self, node: usize) -> impl Iterator<Item = (usize, f64)> + '_ {
        let index = self.index(node);
        (0..27).filter(|&code| code != 13).filter_map(move |code| {
            let offset = [code % 3, code / 3 % 3, code / 9];
            let mut at = [0; 3];
            for axis in 0..3 {
                at[axis] = (index[axis] + offset[axis]).checked_sub(1).filter(|it| *it < self.counts[axis])?;
            }
            let moved = offset.iter().filter(|offset| **offset != 1).count();
            Some((self.node(at), (moved as f64).sqrt()))
        })
    }

    /// Length of the shortest path between two positions along free nodes, m; `None` if there is none. (A* search.)
    pub fn path_length_m(&self, from_m: [f64; 3], to_m: [f64; 3]) -> Option<f64> {
        let (start, goal) = (self.nearest(from_m), self.nearest(to_m));
        if !(self.is_free[start] && self.is_free[goal]) {
            return None;
        }
        let mut length_m = vec![f64::INFINITY; self.len()];
        length_m[start] = 0.0;
        let mut open = BinaryHeap::from([Reverse((Key(0.0), start))]);
        while let Some(Reverse((_, node))) = open.pop() {
            if node == goal {
                return Some(length_m[node]);
            }
            for (next, steps) in self.neighbours(node).filter(|(next, _)| self.is_free[*next]) {
                let through_m = length_m[node] + steps * self.step_m;
                if through_m < length_m[next] - 1e-9 {
                    length_m[next] = through_m;
                    open.push(Reverse((Key(through_m + self.distance_m(next, goal)), next)));
                }
            }
        }
        None
    }

    fn distance_m(&self, a: usize, b: usize) -> f64 {
        let (a, b) = (self.position_m(a), self.position_m(b));
        (0..3).map(|axis| (a[axis] - b[axis]).powi(2)).sum::<f64>().sqrt()
    }

    fn block(&mut self, (distance_m, region): &Obstacle<'_>, needed_m: f64) {
        let cells = |axis: usize| {
            let cell = |value_m: f64| ((value_m - self.low_m[axis]) / self.step_m).clamp(0.0, self.counts[axis] as f64);
            let (first, last) = (cell(region[axis].min - needed_m), cell(region[axis].max + needed_m));
            first.floor() as usize..(last.ceil() as usize + 1).min(self.counts[axis])
        };
        let [xs, ys, zs] = [cells(0), cells(1), cells(2)];
        for z in zs {
            for y in ys.clone() {
                for x in xs.clone() {
                    let node = self.node([x, y, z]);
                    self.is_free[node] &= distance_m(self.position_m(node)) >= needed_m;
                }
            }
        }
    }

    fn node(&self, [x, y, z]: [usize; 3]) -> usize {
        (z * self.counts[1] + y) * self.counts[0] + x
    }

    fn index(&self, node: usize) -> [usize; 3] {
        let [nx, ny, _] = self.counts;
        [node % nx, node / nx % ny, node / (nx * ny)]
    }
}

fn obstacles(world: &World) -> Vec<Obstacle<'_>> {
    const EVERYWHERE: Range = Range { min: -1e9, max: 1e9 };
    let around = |center_m: f64, radius_m: f64| Range::new(center_m - radius_m, center_m + radius_m);
    let cylinders = world.cylinders.iter().map(|it| {
        let [x, y] = it.center_m;
        let distance_m: Box<dyn Fn([f64; 3]) -> f64> = Box::new(move |[x_m, y_m, _]| it.signed_distance_m(x_m, y_m));
        (distance_m, [around(x, it.radius_m), around(y, it.radius_m), EVERYWHERE])
    });
    let prisms = world.prism_obstacles().into_iter().map(|it| {
        let axis = |axis: usize| {
            let values = it.corners_m.iter().map(|corner| corner[axis]);
            values.fold(Range { min: f64::INFINITY, max: f64::NEG_INFINITY }, |range, value| Range {
                min: range.min.min(value),
                max: range.max.max(value),
            })
        };
        let region = [axis(0), axis(1), it.z_m.unwrap_or(EVERYWHERE)];
        let distance_m: Box<dyn Fn([f64; 3]) -> f64> =
            Box::new(move |position_m| it.signed_distance_in_space_m(position_m));
        (distance_m, region)
    });
    cylinders.chain(prisms).collect()
}

/// A cost in the open list.
#[derive(Clone, Copy, PartialEq)]
struct Key(f64);

impl Eq for Key {}

impl Ord for Key {
    fn cmp(&self, other: &Self) -> std::cmp::Ordering {
        self.0.total_cmp(&other.0)
    }
}

impl PartialOrd for Key {
    fn partial_cmp(&self, other: &Self) -> Option<std::cmp::Ordering> {
        Some(self.cmp(other))
    }
}

#[cfg(test)]
mod tests {
    use scenarios::{BoxObstacle, Cylinder, Map, Range, World};

    use super::Grid;

    fn world() -> World {
        let side = Range::new(0.0, 10.0);
        World::empty(Map { x_m: side, y_m: side, z_m: Range::new(0.0, 4.0) })
    }

    /// A wall across the world with a gap of this width.
    fn with_gap(gap_m: f64) -> World {
        let half_m = (10.0 - gap_m) / 2.0;
        let wall = |name: &str, y_m: f64| BoxObstacle {
            name: name.into(),
            center_m: [5.0, y_m],
            size_m: [1.0, half_m],
            heading_deg: 0.0,
            z_m: None,
        };
        World { boxes: vec![wall("south", half_m / 2.0), wall("north", 10.0 - half_m / 2.0)], ..world() }
    }

    fn across(world: &World, level_m: Option<f64>) -> Option<f64> {
        Grid::new(world, level_m, 0.2, 0.5).path_length_m([1.0, 5.0, 2.0], [9.0, 5.0, 2.0])
    }

    #[test]
    fn a_gap_is_passed_only_if_it_is_wide_enough() {
        assert_eq!(across(&with_gap(0.9), Some(2.0)), None, "narrower than twice the clearance");
        assert!((across(&with_gap(1.8), Some(2.0)).unwrap() - 8.0).abs() < 1e-9);
    }

    #[test]
    fn a_path_leads_over_a_low_wall_only_in_space() {
        let mut world = with_gap(0.0);
        world.boxes.iter_mut().for_each(|wall| wall.z_m = Some(Range::new(0.0, 2.2)));
        assert_eq!(across(&world, Some(2.0)), None);
        assert!(across(&world, None).unwrap() > 8.1);
        world.boxes.iter_mut().for_each(|wall| wall.z_m = None);
        assert_eq!(across(&world, None), None);
    }

    #[test]
    fn free_nodes_keep_the_clearance() {
        let mut world = with_gap(3.0);
        world.cylinders.push(Cylinder { name: "tree".into(), center_m: [2.13, 6.4], radius_m: 0.7 });
        let grid = Grid::new(&world, Some(2.0), 0.3, 0.5);
        let prisms = world.prism_obstacles();
        for node in 0..grid.len() {
            let [x, y, z] = grid.position_m(node);
            let to_prisms = prisms.iter().map(|prism| prism.signed_distance_in_space_m([x, y, z]));
            let to_bounds = [world.map.x_m.margin(x), world.map.y_m.margin(y)];
            let distance_m = to_prisms
                .chain(to_bounds)
                .chain([world.cylinders[0].signed_distance_m(x, y)])
                .fold(f64::INFINITY, f64::min);
            assert_eq!(grid.is_free(node), distance_m >= 0.5 + grid.half_diagonal_m(), "({x}, {y})");
        }
    }
}
