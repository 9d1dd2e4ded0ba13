//! Many programmes: in groups of four, the groups in parallel.

use std::sync::{Mutex, MutexGuard, PoisonError};

use rayon::prelude::*;

use super::backend::Backend;
use super::interior_point::Solver;
use super::lanes::WIDTH;
use super::program::Program;
use super::solution::{Settings, Solution};

/// The customised interior-point method with its work vectors, for the machine's instructions.
#[derive(Clone, Debug)]
pub struct InteriorPoint {
    machine: Machine,
}

#[derive(Clone, Debug)]
enum Machine {
    /// AVX2: four numbers in one register.
    #[cfg(target_arch = "x86_64")]
    V3(Box<Solver<pulp::x86::V3>>),
    /// Whatever the compiler makes of four numbers.
    Portable(Box<Solver<pulp::Scalar256b>>),
}

impl InteriorPoint {
    /// Nothing solved yet; work vectors grow to the size of the first programme and stay.
    pub fn new(settings: Settings) -> Self {
        Self::with_backend(settings, Backend::Block)
    }

    /// The same with another way to the Newton direction.
    pub fn with_backend(settings: Settings, backend: Backend) -> Self {
        #[cfg(target_arch = "x86_64")]
        if let Some(simd) = pulp::x86::V3::try_new() {
            return Self { machine: Machine::V3(Box::new(Solver::new(simd, settings, backend))) };
        }
        Self { machine: Machine::Portable(Box::new(Solver::new(pulp::Scalar256b, settings, backend))) }
    }

    /// Without the machine's vector instructions: slower, with the same result to the last digit.
    pub fn portable(settings: Settings) -> Self {
        Self { machine: Machine::Portable(Box::new(Solver::new(pulp::Scalar256b, settings, Backend::Block))) }
    }

    /// Solves one programme.
    pub fn solve(&mut self, program: &Program) -> Solution {
        self.solve_group(&[program]).remove(0)
    }

    /// Solves up to four programmes in one pass, as many as have the shape of the first. Paper backends: one.
    fn solve_group(&mut self, programs: &[&Program]) -> Vec<Solution> {
        match &mut self.machine {
            #[cfg(target_arch = "x86_64")]
            Machine::V3(solver) => solver.solve(programs),
            Machine::Portable(solver) => solver.solve(programs),
        }
    }
}

/// Solvers for many programmes at a time: work vectors are made once and kept.
#[derive(Debug)]
pub struct Solvers {
    settings: Settings,
    idle: Mutex<Vec<InteriorPoint>>,
}

impl Solvers {
    /// None yet; they are made as they are needed.
    pub fn new(settings: Settings) -> Self {
        Self { settings, idle: Mutex::new(Vec::new()) }
    }

    /// Solves programmes that know nothing of each other: each solution is the one that the programme has alone, to the
    /// last digit, whatever its neighbours.
    pub fn solve_all(&self, programs: &[Program]) -> Vec<Solution> {
        let alike = programs.chunk_by(Program::has_shape_of);
        let groups: Vec<&[Program]> = alike.flat_map(|alike| alike.chunks(WIDTH)).collect();
        let solutions: Vec<Vec<Solution>> = groups.par_iter().map(|group| self.solve_group(group)).collect();
        solutions.concat()
    }

    fn solve_group(&self, group: &[Program]) -> Vec<Solution> {
        let mut solver = self.idle().pop().unwrap_or_else(|| InteriorPoint::new(self.settings.clone()));
        let solutions = solver.solve_group(&group.iter().collect::<Vec<_>>());
        self.idle().push(solver);
        solutions
    }

    fn idle(&self) -> MutexGuard<'_, Vec<InteriorPoint>> {
        self.idle.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// [`Solvers::solve_all`], with solvers of its own.
pub fn solve_all(programs: &[Program], settings: &Settings) -> Vec<Solution> {
    Solvers::new(settings.clone()).solve_all(programs)
}
