//! Cross-entropy method: mean and deviations follow those of the best particles.

use super::{Sampler, SamplerDimensions};
use crate::horizon::counter_rng::CounterRng;
use crate::horizon::particle_batch::{ParticleBatch, ranking};

/// Fraction of the particles to which the distribution is fitted.
const ELITE_FRACTION: f64 = 0.2;

/// Weight of the old distribution in the new one.
const SMOOTHING: f64 = 0.2;

/// Initial standard deviation, as a fraction of the bound.
const INITIAL_DEVIATION: f64 = 0.5;

/// Smallest standard deviation, as a fraction of the bound.
const MIN_DEVIATION: f64 = 0.005;

/// A normal distribution with independent coordinates.
#[derive(Clone, Debug)]
pub struct CrossEntropy {
    dimensions: SamplerDimensions,
    mean: Vec<f64>,
    deviation: Vec<f64>,
}

impl CrossEntropy {
    /// Around `mean`.
    pub fn new(dimensions: SamplerDimensions, mean: Vec<f64>) -> Self {
        let deviation = vec![INITIAL_DEVIATION * dimensions.bound_mps2; mean.len()];
        Self { dimensions, mean, deviation }
    }
}

impl Sampler for CrossEntropy {
    fn propose(&mut self, iteration: usize, rng: CounterRng, batches: &mut [ParticleBatch]) {
        let distribution = |unknown: usize| (self.mean[unknown], self.deviation[unknown]);
        self.dimensions.sample_normal(iteration, rng, distribution, batches);
    }

    fn learn(&mut self, batches: &[ParticleBatch]) {
        let count = ((ELITE_FRACTION * self.dimensions.particles as f64) as usize).max(2);
        let elite = &ranking(batches)[..count];
        for unknown in 0..self.mean.len() {
            let value = |&(batch, lane): &(usize, usize)| -> f64 { batches[batch].controls[unknown][lane] };
            let mean = elite.iter().map(value).sum::<f64>() / count as f64;
            let variance = elite.iter().map(|index| (value(index) - mean).powi(2)).sum::<f64>() / count as f64;
            let min_deviation = MIN_DEVIATION * self.dimensions.bound_mps2;
            self.mean[unknown] += (1.0 - SMOOTHING) * (mean - self.mean[unknown]);
            let deviation = SMOOTHING * self.deviation[unknown] + (1.0 - SMOOTHING) * variance.sqrt();
            self.deviation[unknown] = deviation.max(min_deviation);
        }
    }
}
