mod height_range;

use super::NearestPoint;
use super::round::{difference, norm};
use super::surface::nearest_of_triangle;

/// Ground of varying height: heights at the corners of a square grid, two triangles to a cell, divided from its south-west
/// corner to its north-east corner.
///
/// parry's height field finds the nearest point by growing a box, which visits every cell below a high aircraft; here a pyramid
/// of the lowest and highest points of blocks of cells is descended instead.
#[derive(Clone, Debug)]
pub struct TerrainGrid {
    /// The south-west corner, (x, y) in m.
    origin_m: [f64; 2],
    cell_m: f64,
    /// Number of corners along x and y, each at least 2.
    size: [usize; 2],
    /// Heights from west to east, row by row from the south, m; NaN where there are no data.
    heights_m: Vec<f64>,
    /// The lowest and highest point of blocks of 1, 2, 4 ... cells along each axis.
    levels: Vec<Level>,
    /// Largest slope of a triangle, height per distance.
    steepest: f64,
    has_gaps: bool,
}

/// Blocks of cells.
#[derive(Clone, Debug)]
struct Level {
    /// Number of blocks along x and y.
    size: [usize; 2],
    /// Lowest and highest point, m; infinite and reversed without data.
    ranges_m: Vec<[f64; 2]>,
}

/// A block of the pyramid.
#[derive(Clone, Copy)]
struct Block {
    level: usize,
    at: [usize; 2],
}

impl TerrainGrid {
    /// - `origin_m`: the south-west corner, (x, y)
    /// - `heights_m`: from west to east, row by row from the south, `size[0] * size[1]` of them
    ///
    /// # Panics
    ///
    /// Panics if there are fewer than two rows or columns, or not as many heights.
    pub fn new(origin_m: [f64; 2], cell_m: f64, size: [usize; 2], heights_m: Vec<f64>) -> Self {
        assert!(size[0] >= 2 && size[1] >= 2 && size[0] * size[1] == heights_m.len(), "one height for each corner");
        let has_gaps = heights_m.iter().any(|height_m| height_m.is_nan());
        let mut grid = Self { origin_m, cell_m, size, heights_m, levels: Vec::new(), steepest: 0.0, has_gaps };
        grid.steepest = grid.largest_slope();
        let mut level = grid.cells();
        while level.size != [1, 1] {
            let coarser = level.halved();
            grid.levels.push(std::mem::replace(&mut level, coarser));
        }
        grid.levels.push(level);
        grid
    }

    /// Number of corners along x and y.
    pub fn size(&self) -> [usize; 2] {
        self.size
    }

    /// West and east, then south and north limit, m.
    pub fn extent_m(&self) -> [[f64; 2]; 2] {
        std::array::from_fn(|axis| {
            [self.origin_m[axis], self.origin_m[axis] + self.cell_m * (self.size[axis] - 1) as f64]
        })
    }

    /// The highest point, m.
    pub fn highest_m(&self) -> f64 {
        self.levels.last().map_or(f64::NAN, |top| top.ranges_m[0][1])
    }

    /// Height at a place, m; `None` outside the grid, NaN where there are no data.
    pub fn height_m(&self, x_m: f64, y_m: f64) -> Option<f64> {
        let [[west_m, east_m], [south_m, north_m]] = self.extent_m();
        if !((west_m..=east_m).contains(&x_m) && (south_m..=north_m).contains(&y_m)) {
            return None;
        }
        let along = |axis: usize, value_m: f64| {
            let cells = (value_m - self.origin_m[axis]) / self.cell_m;
            let cell = (cells as usize).min(self.size[axis] - 2);
            (cell, cells - cell as f64)
        };
        let ((i, u), (j, v)) = (along(0, x_m), along(1, y_m));
        Some(self.height_in_cell_m([i, j], [u, v]))
    }

    /// Height at a fraction of a cell from its west and south side, m.
    fn height_in_cell_m(&self, [i, j]: [usize; 2], [u, v]: [f64; 2]) -> f64 {
        let [[sw, se], [nw, ne]] = [0, 1].map(|north| [0, 1].map(|east| self.corner_m(i + east, j + north)[2]));
        if u >= v { sw + u * (se - sw) + v * (ne - se) } else { sw + v * (nw - sw) + u * (ne - nw) }
    }

    /// The largest slope, height per distance.
    pub fn steepest(&self) -> f64 {
        self.steepest
    }

