//! Windows of time over the cells of a grid.

use std::ops::Range;

use scenarios::requirement::Window;

use crate::verdict::requirements::interval::Interval;

/// A window, relative to every instant of a cell.
pub struct Windows<'a> {
    times_s: &'a [f64],
    window: Window,
}

impl<'a> Windows<'a> {
    /// - `times_s`: beginnings of the cells, and the end of the last one
    pub fn new(times_s: &'a [f64], window: Window) -> Self {
        Self { times_s, window }
    }

    fn cells(&self) -> usize {
        self.times_s.len() - 1
    }

    fn end_s(&self) -> f64 {
        self.times_s[self.cells()]
    }

    /// The cells that the window meets from some instant of `cell`. Empty if the motion ends before.
    pub fn possible(&self, cell: usize) -> Range<usize> {
        let [from_s, to_s] = [self.times_s[cell] + self.window.from_s, self.times_s[cell + 1] + self.window.to_s];
        if from_s > self.end_s() {
            return 0..0;
        }
        let first = self.times_s[1..].partition_point(|&end_s| end_s <= from_s).min(self.cells() - 1);
        let last = self.times_s[..self.cells()].partition_point(|&begin_s| begin_s < to_s);
        // A window that is an instant at the boundary of two cells is in both.
        first.max(cell)..last.max(first.max(cell) + 1)
    }

    /// The cells that the window meets from every instant of `cell`.
    fn certain(&self, cell: usize) -> Range<usize> {
        let [from_s, to_s] = [self.times_s[cell + 1] + self.window.from_s, self.times_s[cell] + self.window.to_s];
        let first = self.times_s[1..].partition_point(|&end_s| end_s < from_s);
        let last = self.times_s[..self.cells()].partition_point(|&begin_s| begin_s <= to_s);
        first.max(cell)..last
    }

    /// Whether the window begins after the end of the motion from some instant of `cell`.
    fn may_be_empty(&self, cell: usize) -> bool {
        self.times_s[cell + 1] + self.window.from_s > self.end_s()
    }

    /// Bounds of the smallest value in the window; of an empty window it is infinite.
    pub fn smallest(&self, values: &[Interval]) -> Vec<Interval> {
        let lower = RangeMinima::new(values.iter().map(|value| value.min).collect());
        let upper = RangeMinima::new(values.iter().map(|value| value.max).collect());
        let of_cell = |cell: usize| {
            let (possible, certain) = (self.possible(cell), self.certain(cell));
            let max = if self.may_be_empty(cell) {
                f64::INFINITY
            } else if certain.is_empty() {
                // Wherever the window is, the smallest value is not above the largest that it may meet.
                possible.clone().map(|cell| values[cell].max).fold(f64::NEG_INFINITY, f64::max)
            } else {
                upper.over(certain)
            };
            let min = lower.over(possible);
            Interval::new(min, max.max(min))
        };
        (0..self.cells()).map(of_cell).collect()
    }

    /// Bounds of the largest value of the smaller of `second` and of the smallest `first` until then, in the window.
    pub fn until(&self, first: &[Interval], second: &[Interval]) -> Vec<Interval> {
        let of = |end: fn(&Interval) -> f64| {
            RangeUntil::new(first.iter().map(end).collect(), &second.iter().map(end).collect::<Vec<f64>>())
        };
        let [lower, upper] = [of(|value| value.min), of(|value| value.max)];
        let of_cell = |cell: usize| {
            let max = upper.over(cell, self.possible(cell));
            let is_certain = !self.may_be_empty(cell);
            let min = if is_certain { lower.over(cell, self.certain(cell)) } else { f64::NEG_INFINITY };
            Interval::new(min, max.max(min))
        };
        (0..self.cells()).map(of_cell).collect()
    }

    /// The cells that the windows of some cells may meet.
    ///
    /// - `from_now`: whether those between the cell and its window count, too
    pub fn reached(&self, cells: &[bool], from_now: bool) -> Vec<bool> {
        let mut reached = vec![false; cells.len()];
        let mut done = 0;
        for cell in (0..cells.len()).filter(|&cell| cells[cell]) {
            let window = self.possible(cell);
            let first = if from_now { cell } else { window.start };
            // Beginnings and ends grow with the cell: what is behind `done` has been looked at.
            (first.max(done)..window.end).for_each(|later| reached[later] = true);
            done = done.max(window.end);
        }
        reached
    }
}

/// Smallest values over ranges: `levels[k][i]` is that of the 2^k values from i on.
struct RangeMinima {
    levels: Vec<Vec<f64>>,
}

impl RangeMinima {
    fn new(values: Vec<f64>) -> Self {
        let mut levels = vec![values];
        loop {
            let (below, width) = (&levels[levels.len() - 1], 1_usize << (levels.len() - 1));
            if below.len() <= width {
                return Self { levels };
            }
            let level = (0..below.len() - width).map(|index| below[index].min(below[index + width])).collect();
            levels.push(level);
        }
    }

    /// Infinite for an empty range.
    fn over(&self, range: Range<usize>) -> f64 {
        if range.is_empty() {
            return f64::INFINITY;
        }
        let level = range.len().ilog2() as usize;
        self.levels[level][range.start].min(self.levels[level][range.end - (1 << level)])
    }
}

/// Largest values over ranges of the smaller of `second` and of the smallest `first` until then: `levels[k][i]` is that of
/// the 2^k values from i on.
struct RangeUntil {
    first: RangeMinima,
    levels: Vec<Vec<f64>>,
}

impl RangeUntil {
    fn new(first: Vec<f64>, second: &[f64]) -> Self {
        let lowest = first.iter().zip(second).map(|(first, second)| first.min(*second)).collect();
        let first = RangeMinima::new(first);
        let mut levels: Vec<Vec<f64>> = vec![lowest];
        for minima in &first.levels[..first.levels.len() - 1] {
            let (below, width) = (&levels[levels.len() - 1], 1_usize << (levels.len() - 1));
            let joined = |index: usize| below[index].max(minima[index].min(below[index + width]));
            levels.push((0..below.len() - width).map(joined).collect());
        }
        Self { first, levels }
    }

    /// From `begin` on, where the instant of `second` is in `window`. Negative infinity for an empty window.
    fn over(&self, begin: usize, window: Range<usize>) -> f64 {
        if window.is_empty() {
            return f64::NEG_INFINITY;
        }
        let level = window.len().ilog2() as usize;
        let [first, last] = [window.start, window.end - (1 << level)];
        let later = self.first.over(first..last).min(self.levels[level][last]);
        self.first.over(begin..first).min(self.levels[level][first].max(later))
    }
}
