//! Searches over the whole map, before the flight: the baselines of the receding horizon.
//!
//! `sparse_astar` and `tree` find a path of straight legs; `timing` makes a motion of it that a vehicle with bounded speed
//! and acceleration can fly; `planner` puts both into a plan.

mod planner;
pub mod sparse_astar;
pub mod timing;
pub mod tree;

pub use planner::{RRT, RRT_STAR, SPARSE_ASTAR};

use crate::free_space::vector::{Point, distance};

/// Length of a path, m.
pub fn length_m(path: &[Point]) -> f64 {
    path.windows(2).map(|ends| distance(ends[0], ends[1])).sum()
}
