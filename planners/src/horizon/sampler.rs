//! Samplers: each proposes particles and adapts to their fitness.

mod cma_es;
mod cross_entropy;
mod particle_swarm;
mod path_integral;

use super::counter_rng::CounterRng;
use super::particle_batch::ParticleBatch;
use super::problem::ControlGrid;
use crate::simd::WIDTH;

pub use particle_swarm::{Inertia, SwarmSettings};

/// A sampling-based optimiser of the controls.
pub trait Sampler {
    /// Sets the controls of all particles.
    fn propose(&mut self, iteration: usize, rng: CounterRng, batches: &mut [ParticleBatch]);
    /// Adapts to the fitness of the particles, and to their controls after projection.
    fn learn(&mut self, batches: &[ParticleBatch]);
}

/// Which sampler.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum SamplerKind {
    /// Particle swarm (eq. 13, 14), with or without the inertia of infeasible particles (eq. 15).
    ParticleSwarm(SwarmSettings),
    /// Cross-entropy method: a normal distribution is fitted to the best particles (Rubinstein 1999).
    CrossEntropy,
    /// Model predictive path integral: a mean weighted by the exponential of the cost (Williams et al. 2017).
    PathIntegral,
    /// Covariance matrix adaptation (Hansen, Ostermeier 2001).
    CmaEs,
}

/// Size of the problem, common to all samplers.
#[derive(Clone, Copy, Debug)]
pub struct SamplerDimensions {
    /// The unknowns.
    pub grid: ControlGrid,
    /// Number of particles, a multiple of four.
    pub particles: usize,
    /// Maximum number of iterations.
    pub iterations: usize,
    /// Bound on each control, m/s².
    pub bound_mps2: f64,
}

impl SamplerDimensions {
    /// Counter of a random number for [`CounterRng`].
    #[inline]
    fn counter(&self, iteration: usize, particle: usize, unknown: usize) -> u64 {
        ((iteration * self.particles + particle) * self.grid.unknowns() + unknown) as u64
    }

    /// Sets each control to mean + deviation · N(0, 1), with the `distribution` (mean, deviation) of its unknown.
    fn sample_normal(
        &self,
        iteration: usize,
        rng: CounterRng,
        distribution: impl Fn(usize) -> (f64, f64),
        batches: &mut [ParticleBatch],
    ) {
        for (b, batch) in batches.iter_mut().enumerate() {
            for (unknown, controls) in batch.controls.iter_mut().enumerate() {
                let (mean, deviation) = distribution(unknown);
                for (lane, control) in controls.iter_mut().enumerate() {
                    let normal = rng.normal(self.counter(iteration, b * WIDTH + lane, unknown));
                    *control = mean + deviation * normal;
                }
            }
        }
    }
}

impl SamplerKind {
    /// Whether the best particle so far takes the place of the last one.
    pub fn keeps_best(self) -> bool {
        match self {
            Self::ParticleSwarm(settings) => settings.keeps_best,
            Self::CrossEntropy | Self::PathIntegral | Self::CmaEs => true,
        }
    }

    /// A sampler that starts around `guess`, or around zero without one.
    pub fn create(self, dimensions: SamplerDimensions, guess: Option<&[f64]>) -> Box<dyn Sampler> {
        let mean = guess.map_or_else(|| vec![0.0; dimensions.grid.unknowns()], <[f64]>::to_vec);
        match self {
            Self::ParticleSwarm(settings) => Box::new(particle_swarm::ParticleSwarm::new(dimensions, settings)),
            Self::CrossEntropy => Box::new(cross_entropy::CrossEntropy::new(dimensions, mean)),
            Self::PathIntegral => Box::new(path_integral::PathIntegral::new(dimensions, mean)),
            Self::CmaEs => Box::new(cma_es::CmaEs::new(dimensions, mean)),
        }
    }
}
