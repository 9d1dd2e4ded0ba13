//! Mehrotra's predictor-corrector loop, on up to four programmes at once.

use super::backend::{Backend, NewtonSystem};
use super::batch::Batch;
use super::certificate::certified_gap;
use super::iterate::Iterate;
use super::lanes::{Lanes, Vector, WIDTH};
use super::newton::Newton;
use super::program::Program;
use super::progress::{Progress, Watch};
use super::solution::{Settings, Solution, Status};
use super::ties::{Measures, tie};

/// Share of the tolerated gap at which the path's parameter stops falling: going on would only wear out the digits.
const CENTRE_FLOOR: f64 = 0.4;

/// Relative gap below which directions are refined.
const REFINE_BELOW: f64 = 1e-4;

/// The method with all its work vectors, which are kept from solve to solve.
#[derive(Clone, Debug)]
pub struct Solver<S: Vector> {
    settings: Settings,
    batch: Batch<S>,
    at: Iterate<S>,
    newton: Newton<S>,
    system: NewtonSystem<S>,
    measures: Measures<S>,
    /// 1 for lanes that still move, 0 for those that have ended.
    moving: Lanes<S>,
    /// 1 for lanes whose weights are so far apart that directions want iterative refinement, 0 for the others.
    near_the_end: Lanes<S>,
    watches: [Watch; WIDTH],
    best: [Vec<f64>; WIDTH],
}

/// Parts of an iteration, each compiled as one piece for the machine's vector instructions.
#[derive(Clone, Copy, Debug)]
enum Stage {
    Start,
    Factor,
    Predict,
    Correct,
    Refine,
    Step,
}

impl<S: Vector> Solver<S> {
    /// Room for nothing yet.
    pub fn new(simd: S, settings: Settings, backend: Backend) -> Self {
        let (batch, zero) = (Batch::new(simd), Lanes::splat(simd, 0.0));
        Self {
            at: Iterate::new(),
            newton: Newton::new(simd),
            system: NewtonSystem::new(simd, backend),
            measures: Measures { products: zero, objective: zero },
            moving: zero,
            near_the_end: zero,
            watches: std::array::from_fn(|_| Watch::new(&settings)),
            best: std::array::from_fn(|_| Vec::new()),
            batch,
            settings,
        }
    }

    /// Solves up to [`WIDTH`] programmes of one shape (see [`Program::has_shape_of`]); one solution each, in their order.
    pub fn solve(&mut self, programs: &[&Program]) -> Vec<Solution> {
        let refused: Vec<bool> = programs.iter().map(|program| !program.is_well_posed()).collect();
        let Some(first) = programs.iter().zip(&refused).find_map(|(program, refused)| (!refused).then_some(*program))
        else {
            return programs.iter().map(|program| Solution::refused(program)).collect();
        };
        // idle lanes carry a copy of the first that can be solved
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
        self.newton.fit(&self.batch);
        self.system.begin(&self.batch, programs[0]);
        self.moving = Lanes::new(self.batch.simd, is_solved.map(f64::from));
        self.near_the_end = self.moving.like(0.0);
        self.watches = std::array::from_fn(|_| Watch::new(&self.settings));
        self.best.iter_mut().for_each(|best| best.resize(self.batch.len(), 0.0));
    }

    fn iterate(&mut self) {
        self.run(Stage::Start);
        self.watch(0);
        for iteration in 1..=self.settings.max_iterations {
            if self.moving.to_array() == [0.0; WIDTH] {
                return;
            }
            self.run(Stage::Factor);
            self.run(Stage::Predict);
            self.run(Stage::Correct);
            if self.near_the_end.to_array() != [0.0; WIDTH] {
                self.run(Stage::Refine);
            }
            self.run(Stage::Step);
            self.watch(iteration);
        }
    }

