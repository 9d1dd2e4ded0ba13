//! The lowest and the highest point of a terrain above a rectangle.

use super::{Block, NO_DATA, TerrainGrid};
use crate::geometry::ROUNDING;

/// Limits along x and y, in cells from the south-west corner.
type Rectangle = [[f64; 2]; 2];

impl TerrainGrid {
    /// Lowest and highest point above a rectangle, rounded outwards, m; `None` if a part of it is outside the grid or near a
    /// corner without data.
    ///
    /// - `x_m`, `y_m`: its limits, the smaller one first
    pub fn height_range_m(&self, x_m: [f64; 2], y_m: [f64; 2]) -> Option<[f64; 2]> {
        let is_inside = |[min_m, max_m]: [f64; 2], [low_m, high_m]: [f64; 2]| min_m >= low_m && max_m <= high_m;
        let [x_extent_m, y_extent_m] = self.extent_m();
        let is_known = is_inside(x_m, x_extent_m) && is_inside(y_m, y_extent_m);
        if !is_known || (self.has_gaps && self.gap_m(x_m, y_m).is_some()) {
            return None;
        }
        let in_cells = |axis: usize, at_m: f64| (at_m - self.origin_m[axis]) / self.cell_m;
        let rectangle = [x_m.map(|at_m| in_cells(0, at_m)), y_m.map(|at_m| in_cells(1, at_m))];
        let [low_m, high_m] = self.range_in_block(Block { level: self.levels.len() - 1, at: [0, 0] }, &rectangle);
        let coordinates_m = [x_m, y_m, [low_m, high_m]];
        let largest_m = coordinates_m.iter().flatten().fold(0.0_f64, |largest_m, it| largest_m.max(it.abs()));
        let rounding_m = ROUNDING * (1.0 + self.steepest) * largest_m;
        (low_m <= high_m).then_some([low_m - rounding_m, high_m + rounding_m])
    }

    fn range_in_block(&self, block: Block, rectangle: &Rectangle) -> [f64; 2] {
        let sides = [0, 1].map(|axis| {
            let cells = 1_usize << block.level;
            let last = ((block.at[axis] + 1) * cells).min(self.size[axis] - 1);
            [(block.at[axis] * cells) as f64, last as f64]
        });
        let axes = || sides.iter().zip(rectangle);
        if axes().any(|(side, limits)| side[1] < limits[0] || side[0] > limits[1]) {
            return NO_DATA;
        }
        if axes().all(|(side, limits)| side[0] >= limits[0] && side[1] <= limits[1]) {
            let level = &self.levels[block.level];
            return level.ranges_m[block.at[1] * level.size[0] + block.at[0]];
        }
        if block.level == 0 {
            return self.range_in_cell(block.at, rectangle);
        }
        let finer = self.levels[block.level - 1].size;
        let [i, j] = block.at.map(|index| 2 * index);
        let children = [[i, j], [i + 1, j], [i, j + 1], [i + 1, j + 1]];
        let existing = children.into_iter().filter(|at| at[0] < finer[0] && at[1] < finer[1]);
        let ranges = existing.map(|at| self.range_in_block(Block { level: block.level - 1, at }, rectangle));
        ranges.fold(NO_DATA, |[low, high], [a, b]| [low.min(a), high.max(b)])
    }

    /// In a cell, whose two triangles meet in its diagonal: at the corners of the part, and where the diagonal enters and leaves it.
    fn range_in_cell(&self, at: [usize; 2], rectangle: &Rectangle) -> [f64; 2] {
        let [u, v] = [0, 1].map(|axis| rectangle[axis].map(|limit| (limit - at[axis] as f64).clamp(0.0, 1.0)));
        let diagonal = [u[0].max(v[0]), u[1].min(v[1])];
        let on_diagonal = diagonal.into_iter().filter(|_| diagonal[0] <= diagonal[1]).map(|along| [along, along]);
        let corners = [[u[0], v[0]], [u[1], v[0]], [u[0], v[1]], [u[1], v[1]]];
        let heights_m = corners.into_iter().chain(on_diagonal).map(|place| self.height_in_cell_m(at, place));
        heights_m.fold(NO_DATA, |[low, high], height_m| [low.min(height_m), high.max(height_m)])
    }

