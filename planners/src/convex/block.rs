//! The Newton system by a block sweep over the stages.
//!
//! ```text
//! [ H    E^T ] [dz]   [r_z]
//! [ E   -Ω   ] [dy] = [r_y]          H = diag + planes,  Ω = diag
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
//! T_k couples w_k to the first two variables of w_{k+1}, through planes that span both stages: with them the rows of
//! stage k are [G_k, T_k], and what the reflections leave below joins H_{k+1}.
//!
//! The triangles G and M are made from the square roots of the terms by orthogonal transformations, not from their
//! sums: near the solution weights spread over more than twenty orders of magnitude, and a soft direction (a load
//! factor between its bounds) would drown in the rounding of a stiff one (an equation of motion).
//!
//! O(K 9^3) per factorisation, no index arrays, no allocation.

use super::batch::{Batch, Link, PlaneRow};
use super::kernels::{Matrix, SquareRoot, add_transposed_product, subtract_product, subtract_transposed_product};
use super::lanes::{Lanes, Vector};
use super::program::{LINK, STAGE};

/// Rows of planes that are reflected at once.
const PLANES_AT_ONCE: usize = 4;

/// Variables of a stage in which planes live, and those of a plane together with the stage after it.
const NEXT: usize = 2;
const SPAN: usize = 4;

/// The matrix of the Newton system, apart from E.
#[derive(Clone, Debug)]
pub struct Weights<S: Vector> {
    /// Diagonal of H from boxes, elastic bounds and pins; length of z.
    pub diagonal: Vec<Lanes<S>>,
    /// Weight 1/ω of every plane.
    pub planes: Vec<Lanes<S>>,
    /// Ω of the link rows.
    pub links: Vec<Lanes<S>>,
}

/// A right-hand side, or a solution: C columns at once.
#[derive(Clone, Debug)]
pub struct Columns<S: Vector, const C: usize> {
    /// r_z or dz, θ last.
    pub z: Vec<[Lanes<S>; C]>,
    /// r_y or dy of the link rows.
    pub y: Vec<[Lanes<S>; C]>,
}

/// Factors of the block sweep, and the response to the border.
#[derive(Clone, Debug)]
pub struct BlockSystem<S: Vector> {
    stages: Vec<StageFactor<S>>,
    /// Solution for the border column.
    border: Columns<S, 1>,
    border_pivot: Lanes<S>,
}

/// Factors of stage k and of the link after it.
#[derive(Clone, Debug)]
struct StageFactor<S: Vector> {
    /// G_k.
    g: SquareRoot<S, STAGE>,
    /// T_k.
    t: Matrix<S, STAGE, NEXT>,
    /// Does any plane of this stage reach the next?
    spans: bool,
    /// V_k.
    v: Matrix<S, STAGE, LINK>,
    /// M_k.
    m: SquareRoot<S, LINK>,
    /// U_k.
    u: Matrix<S, LINK, STAGE>,
}

impl<S: Vector, const C: usize> Columns<S, C> {
    /// Room for programmes of `intervals` links.
    pub fn zero(simd: S, intervals: usize) -> Self {
        let zero = [Lanes::splat(simd, 0.0); C];
        Self { z: vec![zero; STAGE * (intervals + 1) + 1], y: vec![zero; LINK * intervals] }
    }

    /// Number K of links that there is room for.
    pub fn intervals(&self) -> usize {
        self.y.len() / LINK
    }
}

impl<S: Vector> BlockSystem<S> {
    /// Room for programmes of `intervals` links.
    pub fn new(simd: S, intervals: usize) -> Self {
        let zero = Lanes::splat(simd, 0.0);
        let stage = StageFactor {
            g: SquareRoot::zero(simd),
            t: [[zero; NEXT]; STAGE],
            spans: false,
            v: [[zero; LINK]; STAGE],
            m: SquareRoot::zero(simd),
            u: [[zero; STAGE]; LINK],
        };
        Self { stages: vec![stage; intervals + 1], border: Columns::zero(simd, intervals), border_pivot: zero }
    }

