//! The loop of all samplers: propose, evaluate, learn, until the iterations are used up or the cost stalls.

use rayon::prelude::*;

use super::counter_rng::CounterRng;
use super::evaluate::{SimdLevel, evaluate};
use super::particle_batch::{Fitness, ParticleBatch, ranking};
use super::problem::{EvaluationContext, HorizonProblem};
use super::sampler::{SamplerDimensions, SamplerKind};
use crate::free_space::Point;
use crate::simd::WIDTH;

/// Work of one iteration (particles · steps · obstacles) from which on it is spread over several threads.
const MIN_PARALLEL_WORK: usize = 20_000;

/// Improvement of the cost below which the search counts as stalled, m.
const MIN_IMPROVEMENT_M: f64 = 1e-3;

/// Number of particles whose paths are reported.
const REPORTED_PATHS: usize = 8;

/// Limits of the search.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Budget {
    /// Number of particles, rounded up to a multiple of four.
    pub particles: usize,
    /// Maximum number of iterations.
    pub max_iterations: usize,
    /// Iterations without an improvement of the best feasible cost after which the search ends.
    pub stall_iterations: Option<usize>,
}

/// Result of the search.
#[derive(Clone, Debug, PartialEq)]
pub struct Solution {
    /// The best controls, m/s²; length steps · axes, the coordinates of a step adjacent.
    pub controls: Vec<f64>,
    /// Their fitness.
    pub fitness: Fitness,
    /// Number of iterations.
    pub iterations: usize,
    /// First iteration with a feasible particle, from 0.
    pub first_feasible: Option<usize>,
    /// Fraction of the evaluated particles that were feasible.
    pub feasible_fraction: f64,
    /// Lowest cost so far after every iteration, m; absent while no particle is feasible.
    pub convergence: Vec<Option<f64>>,
    /// Paths of the best particles of the last iteration, m.
    pub paths: Vec<Vec<Point>>,
}

/// Searches for the best controls. The first iteration contains `seeds` as its first particles; a sampler with a mean
/// starts at the first of them.
///
/// # Panics
///
/// If the budget has no particles.
pub fn optimise(
    problem: &HorizonProblem<'_>,
    sampler: SamplerKind,
    budget: Budget,
    seeds: &[Vec<f64>],
    rng: CounterRng,
    simd_level: SimdLevel,
) -> Solution {
    let particles = budget.particles.div_ceil(WIDTH) * WIDTH;
    let dimensions = SamplerDimensions {
        grid: problem.grid,
        particles,
        iterations: budget.max_iterations,
        bound_mps2: problem.limits.acceleration_mps2,
    };
    let context = problem.evaluation_context();
    let keeps_best = sampler.keeps_best();
    let mut sampler = sampler.create(dimensions, seeds.first().map(Vec::as_slice));
    let mut batches = vec![ParticleBatch::new(problem.grid); particles / WIDTH];
    let mut incumbent = Incumbent::new(problem.grid.unknowns());
    for iteration in 0..budget.max_iterations {
        sampler.propose(iteration, rng, &mut batches);
        if iteration == 0 {
            insert_seeds(seeds, &mut batches);
        } else if keeps_best {
            incumbent.reinsert(&mut batches);
        }
        evaluate_all(problem, &context, &mut batches, simd_level);
        incumbent.update(iteration, &batches);
        if budget.stall_iterations.is_some_and(|stall| incumbent.has_stalled(iteration, stall)) {
            break;
        }
        sampler.learn(&batches);
    }
    incumbent.into_solution(&batches)
}

fn evaluate_all(
    problem: &HorizonProblem<'_>,
    context: &EvaluationContext<'_>,
    batches: &mut [ParticleBatch],
    simd_level: SimdLevel,
) {
    let obstacles = 1 + context.static_obstacles.len() + context.moving_obstacles.len();
    if batches.len() * problem.grid.steps * obstacles * WIDTH >= MIN_PARALLEL_WORK {
        batches.par_iter_mut().for_each(|batch| evaluate(problem, context, batch, simd_level));
    } else {
        batches.iter_mut().for_each(|batch| evaluate(problem, context, batch, simd_level));
    }
}

/// Replaces the first particles by the seeds.
fn insert_seeds(seeds: &[Vec<f64>], batches: &mut [ParticleBatch]) {
    for (particle, seed) in seeds.iter().enumerate().take(batches.len() * WIDTH) {
        batches[particle / WIDTH].set_particle(particle % WIDTH, seed);
    }
}

/// The best particle so far, and statistics of the search.
struct Incumbent {
    controls: Vec<f64>,
    fitness: Fitness,
    /// Fitness at the last significant improvement, and its iteration.
    improved: (Fitness, usize),
    first_feasible: Option<usize>,
    feasible: usize,
    evaluated: usize,
    convergence: Vec<Option<f64>>,
}

impl Incumbent {
    fn new(unknowns: usize) -> Self {
        Self {
            controls: vec![0.0; unknowns],
            fitness: Fitness::WORST,
            improved: (Fitness::WORST, 0),
            first_feasible: None,
            feasible: 0,
            evaluated: 0,
            convergence: Vec::new(),
        }
    }

    /// Replaces the last particle by the incumbent, which samplers that draw from a distribution would lose.
    fn reinsert(&self, batches: &mut [ParticleBatch]) {
        let last = batches.len() - 1;
        batches[last].set_particle(WIDTH - 1, &self.controls);
    }

    fn update(&mut self, iteration: usize, batches: &[ParticleBatch]) {
        for batch in batches {
            for lane in 0..WIDTH {
                let fitness = batch.fitness[lane];
                self.evaluated += 1;
                self.feasible += usize::from(fitness.is_feasible());
                if fitness.beats(self.fitness) {
                    self.fitness = fitness;
                    self.controls = batch.particle(lane);
                }
            }
        }
        self.convergence.push(self.fitness.is_feasible().then_some(self.fitness.cost));
        if self.feasible > 0 {
            self.first_feasible.get_or_insert(iteration);
        }
        let (improved, _) = self.improved;
        if self.fitness.violation < improved.violation || self.fitness.cost < improved.cost - MIN_IMPROVEMENT_M {
            self.improved = (self.fitness, iteration);
        }
    }

    fn has_stalled(&self, iteration: usize, stall_iterations: usize) -> bool {
        self.fitness.is_feasible() && iteration >= self.improved.1 + stall_iterations
    }

    fn into_solution(self, batches: &[ParticleBatch]) -> Solution {
        let path = |&(batch, lane): &(usize, usize)| {
            let batch: &ParticleBatch = &batches[batch];
            (0..batch.path.len()).map(|sample| batch.position(sample, lane)).collect()
        };
        Solution {
            controls: self.controls,
            fitness: self.fitness,
            iterations: self.convergence.len(),
            first_feasible: self.first_feasible,
            feasible_fraction: self.feasible as f64 / self.evaluated.max(1) as f64,
            convergence: self.convergence,
            paths: ranking(batches).iter().take(REPORTED_PATHS).map(path).collect(),
        }
    }
}