    /// The largest slope of a triangle, height per distance.
    pub(super) fn largest_slope(&self) -> f64 {
        let cells = (0..self.size[1] - 1).flat_map(|j| (0..self.size[0] - 1).map(move |i| [i, j]));
        let slopes = cells.map(|[i, j]| {
            let [[sw, se], [nw, ne]] = [0, 1].map(|north| [0, 1].map(|east| self.corner_m(i + east, j + north)[2]));
            (se - sw).hypot(ne - se).max((ne - nw).hypot(nw - sw)) / self.cell_m
        });
        slopes.fold(0.0, f64::max)
    }
}

#[cfg(test)]
mod tests {
    use rand::RngExt;

    use super::super::TerrainGrid;

    /// Hills and valleys of up to 40 m in cells of 5 m, the south-west corner at (-30, 20) m.
    fn hills() -> TerrainGrid {
        let mut random = crate::stream(4, "hills");
        let heights_m = (0..17 * 23).map(|_| random.random_range(-40.0..40.0)).collect();
        TerrainGrid::new([-30.0, 20.0], 5.0, [17, 23], heights_m)
    }

    #[test]
    fn no_height_is_beyond_the_range_and_both_ends_are_reached() {
        let (hills, mut random) = (hills(), crate::stream(5, "rectangles"));
        for round in 0..400 {
            let size_m = [1e-9, 0.3, 4.0, 30.0][round % 4];
            let [x, y] = [[-30.0, 50.0 - size_m], [20.0, 130.0 - size_m]].map(|[a, b]| random.random_range(a..b));
            let [width_m, depth_m] = [0, 1].map(|_| random.random_range(0.0..=size_m));
            let [low_m, high_m] = hills.height_range_m([x, x + width_m], [y, y + depth_m]).expect("inside");
            let (mut lowest_m, mut highest_m) = (f64::INFINITY, f64::NEG_INFINITY);
            for _ in 0..2000 {
                let [u, v] = [0, 1].map(|_| random.random_range(0.0..=1.0));
                let height_m = hills.height_m(x + u * width_m, y + v * depth_m).expect("inside");
                assert!((low_m..=high_m).contains(&height_m), "{height_m} not in [{low_m}, {high_m}]");
                (lowest_m, highest_m) = (lowest_m.min(height_m), highest_m.max(height_m));
            }
            let slack_m = 0.1 * size_m * hills.steepest() + 1e-6;
            assert!(
                lowest_m - low_m < slack_m && high_m - highest_m < slack_m,
                "{low_m} {lowest_m} {highest_m} {high_m}"
            );
        }
    }

    #[test]
    fn the_slope_bounds_every_change_of_height() {
        let (hills, mut random) = (hills(), crate::stream(6, "slopes"));
        let mut steepest = 0.0_f64;
        for _ in 0..20_000 {
            let [x, y] = [random.random_range(-30.0..49.0), random.random_range(20.0..129.0)];
            let [dx, dy] = [0, 1].map(|_| random.random_range(0.0..0.5));
            let [a, b] = [hills.height_m(x, y), hills.height_m(x + dx, y + dy)].map(|it| it.expect("inside"));
            steepest = steepest.max((b - a).abs() / f64::hypot(dx, dy));
        }
        assert!(steepest <= hills.steepest() * (1.0 + 1e-6) && steepest > 0.5 * hills.steepest(), "{steepest}");
    }

    #[test]
    fn beyond_the_edges_and_beside_gaps_nothing_is_known() {
        let mut heights_m = vec![7.0; 16];
        heights_m[0] = f64::NAN;
        let grid = TerrainGrid::new([0.0, 0.0], 1.0, [4, 4], heights_m);
        let range = grid.height_range_m([2.0, 3.0], [2.0, 3.0]).expect("data");
        assert!(range[0] <= 7.0 && range[1] >= 7.0 && range[1] - range[0] < 1e-9, "{range:?}");
        for (x_m, y_m) in [([2.0, 3.1], [2.0, 3.0]), ([0.5, 3.0], [0.5, 3.0]), ([f64::NAN, 3.0], [2.0, 3.0])] {
            assert_eq!(grid.height_range_m(x_m, y_m), None, "{x_m:?} {y_m:?}");
        }
    }
}
