/// Numbers of variables and constraints.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Sizes {
    /// Variables x.
    pub variables: usize,
    /// Components of `c(x) = 0`.
    pub equalities: usize,
    /// Components of `d(x) >= 0`.
    pub inequalities: usize,
}

/// A nonlinear program that solves its own Newton systems.
///
/// [`linearise`](Self::linearise) fixes a point; all later products, factorisations and solutions belong to it.
pub trait Program {
    /// Numbers of variables and constraints.
    fn sizes(&self) -> Sizes;

    /// Lower and upper bounds of the variables, infinite where there is none; lower < upper.
    fn bounds(&self) -> (&[f64], &[f64]);

    /// Returns f(x); writes c(x) and d(x).
    fn evaluate(&mut self, x: &[f64], c: &mut [f64], d: &mut [f64]) -> f64;

    /// Computes the first derivatives at x, and the Hessian W of the Lagrangian `f + y^T c - v^T d`; writes ∇f.
    fn linearise(&mut self, x: &[f64], y: &[f64], v: &[f64], gradient: &mut [f64]);

    /// `out += J_c^T y - J_d^T v`; an empty `v` counts as zero.
    fn add_jacobian_transposed(&self, y: &[f64], v: &[f64], out: &mut [f64]);

    /// Writes `J_c dx` to `c` and `J_d dx` to `d`.
    fn jacobian_times(&self, dx: &[f64], c: &mut [f64], d: &mut [f64]);

    /// Forms `H = W + diag(diagonal) + J_d^T diag(weights) J_d` and factors
    ///
    /// ```text
    /// [ H    J_c^T ]
    /// [ J_c   0    ]
    /// ```
    ///
    /// Returns false if H is not positive definite on the null space of J_c: the Newton step would not be a descent
    /// direction.
    fn factor(&mut self, diagonal: &[f64], weights: &[f64]) -> bool;

    /// Writes `H dx`, with H as factored last.
    fn hessian_times(&self, dx: &[f64], out: &mut [f64]);

    /// Solves with the last factors in place: `x` holds the right-hand side of the first block row, then dx; `y` that
    /// of the second, then dy. The solution may be inexact: the method applies iterative refinement.
    fn solve(&mut self, x: &mut [f64], y: &mut [f64]);
}
