//! Block factorisation of the Newton system over the stages, in square-root form.
//!
//! ```text
//! [ H    E^T ] [dz]   [r_z]
//! [ E   -Ω   ] [dy] = [r_y]          H = diagonal + halfspaces,  Ω = diagonal
//! ```
//!
//! In the order w_0, y_0, w_1, y_1, ..., w_K, with θ as the border, the matrix is block tridiagonal (9 x 9 and 6 x 6
//! blocks), and every pivot block is a sum of positive definite terms:
//!
//! ```text
//! P_0     = H_0
//! P_k     = G_k^T G_k,          V_k = G_k^-T L_k^T
//! S_k     = Ω_k + V_k^T V_k  =  M_k^T M_k,    U_k = M_k^-T (R_k - V_k^T T_k)
//! P_{k+1} = H_{k+1} + U_k^T U_k
//! ```
//!
//! T_k couples w_k to the first two variables of w_{k+1} through halfspaces that span both stages: the rows of stage k
//! are then [G_k, T_k], and the rows that the reflections leave below them are added to H_{k+1}.
//!
//! The triangles G and M are computed from the square roots of the terms by orthogonal transformations, not from the
//! sums of the terms. Near the solution the weights spread over more than twenty orders of magnitude, and the curvature
//! of a soft direction (a variable between its bounds) would be lost in the rounding of a stiff one (a dynamics row).
//!
//! O(K 9^3) operations per factorisation, without index arrays and without allocation.

use super::batch::{Batch, DynamicsConstraint, HalfspaceRow};
use super::kernels::{Matrix, SquareRoot, add_transposed_product, subtract_product, subtract_transposed_product};
use super::program::{DYNAMICS_ROWS, STAGE_LEN};
use crate::simd::{Lanes, Simd4};

/// Number of halfspace rows that are reflected at once.
const HALFSPACE_BLOCK: usize = 4;

/// Number of variables of one stage in which halfspaces have coefficients.
const COUPLED: usize = 2;

/// The same for two neighbouring stages.
const SPANNED: usize = 2 * COUPLED;

/// The matrix of the Newton system, apart from E.
#[derive(Clone, Debug)]
pub struct Weights<S: Simd4> {
    /// Diagonal of H from the trust region, elastic bounds and fixed variables; length of z.
    pub diagonal: Vec<Lanes<S>>,
    /// Weight 1/ω of every halfspace.
    pub halfspaces: Vec<Lanes<S>>,
    /// Ω of the dynamics rows.
    pub dynamics: Vec<Lanes<S>>,
}

/// A right-hand side or a solution, C columns at once.
#[derive(Clone, Debug)]
pub struct Columns<S: Simd4, const C: usize> {
    /// r_z or dz, θ last.
    pub z: Vec<[Lanes<S>; C]>,
    /// r_y or dy of the dynamics rows.
    pub y: Vec<[Lanes<S>; C]>,
}

/// Factors of the block tridiagonal matrix, and its solution for the border.
#[derive(Clone, Debug)]
pub struct BlockSystem<S: Simd4> {
    stages: Vec<StageFactor<S>>,
    /// Solution for the border column θ.
    border: Columns<S, 1>,
    border_pivot: Lanes<S>,
}

/// Factors of stage k and of the dynamics constraint after it.
#[derive(Clone, Debug)]
struct StageFactor<S: Simd4> {
    /// G_k.
    g: SquareRoot<S, STAGE_LEN>,
    /// T_k.
    t: Matrix<S, STAGE_LEN, COUPLED>,
    /// Does any halfspace of this stage have coefficients in the next?
    spans: bool,
    /// V_k.
    v: Matrix<S, STAGE_LEN, DYNAMICS_ROWS>,
    /// M_k.
    m: SquareRoot<S, DYNAMICS_ROWS>,
    /// U_k.
    u: Matrix<S, DYNAMICS_ROWS, STAGE_LEN>,
}

