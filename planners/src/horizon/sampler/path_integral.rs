//! Model predictive path integral control, iterated: the mean moves to the particles' mean, weighted by exp(-J/λ).

use super::{Sampler, SamplerDimensions};
use crate::horizon::counter_rng::CounterRng;
use crate::horizon::particle_batch::{ParticleBatch, ranking};

/// Standard deviation in the first and the last iteration, as fractions of the bound.
const DEVIATION_RANGE: [f64; 2] = [0.5, 0.02];

/// Temperature λ, as a fraction of the difference between the best and the median cost of the feasible particles.
const TEMPERATURE_FRACTION: f64 = 0.3;

/// Samples about a mean, with a deviation that shrinks linearly with the iterations.
#[derive(Clone, Debug)]
pub struct PathIntegral {
    dimensions: SamplerDimensions,
    mean: Vec<f64>,
}

impl PathIntegral {
    /// Around `mean`.
    pub fn new(dimensions: SamplerDimensions, mean: Vec<f64>) -> Self {
        Self { dimensions, mean }
    }

    fn deviation(&self, iteration: usize) -> f64 {
        let [first, last] = DEVIATION_RANGE;
        let progress = iteration as f64 / self.dimensions.iterations as f64;
        (first + (last - first) * progress) * self.dimensions.bound_mps2
    }
}

impl Sampler for PathIntegral {
    fn propose(&mut self, iteration: usize, rng: CounterRng, batches: &mut [ParticleBatch]) {
        let deviation = self.deviation(iteration);
        self.dimensions.sample_normal(iteration, rng, |unknown| (self.mean[unknown], deviation), batches);
    }

    fn learn(&mut self, batches: &[ParticleBatch]) {
        let ranking = ranking(batches);
        let fitness = |&(batch, lane): &(usize, usize)| batches[batch].fitness[lane];
        let feasible = ranking.iter().take_while(|index| fitness(index).is_feasible()).count();
        // without a feasible particle the violation takes the place of the cost
        let count = if feasible > 0 { feasible } else { ranking.len() };
        let cost = |index: &(usize, usize)| if feasible > 0 { fitness(index).cost } else { fitness(index).violation };
        let best = cost(&ranking[0]);
        let λ = (TEMPERATURE_FRACTION * (cost(&ranking[count / 2]) - best)).max(f64::MIN_POSITIVE);
        let weights: Vec<f64> = ranking[..count].iter().map(|index| exp_of_minus((cost(index) - best) / λ)).collect();
        let total: f64 = weights.iter().sum();
        for (unknown, mean) in self.mean.iter_mut().enumerate() {
            let terms = ranking.iter().zip(&weights);
            *mean = terms.map(|(&(batch, lane), weight)| weight / total * batches[batch].controls[unknown][lane]).sum();
        }
    }
}

/// (1 - x/64)^64, an approximation of exp(-x) for x >= 0 that is zero from 64 on. Products alone are equal to the bit on
/// every machine.
fn exp_of_minus(x: f64) -> f64 {
    (1.0 - x / 64.0).max(0.0).powi(64)
}
