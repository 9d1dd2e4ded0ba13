use crate::free_space::{FreeSpace, Point, segment_clear};

/// Width of a cell, m, and the largest number of cells along an axis: larger maps have larger cells.
const CELL_M: f64 = 2.0;
const MAX_CELLS: f64 = 256.0;

/// Rounding error of a segment's course through the grid, in cells.
const COURSE_TOLERANCE: f64 = 1e-9;

/// A uniform grid over the static obstacles of a space: which of them may come within a distance of a segment.
#[derive(Clone, Debug, Default)]
pub struct ObstacleGrid {
    /// South-west corner, m.
    origin_m: [f64; 2],
    cell_m: f64,
    /// Number of cells along x and y.
    counts: [usize; 2],
    /// Indices of the obstacles that come within the distance of a cell, row by row.
    cells: Vec<Vec<usize>>,
}

impl ObstacleGrid {
    /// The grid for distances of at most `distance_m` from the static obstacles of `space`.
    pub fn new(space: &FreeSpace, distance_m: f64) -> Self {
        let extents = space.static_obstacles.iter().map(|obstacle| {
            let (center, radius_m) = obstacle.bounding_circle();
            center.map(|coordinate| [coordinate - radius_m - distance_m, coordinate + radius_m + distance_m])
        });
        let extents: Vec<[[f64; 2]; 2]> = extents.collect();
        let range = |axis: usize| {
            let [low, high] = space.bounds_m[axis];
            let lowest = extents.iter().map(|extent| extent[axis][0]).fold(f64::INFINITY, f64::min);
            let highest = extents.iter().map(|extent| extent[axis][1]).fold(f64::NEG_INFINITY, f64::max);
            [lowest.max(low), highest.min(high)]
        };
        let ranges = [range(0), range(1)];
        let sides_m = ranges.map(|[low, high]| (high - low).max(0.0));
        if extents.is_empty() {
            return Self::default();
        }
        let cell_m = sides_m.into_iter().fold(CELL_M, |cell_m, side_m| cell_m.max(side_m / MAX_CELLS));
        let counts = sides_m.map(|side_m| (side_m / cell_m).floor() as usize + 1);
        let origin_m = ranges.map(|[low, _]| low);
        let mut grid = Self { origin_m, cell_m, counts, cells: vec![Vec::new(); counts[0] * counts[1]] };
        for (index, extent) in extents.iter().enumerate() {
            let [columns, rows] = [0, 1].map(|axis| grid.cells_along(axis, extent[axis]));
            for row in rows {
                columns.clone().for_each(|column| grid.cells[row * counts[0] + column].push(index));
            }
        }
        grid
    }

    /// The cells along an axis that an interval touches; none if it lies outside.
    fn cells_along(&self, axis: usize, [low, high]: [f64; 2]) -> std::ops::Range<usize> {
        let cell = |coordinate: f64| (coordinate - self.origin_m[axis]) / self.cell_m;
        let first = (cell(low) - COURSE_TOLERANCE).floor().max(0.0);
        let end = (cell(high) + COURSE_TOLERANCE).floor() + 1.0;
        first as usize..end.clamp(0.0, self.counts[axis] as f64) as usize
    }

    /// An obstacle of `space` to which the segment from `from` to `to` comes nearer than `clearance_m`, at most the distance of
    /// the grid; `None` if there is none.
    pub fn occluder(&self, space: &FreeSpace, from: Point, to: Point, clearance_m: f64) -> Option<usize> {
        let columns = self.cells_along(0, [from.x.min(to.x), from.x.max(to.x)]);
        let is_occluder = |&index: &usize| !segment_clear(&space.static_obstacles[index], from, to, clearance_m);
        columns.into_iter().find_map(|column| {
            let rows = self.cells_along(1, self.course_in_column(column, from, to));
            rows.into_iter()
                .find_map(|row| self.cells[row * self.counts[0] + column].iter().copied().find(|i| is_occluder(i)))
        })
    }