    /// Notes where every lane is, and stops those that have ended.
    fn watch(&mut self, iteration: usize) {
        let [products, objectives] = [self.measures.products, self.measures.objective].map(Lanes::to_array);
        for lane in 0..WIDTH {
            if self.moving.lane(lane) == 0.0 {
                continue;
            }
            let watch = &mut self.watches[lane];
            let now = Progress::new(products[lane], objectives[lane], iteration);
            self.near_the_end.set_lane(lane, f64::from(now.gap < REFINE_BELOW));
            if watch.is_best(now) {
                for (best, z) in self.best[lane].iter_mut().zip(&self.at.z) {
                    *best = z.lane(lane);
                }
            }
            if watch.status() != Status::IterationLimit {
                self.moving.set_lane(lane, 0.0);
                self.near_the_end.set_lane(lane, 0.0);
            }
        }
    }

    fn solution(&self, program: &Program, lane: usize) -> Solution {
        let (z, watch) = (self.best[lane].clone(), &self.watches[lane]);
        let (objective, gap) = certified_gap(program, &z, &self.at.multipliers(&self.batch, lane));
        let status = match watch.status() {
            // what the slacks say must hold without them
            Status::Solved if gap > 2.0 * self.settings.tolerance || gap.is_nan() => Status::Stalled,
            status => status,
        };
        Solution { status, z, objective, gap, iterations: watch.iterations() }
    }

    fn run(&mut self, stage: Stage) {
        let simd = self.batch.simd;
        simd.vectorize(Run { solver: self, stage });
    }

    #[inline(always)]
    fn start(&mut self) {
        self.at.start(&self.batch, self.settings.start);
        self.measures = tie(&self.batch, &mut self.at);
    }

    #[inline(always)]
    fn factor(&mut self) {
        self.newton.weigh(&self.batch, &mut self.at);
        self.system.factor(&self.batch, &self.at, &self.newton.weights);
    }

    /// Affine direction (σ = 0).
    #[inline(always)]
    fn predict(&mut self) {
        self.system.solve_first(&self.batch, &self.at, &mut self.newton);
    }

    /// Centred and corrected direction: σ = (μ_aff/μ)^3.
    #[inline(always)]
    fn correct(&mut self) {
        let [trust, rows] = self.newton.affine_tallies(&self.batch, &self.at);
        let one = trust.products.like(1.0);
        let α_p = trust.loss.room.max(rows.loss.force).recip().min(one);
        let α_d = trust.loss.force.max(rows.loss.room).recip().min(one);
        let before = self.measures.products;
        let after = trust.products_after(α_p, α_d) + rows.products_after(α_d, α_p);
        let share = after.max(one.like(0.0)).over(before);
        let floor = self.measures.objective.abs().max(one) * one.like(CENTRE_FLOOR * self.settings.tolerance);
        let σμ = (share * share * share * before).max(floor).over(self.batch.pairs);
        self.newton.centre(&self.batch, &mut self.at, σμ);
        self.system.solve(&self.batch, &self.at, &mut self.newton);
    }

    #[inline(always)]
    fn refine(&mut self) {
        let mask = self.near_the_end.is_above(self.near_the_end.like(0.5));
        self.system.refine(&self.batch, &self.at, &mut self.newton, mask);
    }

    /// As far along the direction as room and forces last.
    #[inline(always)]
    fn step(&mut self) {
        let losses = self.newton.losses(&self.batch, &self.at);
        let (one, τ) = (losses.primal.like(1.0), losses.primal.like(self.settings.boundary_share));
        let α_p = τ.over(losses.primal).min(one) * self.moving;
        let α_d = τ.over(losses.dual).min(one) * self.moving;
        self.newton.advance(&self.batch, &mut self.at, α_p, α_d);
        self.measures = tie(&self.batch, &mut self.at);
    }
}

struct Run<'a, S: Vector> {
    solver: &'a mut Solver<S>,
    stage: Stage,
}

impl<S: Vector> pulp::WithSimd for Run<'_, S> {
    type Output = ();

    #[inline(always)]
    fn with_simd<T: pulp::Simd>(self, _: T) {
        match self.stage {
            Stage::Start => self.solver.start(),
            Stage::Factor => self.solver.factor(),
            Stage::Predict => self.solver.predict(),
            Stage::Correct => self.solver.correct(),
            Stage::Refine => self.solver.refine(),
            Stage::Step => self.solver.step(),
        }
    }
}