impl<S: Simd4, const C: usize> Columns<S, C> {
    /// Zeros for programs of `intervals` intervals.
    pub fn zero(simd: S, intervals: usize) -> Self {
        let zero = [Lanes::splat(simd, 0.0); C];
        Self { z: vec![zero; STAGE_LEN * (intervals + 1) + 1], y: vec![zero; DYNAMICS_ROWS * intervals] }
    }

    /// Number K of intervals.
    pub fn intervals(&self) -> usize {
        self.y.len() / DYNAMICS_ROWS
    }
}

impl<S: Simd4> BlockSystem<S> {
    /// Zeros for programs of `intervals` intervals.
    pub fn new(simd: S, intervals: usize) -> Self {
        let zero = Lanes::splat(simd, 0.0);
        let stage = StageFactor {
            g: SquareRoot::zero(simd),
            t: [[zero; COUPLED]; STAGE_LEN],
            spans: false,
            v: [[zero; DYNAMICS_ROWS]; STAGE_LEN],
            m: SquareRoot::zero(simd),
            u: [[zero; STAGE_LEN]; DYNAMICS_ROWS],
        };
        Self { stages: vec![stage; intervals + 1], border: Columns::zero(simd, intervals), border_pivot: zero }
    }

    /// Factors the matrix that `batch` and `weights` define, without its border.
    #[inline(always)]
    pub fn factor(&mut self, batch: &Batch<S>, weights: &Weights<S>) {
        let zero = Lanes::splat(batch.simd, 0.0);
        let (diagonals, _) = weights.diagonal.as_chunks::<STAGE_LEN>();
        let (ω, _) = weights.dynamics.as_chunks::<DYNAMICS_ROWS>();
        // rows that the halfspaces of the previous stage leave to this one, and its U
        let mut carried = [[zero; COUPLED]; COUPLED];
        let mut u = [[zero; STAGE_LEN]; DYNAMICS_ROWS];
        for (k, factor) in self.stages.iter_mut().enumerate() {
            let own = batch.first_halfspace[k]..batch.first_halfspace[k + 1];
            let halfspaces = halfspace_root(carried, &batch.halfspaces[own.clone()], &weights.halfspaces[own]);
            factor.set_stage(&diagonals[k], &u, &halfspaces, &mut carried);
            if let Some(constraint) = batch.dynamics.get(k) {
                factor.set_dynamics(constraint, &ω[k]);
                u = factor.u;
            }
        }
    }

    /// Solves for the border and for one right-hand side together; `rhs` is overwritten with the solution.
    ///
    /// - `θ_weight`: weight of θ in H
    /// - `both`: work space of two columns
    #[inline(always)]
    pub fn solve_with_border(
        &mut self,
        batch: &Batch<S>,
        θ_weight: Lanes<S>,
        both: &mut Columns<S, 2>,
        rhs: &mut Columns<S, 1>,
    ) {
        let zero = θ_weight.like(0.0);
        for (both, rhs) in both.z.iter_mut().zip(&rhs.z) {
            *both = [zero, rhs[0]];
        }
        let columns = batch.dynamics.iter().flat_map(|constraint| &constraint.theta).zip(&rhs.y);
        for (both, (θ, rhs)) in both.y.iter_mut().zip(columns) {
            *both = [*θ, rhs[0]];
        }
        self.substitute(both);
        for (both, (rhs, border)) in both.z.iter().zip(rhs.z.iter_mut().zip(&mut self.border.z)) {
            ([border[0]], [rhs[0]]) = ([both[0]], [both[1]]);
        }
        for (both, (rhs, border)) in both.y.iter().zip(rhs.y.iter_mut().zip(&mut self.border.y)) {
            ([border[0]], [rhs[0]]) = ([both[0]], [both[1]]);
        }
        self.border_pivot = θ_weight - border_product(batch, &self.border.y);
        self.subtract_border(batch, rhs);
    }