    /// The place of a corner without data inside a rectangle, or next to it, m; `None` if there is none.
    pub fn gap_m(&self, x_m: [f64; 2], y_m: [f64; 2]) -> Option<[f64; 2]> {
        let is_near =
            |value_m: f64, [min_m, max_m]: [f64; 2]| value_m > min_m - self.cell_m && value_m < max_m + self.cell_m;
        let corners = (0..self.size[1]).flat_map(|j| (0..self.size[0]).map(move |i| (i, j)));
        let missing = corners.map(|(i, j)| self.corner_m(i, j)).filter(|corner| corner[2].is_nan());
        missing.map(|[x, y, _]| [x, y]).find(|[x, y]| is_near(*x, x_m) && is_near(*y, y_m))
    }

    /// The nearest point of the surface. Below the surface the distance is negative.
    pub(super) fn nearest(&self, point_m: [f64; 3]) -> NearestPoint {
        let mut best = NearestPoint { signed_distance_m: f64::INFINITY, point_m };
        self.descend(Block { level: self.levels.len() - 1, at: [0, 0] }, point_m, &mut best);
        let is_below = self.height_m(point_m[0], point_m[1]).is_some_and(|height_m| point_m[2] < height_m);
        let distance_m = best.signed_distance_m;
        NearestPoint { signed_distance_m: if is_below { -distance_m } else { distance_m }, ..best }
    }

    /// Triangles for drawing, m; of a coarser grid if there are more than `max_count`.
    pub(super) fn triangles(&self, max_count: usize) -> Vec<[[f64; 3]; 3]> {
        let cells = |step: usize| self.size.map(|corners| (corners - 1).div_ceil(step));
        let count = |step: usize| 2 * cells(step)[0] * cells(step)[1];
        let step = (1..).find(|step| count(*step) <= max_count || cells(*step) == [1, 1]).unwrap_or(1);
        let corner =
            |i: usize, j: usize| self.corner_m((i * step).min(self.size[0] - 1), (j * step).min(self.size[1] - 1));
        let [columns, rows] = cells(step);
        let cell = |(i, j): (usize, usize)| {
            let [sw, se, nw, ne] = [corner(i, j), corner(i + 1, j), corner(i, j + 1), corner(i + 1, j + 1)];
            [[sw, se, ne], [sw, ne, nw]]
        };
        let all = (0..rows).flat_map(|j| (0..columns).map(move |i| (i, j))).flat_map(cell);
        all.filter(|triangle| triangle.iter().all(|corner| corner[2].is_finite())).collect()
    }

    /// The triangles above and below a square around a point, m.
    pub(super) fn triangles_in_box(&self, point_m: [f64; 3], half_m: f64) -> Vec<[[f64; 3]; 3]> {
        let cells = |axis: usize| {
            let cell = |at_m: f64| ((at_m - self.origin_m[axis]) / self.cell_m).floor().max(0.0) as usize;
            let last = self.size[axis] - 2;
            cell(point_m[axis] - half_m).min(last)..=cell(point_m[axis] + half_m).min(last)
        };
        let all = cells(1).flat_map(|j| cells(0).map(move |i| (i, j)));
        let triangles = all.flat_map(|(i, j)| {
            let [sw, se, nw, ne] = [(i, j), (i + 1, j), (i, j + 1), (i + 1, j + 1)].map(|(i, j)| self.corner_m(i, j));
            [[sw, se, ne], [sw, ne, nw]]
        });
        triangles.filter(|triangle| triangle.iter().all(|corner| corner[2].is_finite())).collect()
    }

    /// Boxes from below the lowest point up to the highest one of each block of cells, for no more than `max_blocks` blocks along
    /// an axis.
    pub fn block_boxes(&self, max_blocks: usize) -> Vec<[[f64; 3]; 2]> {
        let index = self.levels.iter().position(|level| level.size.iter().all(|blocks| *blocks <= max_blocks));
        let index = index.unwrap_or(self.levels.len() - 1);
        let level = &self.levels[index];
        let lowest_m = self.levels[self.levels.len() - 1].ranges_m[0][0] - self.cell_m;
        let block = |at: [usize; 2]| {
            let [low, high] = [at, at.map(|it| it + 1)].map(|it| it.map(|blocks| blocks << index));
            let [[west, south], [east, north]] = [low, [0, 1].map(|axis| high[axis].min(self.size[axis] - 1))];
            let [low_m, high_m] = [self.corner_m(west, south), self.corner_m(east, north)];
            let [_, top_m] = level.ranges_m[at[1] * level.size[0] + at[0]];
            [[low_m[0], low_m[1], lowest_m], [high_m[0], high_m[1], top_m]]
        };
        let all = (0..level.size[1]).flat_map(|j| (0..level.size[0]).map(move |i| [i, j]));
        all.map(block).filter(|[low_m, high_m]| high_m[2] > low_m[2]).collect()
    }

    fn corner_m(&self, i: usize, j: usize) -> [f64; 3] {
        let place_m = |axis: usize, index: usize| self.origin_m[axis] + self.cell_m * index as f64;
        [place_m(0, i), place_m(1, j), self.heights_m[j * self.size[0] + i]]
    }