    /// Factors the matrix that `batch` and `weights` give, without its border.
    #[inline(always)]
    pub fn factor(&mut self, batch: &Batch<S>, weights: &Weights<S>) {
        let zero = Lanes::splat(batch.simd, 0.0);
        let (diagonals, _) = weights.diagonal.as_chunks::<STAGE>();
        let (ω, _) = weights.links.as_chunks::<LINK>();
        // what the planes of the stage before leave to this one, and its U
        let mut carried = [[zero; NEXT]; NEXT];
        let mut u = [[zero; STAGE]; LINK];
        for (k, factor) in self.stages.iter_mut().enumerate() {
            let own = batch.first_plane[k]..batch.first_plane[k + 1];
            let planes = plane_triangle(carried, &batch.planes[own.clone()], &weights.planes[own]);
            factor.set_stage(&diagonals[k], &u, &planes, &mut carried);
            if let Some(link) = batch.links.get(k) {
                factor.set_link(link, &ω[k]);
                u = factor.u;
            }
        }
    }

    /// Solves for the border and for one right-hand side together; `rhs` becomes the solution.
    ///
    /// - `θ_weight`: weight of θ in H
    /// - `both`: room for two columns
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
        let columns = batch.links.iter().flat_map(|link| &link.theta).zip(&rhs.y);
        for (both, (θ, rhs)) in both.y.iter_mut().zip(columns) {
            *both = [*θ, rhs[0]];
        }
        self.sweep(both);
        for (both, (rhs, border)) in both.z.iter().zip(rhs.z.iter_mut().zip(&mut self.border.z)) {
            ([border[0]], [rhs[0]]) = ([both[0]], [both[1]]);
        }
        for (both, (rhs, border)) in both.y.iter().zip(rhs.y.iter_mut().zip(&mut self.border.y)) {
            ([border[0]], [rhs[0]]) = ([both[0]], [both[1]]);
        }
        self.border_pivot = θ_weight - border_product(batch, &self.border.y);
        self.subtract_border(batch, rhs);
    }

    /// Solves for one right-hand side, in place.
    #[inline(always)]
    pub fn solve(&self, batch: &Batch<S>, rhs: &mut Columns<S, 1>) {
        self.sweep(rhs);
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
    fn sweep<const C: usize>(&self, rhs: &mut Columns<S, C>) {
        let (stages, _) = rhs.z.as_chunks_mut::<STAGE>();
        let (links, _) = rhs.y.as_chunks_mut::<LINK>();
        let last = links.len();
        let mut next = stages[0];
        for (k, factor) in self.stages[..last].iter().enumerate() {
            let mut w = next;
            next = stages[k + 1];
            factor.g.solve_transposed(&mut w);
            subtract_transposed_product(&mut links[k], &factor.v, &w);
            factor.m.solve_transposed(&mut links[k]);
            add_transposed_product(&mut next, &factor.u, &links[k]);
            if factor.spans {
                let coupled: &mut Matrix<S, NEXT, C> = next.first_chunk_mut().expect("a stage is longer");
                subtract_transposed_product(coupled, &factor.t, &w);
            }
            stages[k] = w;
        }
        self.stages[last].g.solve_transposed(&mut next);
        self.stages[last].g.solve(&mut next);
        stages[last] = next;
        for (k, factor) in self.stages[..last].iter().enumerate().rev() {
            let (w, y) = (&mut stages[k], &mut links[k]);
            subtract_product(y, &factor.u, &next);
            for value in y.as_flattened_mut() {
                *value = -*value;
            }
            factor.m.solve(y);
            subtract_product(w, &factor.v, y);
            if factor.spans {
                subtract_product(w, &factor.t, next.first_chunk().expect("a stage is longer"));
            }
            factor.g.solve(w);
            next = *w;
        }
    }
}

