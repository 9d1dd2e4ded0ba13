//! The priority queue of best-first searches (Dijkstra, A*).

use std::cmp::{Ordering, Reverse};
use std::collections::BinaryHeap;

/// A float with a total order: -NaN < -∞ < ... < ∞ < NaN, as by [`f64::total_cmp`].
#[derive(Clone, Copy, Debug)]
pub struct TotalF64(pub f64);

impl Ord for TotalF64 {
    fn cmp(&self, other: &Self) -> Ordering {
        self.0.total_cmp(&other.0)
    }
}

impl PartialOrd for TotalF64 {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl PartialEq for TotalF64 {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other).is_eq()
    }
}

impl Eq for TotalF64 {}

/// Items with their costs, cheapest first; of equal costs the smaller item first.
#[derive(Clone, Debug)]
pub struct OpenList<T> {
    heap: BinaryHeap<Reverse<(TotalF64, T)>>,
}

impl<T: Ord> OpenList<T> {
    /// An empty list.
    pub fn new() -> Self {
        Self { heap: BinaryHeap::new() }
    }

    /// Adds an item.
    pub fn push(&mut self, cost: f64, item: T) {
        self.heap.push(Reverse((TotalF64(cost), item)));
    }

    /// Removes the cheapest item; `None` if the list is empty.
    pub fn pop(&mut self) -> Option<(f64, T)> {
        self.heap.pop().map(|Reverse((TotalF64(cost), item))| (cost, item))
    }
}

#[cfg(test)]
mod tests {
    use super::OpenList;

    #[test]
    fn cheaper_items_come_first_and_of_equal_costs_the_smaller() {
        let mut open = OpenList::new();
        for (cost, item) in [(2.0, 1), (f64::NAN, 0), (1.0, 7), (1.0, 3), (f64::NEG_INFINITY, 9)] {
            open.push(cost, item);
        }
        let order: Vec<i32> = std::iter::from_fn(|| open.pop()).map(|(_, item)| item).collect();
        assert_eq!(order, [9, 3, 7, 1, 0]);
    }
}
