//! The search at one instant: propose, evaluate, learn, until the iterations are used up or nothing improves.

use rayon::prelude::*;

use super::draw::Draws;
use super::evaluate::Machine;
use super::group::{Fitness, Group};
use super::question::{Question, Surroundings};
use super::sampler::{Frame, Method};
use crate::free_space::vector::Point;
use crate::lanes::WIDTH;

/// Work of one iteration (steps of particles times obstacles) from which on several threads pay.
const WORTH_THREADS: usize = 20_000;

/// Improvement of the cost below which the search has stalled, m.
const STALL_M: f64 = 1e-3;

/// Paths that are kept to be shown.
const SHOWN: usize = 8;

/// How much may be spent, and on what.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Budget {
    /// Particles, rounded up to a multiple of four.
    pub particles: usize,
    /// Iterations at most.
    pub iterations: usize,
    /// The search ends when the best feasible cost has not improved for so many iterations.
    pub stall: Option<usize>,
}

/// What the search has found.
#[derive(Clone, Debug, PartialEq)]
pub struct Found {
    /// The best controls, m/s², coordinate by coordinate, step by step.
    pub controls: Vec<f64>,
    /// How good they are.
    pub fitness: Fitness,
    /// Iterations.
    pub iterations: usize,
    /// The first iteration with a feasible particle, from 0.
    pub first_feasible: Option<usize>,
    /// Share of the evaluated particles that were feasible.
    pub feasible_share: f64,
    /// Paths of the best particles of the last iteration, m.
    pub paths: Vec<Vec<Point>>,
}

/// Looks for the best controls. `seeds` take the first particles' places in the first iteration; a sampler with a centre
/// begins at the first of them.
pub fn optimise(
    question: &Question<'_>,
    method: Method,
    budget: Budget,
    seeds: &[Vec<f64>],
    draws: Draws,
    machine: Machine,
) -> Found {
    let particles = budget.particles.div_ceil(WIDTH) * WIDTH;
    let frame = Frame {
        grid: question.grid,
        particles,
        iterations: budget.iterations,
        bound_mps2: question.limits.acceleration_mps2,
    };
    let surroundings = question.surroundings();
    let mut sampler = method.sampler(frame, seeds.first().map(Vec::as_slice));
    let mut groups = vec![Group::new(question.grid); particles / WIDTH];
    let mut record = Record::new(question.grid.unknowns());
    for iteration in 0..budget.iterations {
        sampler.propose(iteration, draws, &mut groups);
        if iteration == 0 {
            plant(seeds, &mut groups);
        } else {
            record.keep_alive(&mut groups);
        }
        evaluate(question, &surroundings, &mut groups, machine);
        record.take_in(iteration, &groups);
        if budget.stall.is_some_and(|stall| record.has_stalled(iteration, stall)) {
            break;
        }
        sampler.learn(&groups);
    }
    record.found(question, &groups)
}

fn evaluate(question: &Question<'_>, surroundings: &Surroundings<'_>, groups: &mut [Group], machine: Machine) {
    let near = 1 + surroundings.standing.len() + surroundings.moving.len();
    if groups.len() * question.grid.steps * near * WIDTH >= WORTH_THREADS {
        groups.par_iter_mut().for_each(|group| machine.evaluate(question, surroundings, group));
    } else {
        groups.iter_mut().for_each(|group| machine.evaluate(question, surroundings, group));
    }
}

/// Puts seeds into the first particles.
fn plant(seeds: &[Vec<f64>], groups: &mut [Group]) {
    for (particle, seed) in seeds.iter().enumerate().take(groups.len() * WIDTH) {
        groups[particle / WIDTH].set_particle(particle % WIDTH, seed);
    }
}

/// The best so far, and how it came about.
struct Record {
    controls: Vec<f64>,
    fitness: Fitness,
    /// Best cost at the last true improvement, and when that was.
    improved: (Fitness, usize),
    first_feasible: Option<usize>,
    feasible: usize,
    evaluated: usize,
    iterations: usize,
}

impl Record {
    fn new(unknowns: usize) -> Self {
        Self {
            controls: vec![0.0; unknowns],
            fitness: Fitness::WORST,
            improved: (Fitness::WORST, 0),
            first_feasible: None,
            feasible: 0,
            evaluated: 0,
            iterations: 0,
        }
    }

    /// The last particle is the best so far: samplers that draw from a distribution would lose it.
    fn keep_alive(&self, groups: &mut [Group]) {
        let last = groups.len() - 1;
        groups[last].set_particle(WIDTH - 1, &self.controls);
    }

    fn take_in(&mut self, iteration: usize, groups: &[Group]) {
        self.iterations = iteration + 1;
        for group in groups {
            for lane in 0..WIDTH {
                let fitness = group.fitness[lane];
                self.evaluated += 1;
                self.feasible += usize::from(fitness.is_feasible());
                if fitness.beats(self.fitness) {
                    self.fitness = fitness;
                    self.controls = group.particle(lane);
                }
            }
        }
        if self.feasible > 0 {
            self.first_feasible.get_or_insert(iteration);
        }
        let (improved, _) = self.improved;
        if self.fitness.violation < improved.violation || self.fitness.cost < improved.cost - STALL_M {
            self.improved = (self.fitness, iteration);
        }
    }

    fn has_stalled(&self, iteration: usize, stall: usize) -> bool {
        self.fitness.is_feasible() && iteration >= self.improved.1 + stall
    }

    fn found(self, question: &Question<'_>, groups: &[Group]) -> Found {
        let mut ranking: Vec<_> =
            (0..groups.len()).flat_map(|group| (0..WIDTH).map(move |lane| (group, lane))).collect();
        ranking.sort_by(|&(g, l), &(h, m)| groups[g].fitness[l].order(groups[h].fitness[m]));
        let path = |&(group, lane): &(usize, usize)| {
            let group: &Group = &groups[group];
            (0..=question.grid.steps).map(|sample| group.position(sample, lane)).collect()
        };
        Found {
            controls: self.controls,
            fitness: self.fitness,
            iterations: self.iterations,
            first_feasible: self.first_feasible,
            feasible_share: self.feasible as f64 / self.evaluated.max(1) as f64,
            paths: ranking.iter().take(SHOWN).map(path).collect(),
        }
    }
}
