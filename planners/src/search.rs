//! Searches over the whole map before the flight: the baselines of the receding horizon.
//!
//! [`sparse_astar`] and [`rrt`] find a path of straight legs, [`timing`] turns it into a motion within the vehicle's speed
//! and acceleration limits, and `planner` makes a plan of that.

mod planner;
pub mod rrt;
pub mod sparse_astar;
pub mod timing;

use crate::free_space::{FreeSpace, Point};
use crate::planner::Planner;

/// The planners of this family.
pub(crate) const PLANNERS: &[Planner] = &[planner::SPARSE_ASTAR, planner::RRT, planner::RRT_STAR];

/// A shortest-path problem among static obstacles.
#[derive(Clone, Debug, PartialEq)]
pub struct PathProblem {
    /// Bounds and obstacles.
    pub space: FreeSpace,
    /// Start, m.
    pub start: Point,
    /// Goal, m.
    pub goal: Point,
    /// Distance that the path keeps from bounds and obstacles, m.
    pub clearance_m: f64,
    /// Number of free coordinates: 2 in the plane, 3 in space.
    pub axes: usize,
}

impl PathProblem {
    /// Does the straight segment keep the clearance?
    pub fn is_clear(&self, from: Point, to: Point) -> bool {
        self.space.is_clear(from, to, self.clearance_m)
    }
}
