//! Factors and solves the Newton system by the chosen backend.

use super::backend::Backend;
use super::batch::Batch;
use super::block::{BlockSystem, Columns, Weights};
use super::iterate::Iterate;
use super::newton::NewtonSystem;
use super::program::Program;
use super::reference_methods::ReferenceSystem;
use crate::simd::{Mask, Simd4};

/// The factors of the Newton system.
#[derive(Clone, Debug)]
pub enum NewtonSolver<S: Simd4> {
    /// Four lanes at once.
    Block {
        /// Factors.
        system: Box<BlockSystem<S>>,
        /// Work space: border column and right-hand side.
        both: Columns<S, 2>,
        /// Work space of a refinement.
        correction: Columns<S, 1>,
    },
    /// A method of the paper, in the first lane only.
    Reference(Box<ReferenceSystem>),
}

impl<S: Simd4> NewtonSolver<S> {
    /// A solver without factors.
    pub fn new(simd: S, backend: Backend) -> Self {
        match ReferenceSystem::new(backend) {
            Some(system) => Self::Reference(Box::new(system)),
            None => Self::Block {
                system: Box::new(BlockSystem::new(simd, 0)),
                both: Columns::zero(simd, 0),
                correction: Columns::zero(simd, 0),
            },
        }
    }

    /// Prepares for a solve; to be called before each. `first` is the program in the first lane.
    pub fn begin(&mut self, batch: &Batch<S>, first: &Program) {
        match self {
            Self::Block { system, both, correction } if both.intervals() != batch.intervals() => {
                **system = BlockSystem::new(batch.simd, batch.intervals());
                *both = Columns::zero(batch.simd, batch.intervals());
                *correction = Columns::zero(batch.simd, batch.intervals());
            }
            Self::Block { .. } => {}
            Self::Reference(system) => system.begin(first),
        }
    }

    /// Factors the matrix at `at`.
    #[inline(always)]
    pub fn factor(&mut self, batch: &Batch<S>, at: &Iterate<S>, weights: &Weights<S>) {
        match self {
            Self::Block { system, .. } => system.factor(batch, weights),
            Self::Reference(system) => system.factor(at),
        }
    }

    /// Computes the first direction with new factors; it overwrites the right-hand side in `newton.step`.
    #[inline(always)]
    pub fn solve_first(&mut self, batch: &Batch<S>, at: &Iterate<S>, newton: &mut NewtonSystem<S>) {
        match self {
            Self::Block { system, both, .. } => {
                let θ_weight = newton.weights.diagonal[batch.len() - 1];
                system.solve_with_border(batch, θ_weight, both, &mut newton.step);
                newton.recover_multipliers(batch, at);
            }
            Self::Reference(system) => system.solve(at, newton),
        }
    }

    /// Computes another direction with the same factors.
    #[inline(always)]
    pub fn solve(&mut self, batch: &Batch<S>, at: &Iterate<S>, newton: &mut NewtonSystem<S>) {
        match self {
            Self::Block { system, .. } => {
                system.solve(batch, &mut newton.step);
                newton.recover_multipliers(batch, at);
            }
            Self::Reference(system) => system.solve(at, newton),
        }
    }

    /// One step of iterative refinement in the lanes of `mask`. The reference methods refine within their solve.
    #[inline(always)]
    pub fn refine(&mut self, batch: &Batch<S>, at: &Iterate<S>, newton: &mut NewtonSystem<S>, mask: Mask<S>) {
        if let Self::Block { system, correction, .. } = self {
            newton.residuals(batch, at, correction);
            system.solve(batch, correction);
            newton.add_correction(correction, mask);
            newton.recover_multipliers(batch, at);
        }
    }
}

#[cfg(test)]
mod tests;
