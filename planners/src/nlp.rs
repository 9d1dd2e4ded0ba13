//! A primal-dual interior-point method with filter line search for sparse nonlinear programmes (Wächter and Biegler
//! 2006), without any matrix of its own: the programme factors and solves its own Newton systems, so that it can use what
//! structure it has.
//!
//! ```text
//! min  f(x)     s.t.  c(x) = 0,  d(x) >= 0,  lower <= x <= upper
//! ```
//!
//! With slacks `d(x) = s` and the barrier parameter μ the method follows the solutions of
//!
//! ```text
//! ∇f + J_c^T y - J_d^T v - z_l + z_u = 0          c(x) = 0,  d(x) - s = 0
//! s v = μ,  (x - lower) z_l = μ,  (upper - x) z_u = μ
//! ```
//!
//! No vehicle is named here.

mod barrier;
mod filter;
mod interior_point;
mod iterate;
mod line_search;
mod newton;
mod program;
mod solution;

#[cfg(test)]
mod dense;
#[cfg(test)]
mod tests;

pub use interior_point::InteriorPoint;
pub use iterate::{Start, Warm};
pub use program::{Program, Sizes};
pub use solution::{Record, Settings, Solution, Status};