impl<S: Vector> StageFactor<S> {
    /// G and T, from the diagonal, the stage before (`u`) and the planes; `carried` becomes what they leave to the next.
    #[inline(always)]
    fn set_stage(
        &mut self,
        diagonal: &[Lanes<S>; STAGE],
        u: &Matrix<S, LINK, STAGE>,
        planes: &PlaneTriangle<S>,
        carried: &mut Matrix<S, NEXT, NEXT>,
    ) {
        let zero = diagonal[0].like(0.0);
        let mut rows = [[zero; STAGE]; LINK + NEXT];
        rows[..LINK].copy_from_slice(u);
        for (i, row) in rows[LINK..].iter_mut().enumerate() {
            let plane = planes.root.row(i);
            (row[0], row[1]) = (plane[0], plane[1]);
        }
        self.g.set_diagonal(diagonal);
        self.spans = planes.span;
        if planes.span {
            self.t = [[zero; NEXT]; STAGE];
            let mut tail = [[zero; NEXT]; LINK + NEXT];
            for (i, row) in tail[LINK..].iter_mut().enumerate() {
                let plane = planes.root.row(i);
                (row[0], row[1]) = (plane[2], plane[3]);
            }
            self.g.append_with_tail(&mut rows, &mut self.t, &mut tail);
            let mut left = SquareRoot::<S, NEXT>::zero_like(zero);
            let mut own = [[zero; NEXT]; NEXT];
            for (i, row) in own.iter_mut().enumerate() {
                let plane = planes.root.row(NEXT + i);
                (row[0], row[1]) = (plane[2], plane[3]);
            }
            left.append(&mut own);
            left.append(&mut tail);
            *carried = [*left.row(0), *left.row(1)];
        } else {
            self.g.append(&mut rows);
            *carried = [[zero; NEXT]; NEXT];
        }
        self.g.finish();
    }

    /// V, M and U, from the link after the stage.
    #[inline(always)]
    fn set_link(&mut self, link: &Link<S>, ω: &[Lanes<S>; LINK]) {
        for i in 0..STAGE {
            for row in 0..LINK {
                self.v[i][row] = link.left[row][i];
            }
        }
        self.g.solve_transposed(&mut self.v);
        self.m.set_diagonal(ω);
        self.m.append(&mut { self.v });
        self.m.finish();
        self.u = link.right;
        if self.spans {
            for (row, u) in self.u.iter_mut().enumerate() {
                for (v, t) in self.v.iter().zip(&self.t) {
                    for i in 0..NEXT {
                        u[i] -= v[row] * t[i];
                    }
                }
            }
        }
        self.m.solve_transposed(&mut self.u);
    }
}

/// The planes of a stage, and what the stage before left to it, as a triangle in the variables that they live in.
struct PlaneTriangle<S: Vector> {
    root: SquareRoot<S, SPAN>,
    /// Does any of them reach the next stage?
    span: bool,
}

#[inline(always)]
fn plane_triangle<S: Vector>(
    carried: Matrix<S, NEXT, NEXT>,
    planes: &[PlaneRow<S>],
    weights: &[Lanes<S>],
) -> PlaneTriangle<S> {
    let zero = carried[0][0].like(0.0);
    let mut root = SquareRoot::zero_like(zero);
    let mut rows = [[zero; SPAN]; PLANES_AT_ONCE];
    for (row, [x, y]) in rows.iter_mut().zip(carried) {
        *row = [x, y, zero, zero];
    }
    let mut filled = NEXT;
    let mut span = false;
    for (plane, &weight) in planes.iter().zip(weights) {
        if filled == PLANES_AT_ONCE {
            root.append(&mut rows);
            rows = [[zero; SPAN]; PLANES_AT_ONCE];
            filled = 0;
        }
        let weight = weight.sqrt();
        let [a, b] = plane.here;
        let [c, d] = plane.next;
        rows[filled] = [weight * a, weight * b, weight * c, weight * d];
        filled += 1;
        span |= plane.spans;
    }
    root.append(&mut rows);
    PlaneTriangle { root, span }
}

/// Σ theta · y over the links.
#[inline(always)]
fn border_product<S: Vector>(batch: &Batch<S>, y: &[[Lanes<S>; 1]]) -> Lanes<S> {
    let (links, _) = y.as_chunks::<LINK>();
    let mut sum = Lanes::splat(batch.simd, 0.0);
    for (link, y) in batch.links.iter().zip(links) {
        for i in 0..LINK {
            sum = link.theta[i].mul_add(y[i][0], sum);
        }
    }
    sum
}
