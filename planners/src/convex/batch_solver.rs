//! The solver for single programs, and for many: in batches of four, the batches in parallel.

use std::sync::{Mutex, MutexGuard, PoisonError};

use rayon::prelude::*;

use super::backend::Backend;
use super::interior_point::Solver;
use super::program::Program;
use super::solution::{Settings, Solution};
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
}

impl InteriorPoint {
    /// A solver with an empty workspace, which the first solve sizes.
    pub fn new(settings: Settings) -> Self {
        Self::with_backend(settings, Backend::Block)
    }

    /// A solver that computes the Newton direction by `backend`.
    pub fn with_backend(settings: Settings, backend: Backend) -> Self {
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
        }
    }
}

/// BatchSolver for many programs at a time: work vectors are made once and kept.
#[derive(Debug)]
pub struct BatchSolver {
    settings: Settings,
    idle: Mutex<Vec<InteriorPoint>>,
}

impl BatchSolver {
    /// Without solvers; they are created when needed.
    pub fn new(settings: Settings) -> Self {
        Self { settings, idle: Mutex::new(Vec::new()) }
    }

    /// Solves independent programs; returns their solutions in order. Each solution is bit-identical to the one that
    /// the program has on its own.
    pub fn solve_all(&self, programs: &[Program]) -> Vec<Solution> {
        let same_shape = programs.chunk_by(Program::has_shape_of);
        let batches: Vec<&[Program]> = same_shape.flat_map(|run| run.chunks(WIDTH)).collect();
        let solutions: Vec<Vec<Solution>> = batches.par_iter().map(|batch| self.solve_batch(batch)).collect();
        solutions.concat()
    }

    fn solve_batch(&self, batch: &[Program]) -> Vec<Solution> {
        let mut solver = self.idle().pop().unwrap_or_else(|| InteriorPoint::new(self.settings.clone()));
        let solutions = solver.solve_batch(&batch.iter().collect::<Vec<_>>());
        self.idle().push(solver);
        solutions
    }

    fn idle(&self) -> MutexGuard<'_, Vec<InteriorPoint>> {
        self.idle.lock().unwrap_or_else(PoisonError::into_inner)
    }
}
