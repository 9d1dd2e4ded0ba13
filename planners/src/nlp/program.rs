/// Numbers of variables and rows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Sizes {
    /// Variables x.
    pub variables: usize,
    /// Rows of `c(x) = 0`.
    pub equalities: usize,
    /// Rows of `d(x) >= 0`.
    pub inequalities: usize,
}

/// A nonlinear programme that knows how to solve its own Newton systems.
///
/// [`linearise`](Self::linearise) fixes a point; the products and the factorisation that follow belong to it.
pub trait Program {
    /// Numbers of variables and rows.
    fn sizes(&self) -> Sizes;

    /// Lower and upper bounds of the variables, infinite where there is none; lower < upper.
    fn bounds(&self) -> (&[f64], &[f64]);

    /// f(x); writes c(x) and d(x).
    fn values(&mut self, x: &[f64], c: &mut [f64], d: &mut [f64]) -> f64;

    /// First derivatives at x, and the Hessian of `f + y^T c - v^T d`; writes ∇f.
    fn linearise(&mut self, x: &[f64], y: &[f64], v: &[f64], gradient: &mut [f64]);

    /// `out += J_c^T y - J_d^T v`.
    fn add_transposed(&self, y: &[f64], v: &[f64], out: &mut [f64]);

    /// `J_c dx` and `J_d dx`.
    fn rows_times(&self, dx: &[f64], c: &mut [f64], d: &mut [f64]);

    /// Forms `H = W + diag(diagonal) + J_d^T diag(weights) J_d` and factors
    ///
    /// ```text
    /// [ H    J_c^T ]
    /// [ J_c   0    ]
    /// ```
    ///
    /// False if H is not positive definite on the null space of J_c: the Newton step would not be one of descent.
    fn factor(&mut self, diagonal: &[f64], weights: &[f64]) -> bool;

    /// `H dx`, with H as it was factored last.
    fn hessian_times(&self, dx: &[f64], out: &mut [f64]);

    /// Solves with the last factors, in place: `x` holds the right-hand side of the first block row, then dx; `y` that of
    /// the second, then dy. It may be inexact: the method refines.
    fn solve(&mut self, x: &mut [f64], y: &mut [f64]);
}
