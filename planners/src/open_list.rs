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
