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
//! S_k     = Ω_k + V_k^T V_k  =  M_k^T M_k,    U_k = M_k^-T R_k
//! P_{k+1} = H_{k+1} + U_k^T U_k
//! ```
//!
//! The triangles G and M are made from the square roots of the terms by orthogonal transformations, not from their
//! sums: near the solution weights spread over more than twenty orders of magnitude, and a soft direction (a load
//! factor between its bounds) would drown in the rounding of a stiff one (an equation of motion).
//!
//! O(K 9^3) per factorisation, no index arrays, no allocation.

use nalgebra::{SMatrix, SVector};

use super::kernels::SquareRoot;
use super::program::{LINK, Program, STAGE};

type StageVector = SVector<f64, STAGE>;
type LinkVector = SVector<f64, LINK>;

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
        for (k, &diagonal) in diagonals.iter().enumerate() {
            let g = &mut self.stages[k];
            g.set_diagonal(&StageVector::from(diagonal));
            while let Some((plane, &weight)) = planes.next_if(|(plane, _)| plane.stage == k) {
                let root = weight.sqrt();
                let mut row = SMatrix::<f64, 1, STAGE>::zeros();
                (row[0], row[1]) = (root * plane.normal[0], root * plane.normal[1]);
                g.append(&mut row);
            }
            if k > 0 {
                g.append(&mut self.links[k - 1].u.clone());
            }
            g.finish();
            if let Some(link) = program.links.get(k) {
                self.links[k].factor(g, &link.left, &link.right, &LinkVector::from(ω[k]));
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
            stages[k + 1] = (StageVector::from(stages[k + 1]) + link.u.tr_mul(&row)).into();
        }
        let last = self.links.len();
        let mut next = StageVector::from(stages[last]);
        self.stages[last].solve_transposed(&mut next);
        self.stages[last].solve(&mut next);
        stages[last] = next.into();
        for (k, link) in self.links.iter().enumerate().rev() {
            let mut row = link.u * next - LinkVector::from(rows[k]);
            link.m.solve(&mut row);
            let mut w = StageVector::from(stages[k]) - link.v * row;
            self.stages[k].solve(&mut w);
            rows[k] = row.into();
            stages[k] = w.into();
            next = w;
        }
    }
}

impl LinkFactor {
    fn factor(
        &mut self,
        g: &SquareRoot<STAGE>,
        left: &SMatrix<f64, LINK, STAGE>,
        right: &SMatrix<f64, LINK, STAGE>,
        ω: &LinkVector,
    ) {
        self.v = left.transpose();
        g.solve_transposed(&mut self.v);
        self.m.set_diagonal(ω);
        self.m.append(&mut self.v.clone());
        self.m.finish();
        self.u = *right;
        self.m.solve_transposed(&mut self.u);
    }
}

fn border_product(program: &Program, y: &[f64]) -> f64 {
    let (rows, _) = y.as_chunks::<LINK>();
    program.links.iter().zip(rows).map(|(link, row)| link.theta.dot(&LinkVector::from(*row))).sum()
}
