//! Spans of a motion in the order in which branch and bound looks at them.

use std::cmp::Ordering;

/// A part of a segment, and a bound on how good the best of it may be. The highest bound comes first, a NaN before all.
#[derive(Clone, Copy, Debug)]
pub struct SearchInterval<T> {
    /// Nothing within the span is better than this.
    pub bound: f64,
    /// The segment.
    pub segment: usize,
    /// From and to, as shares of the segment.
    pub share: [f64; 2],
    /// What the bound is of.
    pub of: T,
}

impl<T> SearchInterval<T> {
    /// Shares of its two halves.
    pub fn halves(&self) -> [[f64; 2]; 2] {
        let [from, to] = self.share;
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
    fn the_most_promising_comes_first_and_what_is_not_a_number_before_all() {
        let span = |bound: f64| SearchInterval { bound, segment: 0, share: [0.0, 1.0], of: () };
        let mut spans = BinaryHeap::from([0.5, f64::NAN, 2.0, -1.0].map(span));
        assert!(spans.pop().is_some_and(|span| span.bound.is_nan()));
        assert_eq!(spans.pop().map(|span| span.bound), Some(2.0));
        assert_eq!(span(1.0).halves(), [[0.0, 0.5], [0.5, 1.0]]);
    }
}
