//! The solver for single programs, and for many: in batches of four, the batches in parallel.

use std::sync::{Mutex, MutexGuard, PoisonError};

use rayon::prelude::*;

use super::backend::Backend;
use super::interior_point::Solver;
use super::program::Program;
use super::reference_methods::InfeasibleLoop;
use super::solution::{Settings, Solution, Start};
use crate::simd::WIDTH;

/// The customised interior-point method with its workspace, compiled for the vector instructions of the processor.
#[derive(Clone, Debug)]
pub struct InteriorPoint {
    solver: SimdDispatch,
}

#[derive(Clone, Debug)]
enum SimdDispatch {
    /// AVX2 and FMA: four lanes in one register.
    #[cfg(target_arch = "x86_64")]
    V3(Box<Solver<pulp::x86::V3>>),
    /// Any processor.
    Portable(Box<Solver<pulp::Scalar256b>>),
    /// The paper's loop, which uses no vector instructions of its own.
    Infeasible(Box<InfeasibleLoop>),
}

impl InteriorPoint {
    /// A solver with an empty workspace, which the first solve sizes.
    pub fn new(settings: Settings) -> Self {
        Self::with_backend(settings, Backend::Block)
    }

    /// A solver that computes the Newton direction by `backend`. Panics for an infeasible start with the block
    /// factorisation, which has none.
    pub fn with_backend(settings: Settings, backend: Backend) -> Self {
        if settings.start == Start::Infeasible {
            return Self { solver: SimdDispatch::Infeasible(Box::new(InfeasibleLoop::new(settings, backend))) };
        }
        #[cfg(target_arch = "x86_64")]
        if let Some(simd) = pulp::x86::V3::try_new() {
            return Self { solver: SimdDispatch::V3(Box::new(Solver::new(simd, settings, backend))) };
        }
        Self { solver: SimdDispatch::Portable(Box::new(Solver::new(pulp::Scalar256b, settings, backend))) }
    }

    /// A solver without vector instructions: slower, with bit-identical results.
    pub fn portable(settings: Settings) -> Self {
        Self { solver: SimdDispatch::Portable(Box::new(Solver::new(pulp::Scalar256b, settings, Backend::Block))) }
    }

    /// Solves one program.
    pub fn solve(&mut self, program: &Program) -> Solution {
        self.solve_batch(&[program]).remove(0)
    }

    /// Solves up to four programs in one pass, as many as have the shape of the first. Reference backends: one.
    fn solve_batch(&mut self, programs: &[&Program]) -> Vec<Solution> {
        match &mut self.solver {
            #[cfg(target_arch = "x86_64")]
            SimdDispatch::V3(solver) => solver.solve(programs),
            SimdDispatch::Portable(solver) => solver.solve(programs),
            SimdDispatch::Infeasible(solver) => programs.iter().map(|program| solver.solve(program)).collect(),
        }
    }
}

/// BatchSolver for many programs at a time: work vectors are made once and kept.
#[derive(Debug)]
pub struct BatchSolver {
    settings: Settings,
    backend: Backend,
    idle: Mutex<Vec<InteriorPoint>>,
}

impl BatchSolver {
    /// Without solvers; they are created when needed.
    pub fn new(settings: Settings) -> Self {
        Self::with_backend(settings, Backend::Block)
    }

    /// The same with solvers that compute the Newton direction by `backend`.
    pub fn with_backend(settings: Settings, backend: Backend) -> Self {
        Self { settings, backend, idle: Mutex::new(Vec::new()) }
    }

    /// Number of programs that are solved in one pass.
    pub fn programs_per_pass(&self) -> usize {
        if self.backend == Backend::Block { WIDTH } else { 1 }
    }

    /// Solves independent programs; returns their solutions in order. Each solution is bit-identical to the one that
    /// the program has on its own.
    pub fn solve_all(&self, programs: &[Program]) -> Vec<Solution> {
        let same_shape = programs.chunk_by(Program::has_shape_of);
        let batches: Vec<&[Program]> = same_shape.flat_map(|run| run.chunks(self.programs_per_pass())).collect();
        let solutions: Vec<Vec<Solution>> = batches.par_iter().map(|batch| self.solve_batch(batch)).collect();
        solutions.concat()
    }

    fn solve_batch(&self, batch: &[Program]) -> Vec<Solution> {
        let mut solver =
            self.idle().pop().unwrap_or_else(|| InteriorPoint::with_backend(self.settings.clone(), self.backend));
        let solutions = solver.solve_batch(&batch.iter().collect::<Vec<_>>());
        self.idle().push(solver);
        solutions
    }

    fn idle(&self) -> MutexGuard<'_, Vec<InteriorPoint>> {
        self.idle.lock().unwrap_or_else(PoisonError::into_inner)
    }
}
