//! Customised interior-point method for the convex subproblems of sequential convex programming.
//!
//! A subproblem is an elastic linear program over stages (Wang, Xu, Long 2020, P2 and P4, eq. 21, 22):
//!
//! ```text
//! min  q θ + μ Σ |E z - d| + μ Σ max(F z - g, 0)     s.t.  lo <= z <= hi,      z = (w_0, ..., w_K, θ)
//! ```
//!
//! - the hard bounds are the trust region (A_tr);
//! - the elastic equalities E (A_eq) couple neighbouring stages, w_k -> w_{k+1}, or fix single variables;
//! - the elastic inequalities F (A_in) are bounds of single variables and halfspaces in one or two neighbouring stages;
//! - θ is the only variable that all stages share.
//!
//! With elastic slacks p, n, β >= 0, slacks t >= 0 and multipliers y, λ, v, the optimality conditions are:
//!
//! ```text
//! E z - d = p - n        p ⟂ μ - y,  n ⟂ μ + y            |y| <= μ
//! F z - g = β - t        t ⟂ λ,      β ⟂ μ - λ            0 <= λ <= μ
//! u = hi - z, l = z - lo u ⟂ v_u,    l ⟂ v_l              v >= 0
//! q e_θ + E^T y + F^T λ + v_u - v_l = 0
//! ```
//!
//! μ stands for the weight μ u of each row, with the unit u in which its violation counts: the penalty is exact in SI
//! units while the rows are scaled, so that weights range from 100 to 1e6. They are bounds of multipliers that are of
//! order one. Between distant bounds a multiplier is kept apart from its distances to them (`complementarity`), and a
//! violation that is only rounding counts as none (`RowScale`).
//!
//! This is the paper's P4 with the elastic slacks eliminated: there α = p + n with the two rows s_2 = 2 n, s_3 = 2 p
//! and multipliers λ_2 = (μ + y)/2, λ_3 = (μ - y)/2, so that 4 D_2 D_3/(D_2 + D_3) = 1/(p/(μ - y) + n/(μ + y)); and
//! s_4 = t, λ_4 = λ, s_5 = β, λ_5 = μ - λ. The products, and therefore the iterates, are the same; the linear system is
//! smaller.
//!
//! No vehicle is named here.

mod backend;
#[expect(clippy::needless_range_loop, reason = "matrices are read by index, as in the formulas")]
mod batch;
mod batch_solver;
#[expect(clippy::needless_range_loop, reason = "matrices are read by index, as in the formulas")]
mod block;
mod certificate;
mod clarabel;
mod complementarity;
mod convergence;
mod feasibility;
mod interior_point;
#[expect(clippy::needless_range_loop, reason = "matrices are read by index, as in the formulas")]
mod iterate;
#[expect(clippy::needless_range_loop, reason = "matrices are read by index, as in the formulas")]
mod kernels;
mod newton;
mod newton_solver;
mod program;
mod reference_methods;
mod solution;

pub use self::backend::Backend;
pub(crate) use self::clarabel::settings as clarabel_settings;
pub use self::clarabel::solve as solve_with_clarabel;
pub use batch_solver::{BatchSolver, InteriorPoint};
pub use program::{DYNAMICS_ROWS, DynamicsConstraint, FixedVariable, HalfspaceConstraint, Program, STAGE_LEN};
pub use solution::{Settings, Solution, Start, Status};