    /// The finest level: one block for each cell. A cell with a corner without data has no triangles.
    fn cells(&self) -> Level {
        let [columns, rows] = self.size.map(|corners| corners - 1);
        let range_m = |(i, j): (usize, usize)| {
            let corners_m = [(i, j), (i + 1, j), (i, j + 1), (i + 1, j + 1)].map(|(i, j)| self.corner_m(i, j)[2]);
            hull_m(corners_m.map(|height_m| [height_m, height_m]))
        };
        let all = (0..rows).flat_map(|j| (0..columns).map(move |i| (i, j)));
        Level { size: [columns, rows], ranges_m: all.map(range_m).collect() }
    }

    /// Looks for a nearer point in a block, nearer parts first.
    fn descend(&self, block: Block, point_m: [f64; 3], best: &mut NearestPoint) {
        if block.level == 0 {
            return self.in_cell(block.at, point_m, best);
        }
        let finer = &self.levels[block.level - 1];
        let [i, j] = block.at.map(|index| 2 * index);
        let children = [[i, j], [i + 1, j], [i, j + 1], [i + 1, j + 1]];
        let mut nearest = children.map(|at| {
            let child = Block { level: block.level - 1, at };
            let exists = at[0] < finer.size[0] && at[1] < finer.size[1];
            (if exists { self.gap_to_block_m(child, point_m) } else { f64::INFINITY }, child)
        });
        nearest.sort_by(|a, b| a.0.total_cmp(&b.0));
        for (gap_m, child) in nearest {
            if gap_m < best.signed_distance_m {
                self.descend(child, point_m, best);
            }
        }
    }

    fn in_cell(&self, [i, j]: [usize; 2], point_m: [f64; 3], best: &mut NearestPoint) {
        let [sw, se, nw, ne] = [(i, j), (i + 1, j), (i, j + 1), (i + 1, j + 1)].map(|(i, j)| self.corner_m(i, j));
        for corners_m in [[sw, se, ne], [sw, ne, nw]] {
            let nearest_m = nearest_of_triangle(corners_m, point_m);
            let distance_m = norm(difference(point_m, nearest_m));
            if distance_m < best.signed_distance_m {
                *best = NearestPoint { signed_distance_m: distance_m, point_m: nearest_m };
            }
        }
    }

    /// Distance from a point to the box around a block, m; infinite if it has no data.
    fn gap_to_block_m(&self, Block { level, at }: Block, point_m: [f64; 3]) -> f64 {
        let cells = 1_usize << level;
        let beyond_m = |axis: usize| {
            let first = (at[axis] * cells) as f64;
            let last = ((at[axis] + 1) * cells).min(self.size[axis] - 1) as f64;
            let [min_m, max_m] = [first, last].map(|index| self.origin_m[axis] + self.cell_m * index);
            (min_m - point_m[axis]).max(point_m[axis] - max_m).max(0.0)
        };
        let blocks = &self.levels[level];
        let [low_m, high_m] = blocks.ranges_m[at[1] * blocks.size[0] + at[0]];
        let above_m = (low_m - point_m[2]).max(point_m[2] - high_m).max(0.0);
        norm([beyond_m(0), beyond_m(1), above_m])
    }
}

impl Level {
    /// Blocks of twice the size.
    fn halved(&self) -> Self {
        let [columns, rows] = self.size.map(|blocks| blocks.div_ceil(2));
        let range_m = |(i, j): (usize, usize)| {
            let finer = [(0, 0), (1, 0), (0, 1), (1, 1)].map(|(east, north)| [2 * i + east, 2 * j + north]);
            let of_block = |[i, j]: [usize; 2]| {
                let exists = i < self.size[0] && j < self.size[1];
                if exists { self.ranges_m[j * self.size[0] + i] } else { NO_DATA }
            };
            let known = finer.map(of_block);
            known.into_iter().fold(NO_DATA, |[low, high], [a, b]| [low.min(a), high.max(b)])
        };
        let all = (0..rows).flat_map(|j| (0..columns).map(move |i| (i, j)));
        Self { size: [columns, rows], ranges_m: all.map(range_m).collect() }
    }
}

/// The range of a block without data.
const NO_DATA: [f64; 2] = [f64::INFINITY, f64::NEG_INFINITY];

/// The range of all of `ranges_m`; without data if one of them is NaN.
fn hull_m(ranges_m: [[f64; 2]; 4]) -> [f64; 2] {
    if ranges_m.iter().flatten().any(|height_m| height_m.is_nan()) {
        return NO_DATA;
    }
    ranges_m.into_iter().fold(NO_DATA, |[low, high], [a, b]| [low.min(a), high.max(b)])
}

#[cfg(test)]
mod tests;
