//! Mehrotra's predictor-corrector loop, on up to four programs at once.

use super::backend::Backend;
use super::batch::Batch;
use super::certificate::certified_gap;
use super::convergence::{ConvergenceMonitor, Progress};
use super::feasibility::{Measures, restore_feasibility};
use super::iterate::Iterate;
use super::newton::NewtonSystem;
use super::newton_solver::NewtonSolver;
use super::program::Program;
use super::solution::{Settings, Solution, Status};
use crate::simd::{Lanes, Simd4, WIDTH};

/// Lower bound of the centring target, as a fraction of the tolerated gap: smaller targets only lose accuracy.
const MIN_TARGET_FRACTION: f64 = 0.4;

/// Relative gap below which directions get a step of iterative refinement.
const REFINE_BELOW: f64 = 1e-4;

/// Number of steps of iterative refinement of every direction of a program with rows of large weight.
const STIFF_REFINEMENTS: f64 = 3.0;

/// The method and its workspace, which is kept from solve to solve.
#[derive(Clone, Debug)]
pub struct Solver<S: Simd4> {
    settings: Settings,
    batch: Batch<S>,
    at: Iterate<S>,
    newton: NewtonSystem<S>,
    newton_solver: NewtonSolver<S>,
    measures: Measures<S>,
    /// 1 for lanes that are still iterating, 0 for those that have ended.
    active: Lanes<S>,
    /// Number of refinements of the directions of every lane.
    refinements: Lanes<S>,
    /// Those that are left for the current direction.
    refinements_left: Lanes<S>,
    monitors: [ConvergenceMonitor; WIDTH],
    best: [Vec<f64>; WIDTH],
}

/// Steps of the method, each compiled as one function with the processor's vector instructions.
#[derive(Clone, Copy, Debug)]
enum Step {
    Initialise,
    Factor,
    Predict,
    Correct,
    Refine,
    Advance,
}

impl<S: Simd4> Solver<S> {
    /// An empty workspace.
    pub fn new(simd: S, settings: Settings, backend: Backend) -> Self {
        let (batch, zero) = (Batch::new(simd), Lanes::splat(simd, 0.0));
        Self {
            at: Iterate::new(),
            newton: NewtonSystem::new(simd),
            newton_solver: NewtonSolver::new(simd, backend),
            measures: Measures { products: zero, objective: zero },
            active: zero,
            refinements: zero,
            refinements_left: zero,
            monitors: std::array::from_fn(|_| ConvergenceMonitor::new(&settings)),
            best: std::array::from_fn(|_| Vec::new()),
            batch,
            settings,
        }
    }

    /// Solves up to [`WIDTH`] programs of one shape (see [`Program::has_shape_of`]); returns their solutions in order.
    pub fn solve(&mut self, programs: &[&Program]) -> Vec<Solution> {
        let refused: Vec<bool> = programs.iter().map(|program| !program.is_well_posed()).collect();
        let Some(first) = programs.iter().zip(&refused).find_map(|(program, refused)| (!refused).then_some(*program))
        else {
            return programs.iter().map(|program| Solution::refused(program)).collect();
        };
        // lanes without a program of their own solve a copy of the first well-posed one
        let is_solved = |lane: usize| refused.get(lane) == Some(&false);
        let lanes = std::array::from_fn(|lane| if is_solved(lane) { programs[lane] } else { first });
        self.begin(lanes, std::array::from_fn(is_solved));
        self.iterate();
        let solution = |(lane, program): (usize, &&Program)| {
            if is_solved(lane) { self.solution(program, lane) } else { Solution::refused(program) }
        };
        programs.iter().enumerate().map(solution).collect()
    }

    fn begin(&mut self, programs: [&Program; WIDTH], is_solved: [bool; WIDTH]) {
        self.batch.set(programs);
        self.newton.resize(&self.batch);
        self.newton_solver.begin(&self.batch, programs[0]);
        self.active = Lanes::new(self.batch.simd, is_solved.map(f64::from));
        self.refinements = self.active.like(0.0);
        self.monitors = std::array::from_fn(|_| ConvergenceMonitor::new(&self.settings));
        self.best.iter_mut().for_each(|best| best.resize(self.batch.len(), 0.0));
    }

    fn iterate(&mut self) {
        self.run(Step::Initialise);
        self.monitor(0);
        for iteration in 1..=self.settings.max_iterations {
            if self.active.to_array() == [0.0; WIDTH] {
                return;
            }
            self.run(Step::Factor);
            self.run(Step::Predict);
            self.run(Step::Correct);
            self.refinements_left = self.refinements;
            while self.refinements_left.to_array() != [0.0; WIDTH] {
                self.run(Step::Refine);
            }
            self.run(Step::Advance);
            self.monitor(iteration);
        }
    }