    /// Solves for one right-hand side, in place, after [`BlockSystem::solve_with_border`].
    #[inline(always)]
    pub fn solve(&self, batch: &Batch<S>, rhs: &mut Columns<S, 1>) {
        self.substitute(rhs);
        self.subtract_border(batch, rhs);
    }

    #[inline(always)]
    fn subtract_border(&self, batch: &Batch<S>, rhs: &mut Columns<S, 1>) {
        let last = rhs.z.len() - 1;
        let θ = (rhs.z[last][0] - border_product(batch, &rhs.y)).over(self.border_pivot);
        for (value, border) in rhs.z.iter_mut().zip(&self.border.z) {
            value[0] = border[0].mul_add(-θ, value[0]);
        }
        for (value, border) in rhs.y.iter_mut().zip(&self.border.y) {
            value[0] = border[0].mul_add(-θ, value[0]);
        }
        rhs.z[last][0] = θ;
    }

    /// Forward and backward substitution over the stages, without the border.
    #[inline(always)]
    fn substitute<const C: usize>(&self, rhs: &mut Columns<S, C>) {
        let (stages, _) = rhs.z.as_chunks_mut::<STAGE_LEN>();
        let (dynamics, _) = rhs.y.as_chunks_mut::<DYNAMICS_ROWS>();
        let last = dynamics.len();
        let mut next = stages[0];
        for (k, factor) in self.stages[..last].iter().enumerate() {
            let mut w = next;
            next = stages[k + 1];
            factor.g.solve_transposed(&mut w);
            subtract_transposed_product(&mut dynamics[k], &factor.v, &w);
            factor.m.solve_transposed(&mut dynamics[k]);
            add_transposed_product(&mut next, &factor.u, &dynamics[k]);
            if factor.spans {
                let coupled: &mut Matrix<S, COUPLED, C> = next.first_chunk_mut().expect("a stage has more variables");
                subtract_transposed_product(coupled, &factor.t, &w);
            }
            stages[k] = w;
        }
        self.stages[last].g.solve_transposed(&mut next);
        self.stages[last].g.solve(&mut next);
        stages[last] = next;
        for (k, factor) in self.stages[..last].iter().enumerate().rev() {
            let (w, y) = (&mut stages[k], &mut dynamics[k]);
            subtract_product(y, &factor.u, &next);
            for value in y.as_flattened_mut() {
                *value = -*value;
            }
            factor.m.solve(y);
            subtract_product(w, &factor.v, y);
            if factor.spans {
                subtract_product(w, &factor.t, next.first_chunk().expect("a stage has more variables"));
            }
            factor.g.solve(w);
            next = *w;
        }
    }
}

impl<S: Simd4> StageFactor<S> {
    /// Computes G and T from the diagonal, U of the previous stage (`u`) and the halfspaces. `carried` is set to the
    /// rows that these leave to the next stage.
    #[inline(always)]
    fn set_stage(
        &mut self,
        diagonal: &[Lanes<S>; STAGE_LEN],
        u: &Matrix<S, DYNAMICS_ROWS, STAGE_LEN>,
        halfspaces: &HalfspaceRoot<S>,
        carried: &mut Matrix<S, COUPLED, COUPLED>,
    ) {
        let zero = diagonal[0].like(0.0);
        let mut rows = [[zero; STAGE_LEN]; DYNAMICS_ROWS + COUPLED];
        rows[..DYNAMICS_ROWS].copy_from_slice(u);
        for (i, row) in rows[DYNAMICS_ROWS..].iter_mut().enumerate() {
            let halfspace = halfspaces.root.row(i);
            (row[0], row[1]) = (halfspace[0], halfspace[1]);
        }
        self.g.set_diagonal(diagonal);
        self.spans = halfspaces.spans;
        if halfspaces.spans {
            self.t = [[zero; COUPLED]; STAGE_LEN];
            let mut tail = [[zero; COUPLED]; DYNAMICS_ROWS + COUPLED];
            for (i, row) in tail[DYNAMICS_ROWS..].iter_mut().enumerate() {
                let halfspace = halfspaces.root.row(i);
                (row[0], row[1]) = (halfspace[2], halfspace[3]);
            }
            self.g.append_with_tail(&mut rows, &mut self.t, &mut tail);
            let mut left = SquareRoot::<S, COUPLED>::zero_like(zero);
            let mut own = [[zero; COUPLED]; COUPLED];
            for (i, row) in own.iter_mut().enumerate() {
                let halfspace = halfspaces.root.row(COUPLED + i);
                (row[0], row[1]) = (halfspace[2], halfspace[3]);
            }
            left.append(&mut own);
            left.append(&mut tail);
            *carried = [*left.row(0), *left.row(1)];
        } else {
            self.g.append(&mut rows);
            *carried = [[zero; COUPLED]; COUPLED];
        }
        self.g.finish();
    }

