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

use nalgebra::{SMatrix, SVector};

use super::kernels::SquareRoot;
use super::program::{LINK, Link, Program, STAGE};

type StageVector = SVector<f64, STAGE>;
type LinkVector = SVector<f64, LINK>;
type Coupling = SMatrix<f64, STAGE, 2>;

/// The matrix of the Newton system, apart from E.
#[derive(Clone, Debug)]
pub struct Weights {
    /// Diagonal of H from boxes, elastic bounds and pins; length of z.
    pub diagonal: Vec<f64>,
    /// Weight 1/ω of every plane.
    pub planes: Vec<f64>,
    /// Ω of the link rows, length `LINK K`.
    pub links: Vec<f64>,
}

/// Factors of the block sweep, and the response to the border.
#[derive(Clone, Debug)]
pub struct BlockSystem {
    /// G_k.
    stages: Vec<SquareRoot<STAGE>>,
    /// T_k.
    couplings: Vec<Coupling>,
    links: Vec<LinkFactor>,
    /// Solution for the border column, over z and over the link rows.
    border_z: Vec<f64>,
    border_y: Vec<f64>,
    border_pivot: f64,
}

#[derive(Clone, Debug)]
struct LinkFactor {
    /// V_k.
    v: SMatrix<f64, STAGE, LINK>,
    /// M_k.
    m: SquareRoot<LINK>,
    /// U_k.
    u: SMatrix<f64, LINK, STAGE>,
}

impl BlockSystem {
    /// Room for programmes of `intervals` links.
    pub fn new(intervals: usize) -> Self {
        let link = LinkFactor { v: SMatrix::zeros(), m: SquareRoot::zero(), u: SMatrix::zeros() };
        Self {
            stages: vec![SquareRoot::zero(); intervals + 1],
            couplings: vec![Coupling::zeros(); intervals + 1],
            links: vec![link; intervals],
            border_z: vec![0.0; STAGE * (intervals + 1) + 1],
            border_y: vec![0.0; LINK * intervals],
            border_pivot: 0.0,
        }
    }

    /// Factors the matrix that `program` and `weights` give.
    pub fn factor(&mut self, program: &Program, weights: &Weights) {
        let mut planes = program.planes.iter().zip(&weights.planes).peekable();
        let (diagonals, _) = weights.diagonal.as_chunks::<STAGE>();
        let (ω, _) = weights.links.as_chunks::<LINK>();
        let mut carried = SquareRoot::<2>::zero();
        for (k, &diagonal) in diagonals.iter().enumerate() {
            let (g, t) = (&mut self.stages[k], &mut self.couplings[k]);
            g.set_diagonal(&StageVector::from(diagonal));
            t.fill(0.0);
            if k > 0 {
                g.append(&mut self.links[k - 1].u.clone());
                for row in carried.upper().row_iter() {
                    g.append(&mut stage_row(row[0], row[1]));
                }
            }
            carried = SquareRoot::zero();
            while let Some((plane, &weight)) = planes.next_if(|(plane, _)| plane.stage == k) {
                let root = weight.sqrt();
                let mut tail = SMatrix::from([[root * plane.next[0]], [root * plane.next[1]]]);
                g.append_with_tail(&mut stage_row(root * plane.here[0], root * plane.here[1]), t, &mut tail);
                carried.append(&mut tail);
            }
            g.finish();
            if let Some(link) = program.links.get(k) {
                self.links[k].factor(g, t, link, &LinkVector::from(ω[k]));
            }
        }
        self.factor_border(program, weights);
    }

    fn factor_border(&mut self, program: &Program, weights: &Weights) {
        let mut z = std::mem::take(&mut self.border_z);
        let mut y = std::mem::take(&mut self.border_y);
        z.fill(0.0);
        for (row, link) in y.as_chunks_mut::<LINK>().0.iter_mut().zip(&program.links) {
            *row = link.theta.into();
        }
        self.sweep(&mut z, &mut y);
        let last = z.len() - 1;
        self.border_pivot = weights.diagonal[last] - border_product(program, &y);
        self.border_z = z;
        self.border_y = y;
    }

    /// Solves for one right-hand side, in place: `z` holds r_z and becomes dz, `y` holds r_y of the link rows and
    /// becomes dy.
    pub fn solve(&self, program: &Program, z: &mut [f64], y: &mut [f64]) {
        let last = z.len() - 1;
        let r_θ = z[last];
        self.sweep(z, y);
        let θ = (r_θ - border_product(program, y)) / self.border_pivot;
        for (value, border) in z.iter_mut().zip(&self.border_z) {
            *value -= border * θ;
        }
        for (value, border) in y.iter_mut().zip(&self.border_y) {
            *value -= border * θ;
        }
        z[last] = θ;
    }

    /// Forward and backward substitution over the stages, without the border.
    fn sweep(&self, z: &mut [f64], y: &mut [f64]) {
        let (stages, _) = z.as_chunks_mut::<STAGE>();
        let (rows, _) = y.as_chunks_mut::<LINK>();
        for (k, link) in self.links.iter().enumerate() {
            let mut w = StageVector::from(stages[k]);
            self.stages[k].solve_transposed(&mut w);
            let mut row = LinkVector::from(rows[k]) - link.v.tr_mul(&w);
            link.m.solve_transposed(&mut row);
            stages[k] = w.into();
            rows[k] = row.into();
            let mut next = StageVector::from(stages[k + 1]) + link.u.tr_mul(&row);
            let coupled = self.couplings[k].tr_mul(&w);
            (next[0], next[1]) = (next[0] - coupled[0], next[1] - coupled[1]);
            stages[k + 1] = next.into();
        }
        let last = self.links.len();
        let mut next = StageVector::from(stages[last]);
        self.stages[last].solve_transposed(&mut next);
        self.stages[last].solve(&mut next);
        stages[last] = next.into();
        for (k, link) in self.links.iter().enumerate().rev() {
            let mut row = link.u * next - LinkVector::from(rows[k]);
            link.m.solve(&mut row);
            let mut w = StageVector::from(stages[k]) - link.v * row - self.couplings[k] * next.fixed_rows::<2>(0);
            self.stages[k].solve(&mut w);
            rows[k] = row.into();
            stages[k] = w.into();
            next = w;
        }
    }
}

impl LinkFactor {
    fn factor(&mut self, g: &SquareRoot<STAGE>, t: &Coupling, link: &Link, ω: &LinkVector) {
        self.v = link.left.transpose();
        g.solve_transposed(&mut self.v);
        self.m.set_diagonal(ω);
        self.m.append(&mut self.v.clone());
        self.m.finish();
        self.u = link.right;
        let mut coupled = self.u.fixed_columns_mut::<2>(0);
        coupled -= self.v.tr_mul(t);
        self.m.solve_transposed(&mut self.u);
    }
}

fn stage_row(x: f64, y: f64) -> SMatrix<f64, 1, STAGE> {
    let mut row = SMatrix::zeros();
    (row[0], row[1]) = (x, y);
    row
}

fn border_product(program: &Program, y: &[f64]) -> f64 {
    let (rows, _) = y.as_chunks::<LINK>();
    program.links.iter().zip(rows).map(|(link, row)| link.theta.dot(&LinkVector::from(*row))).sum()
}
