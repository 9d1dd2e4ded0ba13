//! Particle swarm optimisation (eq. 13, 14), with the feasibility-driven inertia of eq. 15 as an option.

use super::{Sampler, SamplerDimensions};
use crate::horizon::counter_rng::CounterRng;
use crate::horizon::particle_batch::{Fitness, ParticleBatch, PerParticle};
use crate::simd::WIDTH;

/// Parameters of the swarm.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SwarmSettings {
    /// c_1: attraction by the particle's own best position.
    pub cognitive: f64,
    /// c_2: attraction by the swarm's best position.
    pub social: f64,
    /// Inertia weight w.
    pub inertia: Inertia,
    /// Bound on a particle's velocity, as a fraction of the bound on its controls.
    pub velocity_fraction: f64,
    /// The position changes by w v, as eq. 13 is printed; otherwise by v.
    pub moves_as_printed: bool,
    /// The best particle so far takes the place of the last one in every iteration: not in the paper.
    pub keeps_best: bool,
}

/// Inertia weight w(k) = w_max - (w_max - w_min) k/k_max (eq. 14).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Inertia {
    /// w_max.
    pub first: f64,
    /// w_min.
    pub last: f64,
    /// Infeasible particles have w_max = max(w_min, 1 - F/max F) with their violation F (eq. 15) in eq. 14: the larger the
    /// violation, the stronger the attraction by the best positions.
    pub by_violation: bool,
}

impl SwarmSettings {
    /// The swarm of eq. 13 and 14.
    pub const STANDARD: Self = Self {
        cognitive: 1.5,
        social: 1.5,
        inertia: Inertia { first: 0.9, last: 0.4, by_violation: false },
        velocity_fraction: 0.5,
        moves_as_printed: false,
        keeps_best: true,
    };

    /// The same with eq. 15.
    pub const FEASIBILITY_DRIVEN: Self =
        Self { inertia: Inertia { by_violation: true, ..Self::STANDARD.inertia }, ..Self::STANDARD };
}

impl Inertia {
    fn at(&self, progress: f64, violation: f64, worst_violation: f64) -> f64 {
        let first = if self.by_violation && violation > 0.0 {
            (1.0 - violation / worst_violation).max(self.last)
        } else {
            self.first
        };
        first - (first - self.last) * progress
    }
}

/// The swarm.
#[derive(Clone, Debug)]
pub struct ParticleSwarm {
    dimensions: SamplerDimensions,
    settings: SwarmSettings,
    /// State of four particles each.
    batches: Vec<BatchState>,
    best: Vec<f64>,
    best_fitness: Fitness,
    worst_violation: f64,
}

/// State of four particles between the iterations.
#[derive(Clone, Debug)]
struct BatchState {
    /// v of eq. 13.
    velocity: Vec<PerParticle>,
    /// P_i.
    best: Vec<PerParticle>,
    best_fitness: [Fitness; WIDTH],
    violation: PerParticle,
}

impl ParticleSwarm {
    /// A swarm that starts uniformly distributed within the bounds.
    pub fn new(dimensions: SamplerDimensions, settings: SwarmSettings) -> Self {
        let unknowns = dimensions.grid.unknowns();
        let zero = vec![[0.0; WIDTH]; unknowns];
        let state = BatchState {
            velocity: zero.clone(),
            best: zero,
            best_fitness: [Fitness::WORST; WIDTH],
            violation: [0.0; WIDTH],
        };
        Self {
            dimensions,
            settings,
            batches: vec![state; dimensions.particles / WIDTH],
            best: vec![0.0; unknowns],
            best_fitness: Fitness::WORST,
            worst_violation: 0.0,
        }
    }

    fn sample_uniform(&self, rng: CounterRng, batches: &mut [ParticleBatch]) {
        for (b, batch) in batches.iter_mut().enumerate() {
            for (unknown, controls) in batch.controls.iter_mut().enumerate() {
                for (lane, control) in controls.iter_mut().enumerate() {
                    let [uniform, _] = rng.uniform_pair(self.dimensions.counter(0, b * WIDTH + lane, unknown));
                    *control = (2.0 * uniform - 1.0) * self.dimensions.bound_mps2;
                }
            }
        }
    }

    fn inertia(&self, iteration: usize, batch: usize) -> PerParticle {
        let progress = iteration as f64 / self.dimensions.iterations as f64;
        self.batches[batch]
            .violation
            .map(|violation| self.settings.inertia.at(progress, violation, self.worst_violation))
    }
}

impl Sampler for ParticleSwarm {
    fn propose(&mut self, iteration: usize, rng: CounterRng, batches: &mut [ParticleBatch]) {
        if iteration == 0 {
            return self.sample_uniform(rng, batches);
        }
        let (bound, max_velocity) =
            (self.dimensions.bound_mps2, self.settings.velocity_fraction * self.dimensions.bound_mps2);
        for (b, batch) in batches.iter_mut().enumerate() {
            let inertia = self.inertia(iteration, b);
            let position_factor = if self.settings.moves_as_printed { inertia } else { [1.0; WIDTH] };
            let state = &mut self.batches[b];
            for (unknown, controls) in batch.controls.iter_mut().enumerate() {
                let (own_best, best) = (state.best[unknown], self.best[unknown]);
                let velocity = &mut state.velocity[unknown];
                for lane in 0..WIDTH {
                    let [r1, r2] = rng.uniform_pair(self.dimensions.counter(iteration, b * WIDTH + lane, unknown));
                    let u = controls[lane];
                    // v <- w v + c1 r1 (P - u) + c2 r2 (G - u), u <- u + v (eq. 13)
                    let attraction =
                        self.settings.cognitive * r1 * (own_best[lane] - u) + self.settings.social * r2 * (best - u);
                    velocity[lane] = (inertia[lane] * velocity[lane] + attraction).clamp(-max_velocity, max_velocity);
                    controls[lane] = (u + position_factor[lane] * velocity[lane]).clamp(-bound, bound);
                }
            }
        }
    }

    fn learn(&mut self, batches: &[ParticleBatch]) {
        self.worst_violation = 0.0;
        for (state, batch) in self.batches.iter_mut().zip(batches) {
            for lane in 0..WIDTH {
                let fitness = batch.fitness[lane];
                state.violation[lane] = fitness.violation;
                self.worst_violation = self.worst_violation.max(fitness.violation);
                if !fitness.beats(state.best_fitness[lane]) {
                    continue;
                }
                state.best_fitness[lane] = fitness;
                for (best, control) in state.best.iter_mut().zip(&batch.controls) {
                    best[lane] = control[lane];
                }
                if fitness.beats(self.best_fitness) {
                    self.best_fitness = fitness;
                    self.best = batch.particle(lane);
                }
            }
        }
    }
}