    /// Lowest and highest y of a segment within a column of cells, m.
    fn course_in_column(&self, column: usize, from: Point, to: Point) -> [f64; 2] {
        let along_m = to.x - from.x;
        let ends = [column as f64 - COURSE_TOLERANCE, (column + 1) as f64 + COURSE_TOLERANCE].map(|cell| {
            let x = self.origin_m[0] + cell * self.cell_m;
            let fraction = if along_m == 0.0 { f64::NAN } else { ((x - from.x) / along_m).clamp(0.0, 1.0) };
            from.y + fraction * (to.y - from.y)
        });
        if ends[0].is_nan() || ends[1].is_nan() {
            return [from.y.min(to.y), from.y.max(to.y)];
        }
        [ends[0].min(ends[1]), ends[0].max(ends[1])]
    }
}

#[cfg(test)]
mod tests {
    use rand::RngExt;

    use super::*;
    use crate::free_space::Obstacle;

    const UNBOUNDED: [f64; 2] = [f64::NEG_INFINITY, f64::INFINITY];

    /// Pillars and slanted walls, some of them far larger than the map; in every third space bounds are absent.
    fn random_space(seed: u64) -> FreeSpace {
        let mut stream = scenarios::stream(seed, "grid");
        let bounds_m = if seed.is_multiple_of(3) { UNBOUNDED } else { [0.0, 60.0] };
        let mut space = FreeSpace::empty([bounds_m, bounds_m, UNBOUNDED]);
        for _ in 0..60 {
            let mut draw = |from: f64, to: f64| stream.random_range(from..to);
            let center = [draw(-5.0, 65.0), draw(-5.0, 65.0)];
            space.static_obstacles.push(if draw(0.0, 1.0) < 0.8 {
                Obstacle::cylinder(center, draw(0.1, 2.0), UNBOUNDED)
            } else {
                let [x, y] = center;
                let (length_m, slant_m) = (draw(1.0, 40.0), draw(-9.0, 9.0));
                let corners = [[x, y], [x + length_m, y + slant_m], [x + length_m, y + slant_m + 0.5], [x, y + 0.5]];
                Obstacle::prism(&corners, UNBOUNDED)
            });
        }
        space
    }

    #[test]
    fn the_grid_finds_what_a_test_of_every_obstacle_finds() {
        let mut blocked = 0;
        for seed in 0..20 {
            let (space, clearance_m) = (random_space(seed), 0.4);
            let grid = ObstacleGrid::new(&space, clearance_m);
            let mut stream = scenarios::stream(seed, "segments");
            for kind in 0..500 {
                let mut point = || Point::new(stream.random_range(0.0..60.0), stream.random_range(0.0..60.0), 1.0);
                let (from, to) = (point(), point());
                let to = [to, Point::new(from.x, to.y, 1.0), Point::new(to.x, from.y, 1.0), from][kind % 4];
                let to = if kind % 5 == 0 { from + (to - from) * 0.1 } else { to };
                let occluder = grid.occluder(&space, from, to, clearance_m);
                let is_clear = space.static_obstacles.iter().all(|it| segment_clear(it, from, to, clearance_m));
                assert_eq!(occluder.is_none(), is_clear, "{from:?} {to:?}");
                assert!(occluder.is_none_or(|i| !segment_clear(&space.static_obstacles[i], from, to, clearance_m)));
                blocked += usize::from(!is_clear);
            }
        }
        assert!((2000..8000).contains(&blocked), "{blocked}");
    }

    #[test]
    fn nothing_occludes_in_an_empty_space() {
        let space = FreeSpace::empty([UNBOUNDED; 3]);
        let grid = ObstacleGrid::new(&space, 0.4);
        assert_eq!(grid.occluder(&space, Point::zeros(), Point::new(9.0, 1.0, 0.0), 0.4), None);
    }
}