    /// Records the iterate of every lane and deactivates the lanes that have ended.
    fn monitor(&mut self, iteration: usize) {
        let [products, objectives] = [self.measures.products, self.measures.objective].map(Lanes::to_array);
        for lane in 0..WIDTH {
            if self.active.lane(lane) == 0.0 {
                continue;
            }
            let monitor = &mut self.monitors[lane];
            let now = Progress::new(products[lane], objectives[lane], iteration);
            let plain = f64::from(now.gap < REFINE_BELOW);
            self.refinements.set_lane(lane, if self.batch.is_stiff(lane) { STIFF_REFINEMENTS } else { plain });
            if monitor.record(now) {
                for (best, z) in self.best[lane].iter_mut().zip(&self.at.z) {
                    *best = z.lane(lane);
                }
            }
            if monitor.status() != Status::IterationLimit {
                self.active.set_lane(lane, 0.0);
                self.refinements.set_lane(lane, 0.0);
            }
        }
    }

    fn solution(&self, program: &Program, lane: usize) -> Solution {
        let (z, monitor) = (self.best[lane].clone(), &self.monitors[lane]);
        let (objective, gap) = certified_gap(program, &z, &self.at.multipliers(&self.batch, lane));
        let status = match monitor.status() {
            // the gap of the complementarity products must hold for the program data, too
            Status::Solved if gap > 2.0 * self.settings.tolerance || gap.is_nan() => Status::Stalled,
            status => status,
        };
        Solution { status, z, objective, gap, iterations: monitor.iterations() }
    }

    fn run(&mut self, step: Step) {
        let simd = self.batch.simd;
        simd.vectorize(Run { solver: self, step });
    }

    #[inline(always)]
    fn initialise(&mut self) {
        self.at.start(&self.batch, self.settings.initial_barrier);
        self.measures = restore_feasibility(&self.batch, &mut self.at);
    }

    #[inline(always)]
    fn factor(&mut self) {
        self.newton.compute_weights(&self.batch, &mut self.at);
        self.newton_solver.factor(&self.batch, &self.at, &self.newton.weights);
    }

    /// Computes the affine direction (σ = 0).
    #[inline(always)]
    fn predict(&mut self) {
        self.newton_solver.solve_first(&self.batch, &self.at, &mut self.newton);
    }

    /// Computes the centred and corrected direction, σ = (μ_aff/μ)^3 [Mehrotra 1992].
    #[inline(always)]
    fn correct(&mut self) {
        let [trust_region, rows] = self.newton.affine_summaries(&self.batch, &self.at);
        let one = trust_region.products.like(1.0);
        let α_p = trust_region.decrease.slack.max(rows.decrease.dual).recip().min(one);
        let α_d = trust_region.decrease.dual.max(rows.decrease.slack).recip().min(one);
        let before = self.measures.products;
        let after = trust_region.products_after(α_p, α_d) + rows.products_after(α_d, α_p);
        let ratio = after.max(one.like(0.0)).over(before);
        let floor = self.measures.objective.abs().max(one) * one.like(MIN_TARGET_FRACTION * self.settings.tolerance);
        let σμ = (ratio * ratio * ratio * before).max(floor).over(self.batch.pairs);
        self.newton.set_centred_rhs(&self.batch, &mut self.at, σμ);
        self.newton_solver.solve(&self.batch, &self.at, &mut self.newton);
    }

    #[inline(always)]
    fn refine(&mut self) {
        let one = self.refinements_left.like(1.0);
        let mask = self.refinements_left.is_above(one.like(0.5));
        self.newton_solver.refine(&self.batch, &self.at, &mut self.newton, mask);
        self.refinements_left = (self.refinements_left - one).max(one.like(0.0));
    }

    /// Takes the longest step for which all slacks and duals stay positive, times the boundary fraction.
    #[inline(always)]
    fn advance(&mut self) {
        let decrease = self.newton.max_decrease(&self.batch, &self.at);
        let (one, τ) = (decrease.primal.like(1.0), decrease.primal.like(self.settings.boundary_fraction));
        let α_p = τ.over(decrease.primal).min(one) * self.active;
        let α_d = τ.over(decrease.dual).min(one) * self.active;
        self.newton.advance(&self.batch, &mut self.at, α_p, α_d);
        self.measures = restore_feasibility(&self.batch, &mut self.at);
    }
}

struct Run<'a, S: Simd4> {
    solver: &'a mut Solver<S>,
    step: Step,
}

impl<S: Simd4> pulp::WithSimd for Run<'_, S> {
    type Output = ();

    #[inline(always)]
    fn with_simd<T: pulp::Simd>(self, _: T) {
        match self.step {
            Step::Initialise => self.solver.initialise(),
            Step::Factor => self.solver.factor(),
            Step::Predict => self.solver.predict(),
            Step::Correct => self.solver.correct(),
            Step::Refine => self.solver.refine(),
            Step::Advance => self.solver.advance(),
        }
    }
}
