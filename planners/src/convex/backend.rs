//! The seam between the loop and the ways to find a Newton direction.

use super::batch::Batch;
use super::block::{BlockSystem, Columns, Weights};
use super::iterate::Iterate;
use super::lanes::{Mask, Vector};
use super::newton::Newton;
use super::paper::PaperSystem;
use super::program::Program;

/// How the Newton direction is found. All of them find the same one; they differ in time and in the digits they lose.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Backend {
    /// The block sweep over the stages, in square roots, four programmes at a time: ours.
    #[default]
    Block,
    /// Method I of the paper: sparse LDL^T of the reduced matrix of P4, one symbolic analysis per shape.
    SparseLdl,
    /// Method II: the dense reduced matrix, n_X x n_X.
    DenseReduced,
    /// Method III: the whole KKT matrix as a dense one, (n_X + 2 n_A) x (n_X + 2 n_A).
    DenseKkt,
}

impl Backend {
    /// Every backend, ours first, then in the paper's order.
    pub const ALL: [Self; 4] = [Self::Block, Self::SparseLdl, Self::DenseReduced, Self::DenseKkt];

    /// Name in tables and files.
    pub fn name(self) -> &'static str {
        match self {
            Self::Block => "block",
            Self::SparseLdl => "sparse-ldl",
            Self::DenseReduced => "dense-reduced",
            Self::DenseKkt => "dense-kkt",
        }
    }
}

/// The Newton system by the chosen backend.
#[derive(Clone, Debug)]
pub enum NewtonSystem<S: Vector> {
    /// Four lanes at once.
    Block {
        /// The sweep.
        system: Box<BlockSystem<S>>,
        /// Room for the border and a right-hand side.
        both: Columns<S, 2>,
        /// Room for a refinement.
        correction: Columns<S, 1>,
    },
    /// One of the paper's, in the first lane only.
    Paper(Box<PaperSystem>),
}

impl<S: Vector> NewtonSystem<S> {
    /// No factors yet.
    pub fn new(simd: S, backend: Backend) -> Self {
        match PaperSystem::new(backend) {
            Some(paper) => Self::Paper(Box::new(paper)),
            None => Self::Block {
                system: Box::new(BlockSystem::new(simd, 0)),
                both: Columns::zero(simd, 0),
                correction: Columns::zero(simd, 0),
            },
        }
    }

    /// To be called before each solve; `first` is the programme of the first lane.
    pub fn begin(&mut self, batch: &Batch<S>, first: &Program) {
        match self {
            Self::Block { system, both, correction } if both.intervals() != batch.intervals() => {
                **system = BlockSystem::new(batch.simd, batch.intervals());
                *both = Columns::zero(batch.simd, batch.intervals());
                *correction = Columns::zero(batch.simd, batch.intervals());
            }
            Self::Block { .. } => {}
            Self::Paper(paper) => paper.begin(first),
        }
    }

    /// Factors the matrix at `at`.
    #[inline(always)]
    pub fn factor(&mut self, batch: &Batch<S>, at: &Iterate<S>, weights: &Weights<S>) {
        match self {
            Self::Block { system, .. } => system.factor(batch, weights),
            Self::Paper(paper) => paper.factor(at),
        }
    }

    /// The first direction with new factors; the right-hand side is in `newton.step` and becomes the direction.
    #[inline(always)]
    pub fn solve_first(&mut self, batch: &Batch<S>, at: &Iterate<S>, newton: &mut Newton<S>) {
        match self {
            Self::Block { system, both, .. } => {
                let θ_weight = newton.weights.diagonal[batch.len() - 1];
                system.solve_with_border(batch, θ_weight, both, &mut newton.step);
                newton.recover(batch, at);
            }
            Self::Paper(paper) => paper.direction(at, newton),
        }
    }

    /// Another direction with the same factors.
    #[inline(always)]
    pub fn solve(&mut self, batch: &Batch<S>, at: &Iterate<S>, newton: &mut Newton<S>) {
        match self {
            Self::Block { system, .. } => {
                system.solve(batch, &mut newton.step);
                newton.recover(batch, at);
            }
            Self::Paper(paper) => paper.direction(at, newton),
        }
    }

    /// One step of iterative refinement in the lanes of `mask`: what the direction leaves of the linear equations is
    /// solved for once more. The paper's ways do that by themselves.
    #[inline(always)]
    pub fn refine(&mut self, batch: &Batch<S>, at: &Iterate<S>, newton: &mut Newton<S>, mask: Mask<S>) {
        if let Self::Block { system, correction, .. } = self {
            newton.remainder(batch, at, correction);
            system.solve(batch, correction);
            newton.correct(correction, mask);
            newton.recover(batch, at);
        }
    }
}

#[cfg(test)]
mod tests;
