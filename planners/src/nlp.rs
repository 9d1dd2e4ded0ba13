//! A primal-dual interior-point method with filter line search for sparse nonlinear programs (Wächter and Biegler, "On
//! the implementation of an interior-point filter line-search algorithm for large-scale nonlinear programming",
//! Mathematical Programming 106, 2006).
//!
//! ```text
//! min  f(x)     s.t.  c(x) = 0,  d(x) >= 0,  lower <= x <= upper
//! ```
//!
//! With slacks `d(x) = s` and the barrier parameter μ, the method follows the central path
//!
//! ```text
//! ∇f + J_c^T y - J_d^T v - z_l + z_u = 0          c(x) = 0,  d(x) - s = 0
//! s v = μ,  (x - lower) z_l = μ,  (upper - x) z_u = μ
//! ```
//!
//! The method holds no matrices: a [`Program`] factors and solves its own Newton systems, and so exploits its
//! structure. No vehicle is named here.

mod barrier;
mod filter;
mod interior_point;
mod iterate;
mod line_search;
mod newton;
mod program;
mod solution;
mod state;

#[cfg(test)]
mod dense;
#[cfg(test)]
mod tests;

pub use interior_point::InteriorPoint;
pub use iterate::{Start, WarmStart};
pub use program::{Program, Sizes};
pub use solution::{IterationRecord, Settings, Solution, Status};