    /// Computes V, M and U from the dynamics constraint after the stage.
    #[inline(always)]
    fn set_dynamics(&mut self, constraint: &DynamicsConstraint<S>, ω: &[Lanes<S>; DYNAMICS_ROWS]) {
        for i in 0..STAGE_LEN {
            for row in 0..DYNAMICS_ROWS {
                self.v[i][row] = constraint.left[row][i];
            }
        }
        self.g.solve_transposed(&mut self.v);
        self.m.set_diagonal(ω);
        self.m.append(&mut { self.v });
        self.m.finish();
        self.u = constraint.right;
        if self.spans {
            for (row, u) in self.u.iter_mut().enumerate() {
                for (v, t) in self.v.iter().zip(&self.t) {
                    for i in 0..COUPLED {
                        u[i] -= v[row] * t[i];
                    }
                }
            }
        }
        self.m.solve_transposed(&mut self.u);
    }
}

/// Square root of the halfspace terms of a stage, with the rows that the previous stage left to it.
struct HalfspaceRoot<S: Simd4> {
    root: SquareRoot<S, SPANNED>,
    /// Does any of them have coefficients in the next stage?
    spans: bool,
}

#[inline(always)]
fn halfspace_root<S: Simd4>(
    carried: Matrix<S, COUPLED, COUPLED>,
    halfspaces: &[HalfspaceRow<S>],
    weights: &[Lanes<S>],
) -> HalfspaceRoot<S> {
    let zero = carried[0][0].like(0.0);
    let mut root = SquareRoot::zero_like(zero);
    let mut rows = [[zero; SPANNED]; HALFSPACE_BLOCK];
    for (row, [x, y]) in rows.iter_mut().zip(carried) {
        *row = [x, y, zero, zero];
    }
    let mut filled = COUPLED;
    let mut spans = false;
    for (halfspace, &weight) in halfspaces.iter().zip(weights) {
        if filled == HALFSPACE_BLOCK {
            root.append(&mut rows);
            rows = [[zero; SPANNED]; HALFSPACE_BLOCK];
            filled = 0;
        }
        let weight = weight.sqrt();
        let [a, b] = halfspace.current;
        let [c, d] = halfspace.next;
        rows[filled] = [weight * a, weight * b, weight * c, weight * d];
        filled += 1;
        spans |= halfspace.spans;
    }
    root.append(&mut rows);
    HalfspaceRoot { root, spans }
}

/// Σ theta · y over the dynamics.
#[inline(always)]
fn border_product<S: Simd4>(batch: &Batch<S>, y: &[[Lanes<S>; 1]]) -> Lanes<S> {
    let (dynamics, _) = y.as_chunks::<DYNAMICS_ROWS>();
    let mut sum = Lanes::splat(batch.simd, 0.0);
    for (constraint, y) in batch.dynamics.iter().zip(dynamics) {
        for i in 0..DYNAMICS_ROWS {
            sum = constraint.theta[i].mul_add(y[i][0], sum);
        }
    }
    sum
}
