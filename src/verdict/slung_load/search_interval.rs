//! The intervals of a branch-and-bound search, best bound first.

use std::cmp::Ordering;

/// A part of a segment, with an upper bound of the objective within it. The highest bound comes first, NaN before all.
#[derive(Clone, Copy, Debug)]
pub struct SearchInterval<T> {
    /// Upper bound of the objective within the interval.
    pub bound: f64,
    /// The segment.
    pub segment: usize,
    /// Beginning and end, as fractions of the segment.
    pub fraction: [f64; 2],
    /// What the bound refers to.
    pub of: T,
}

impl<T> SearchInterval<T> {
    /// Shares of its two halves.
    pub fn halves(&self) -> [[f64; 2]; 2] {
        let [from, to] = self.fraction;
        let middle = f64::midpoint(from, to);
        [[from, middle], [middle, to]]
    }

    fn rank(&self) -> f64 {
        if self.bound.is_nan() { f64::INFINITY } else { self.bound }
    }
}

impl<T> Ord for SearchInterval<T> {
    fn cmp(&self, other: &Self) -> Ordering {
        self.rank().total_cmp(&other.rank())
    }
}

impl<T> PartialOrd for SearchInterval<T> {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl<T> PartialEq for SearchInterval<T> {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl<T> Eq for SearchInterval<T> {}

#[cfg(test)]
mod tests {
    use std::collections::BinaryHeap;

    use super::SearchInterval;

    #[test]
    fn the_highest_bound_comes_first_and_nan_before_all() {
        let interval = |bound: f64| SearchInterval { bound, segment: 0, fraction: [0.0, 1.0], of: () };
        let mut intervals = BinaryHeap::from([0.5, f64::NAN, 2.0, -1.0].map(interval));
        assert!(intervals.pop().is_some_and(|interval| interval.bound.is_nan()));
        assert_eq!(intervals.pop().map(|interval| interval.bound), Some(2.0));
        assert_eq!(interval(1.0).halves(), [[0.0, 0.5], [0.5, 1.0]]);
    }
}
