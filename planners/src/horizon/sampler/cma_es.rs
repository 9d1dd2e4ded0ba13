//! Covariance matrix adaptation evolution strategy (Hansen, Ostermeier 2001), with the triangular root of the covariance as
//! in Suttorp, Hansen, Igel (2009).

use nalgebra::{Cholesky, DMatrix, DVector};

use super::{Sampler, SamplerDimensions};
use crate::horizon::counter_rng::CounterRng;
use crate::horizon::particle_batch::{ParticleBatch, ranking};
use crate::simd::WIDTH;

/// Initial standard deviation σ, as a fraction of the bound.
const INITIAL_DEVIATION: f64 = 0.3;

/// Number of iterations between two factorisations of the covariance.
const FACTORISATION_INTERVAL: usize = 2;

/// A normal distribution x = m + σ L z, z ~ N(0, I), with the covariance σ² L L^T.
#[derive(Clone, Debug)]
pub struct CmaEs {
    dimensions: SamplerDimensions,
    weights: Vec<f64>,
    rates: Rates,
    mean: DVector<f64>,
    σ: f64,
    covariance: DMatrix<f64>,
    root: DMatrix<f64>,
    path: DVector<f64>,
    σ_path: DVector<f64>,
    /// z of every particle.
    samples: Vec<DVector<f64>>,
    iteration: usize,
}

/// Learning rates, as recommended in Hansen (2016), table 1.
#[derive(Clone, Copy, Debug)]
struct Rates {
    μ_eff: f64,
    c_σ: f64,
    d_σ: f64,
    c_c: f64,
    c_1: f64,
    c_μ: f64,
    /// E |N(0, I)|.
    expected: f64,
}

impl Rates {
    fn new(n: f64, weights: &[f64]) -> Self {
        let μ_eff = 1.0 / weights.iter().map(|weight| weight * weight).sum::<f64>();
        let c_σ = (μ_eff + 2.0) / (n + μ_eff + 5.0);
        let c_1 = 2.0 / ((n + 1.3).powi(2) + μ_eff);
        Self {
            μ_eff,
            c_σ,
            d_σ: 1.0 + c_σ + 2.0 * (((μ_eff - 1.0) / (n + 1.0)).sqrt() - 1.0).max(0.0),
            c_c: (4.0 + μ_eff / n) / (n + 4.0 + 2.0 * μ_eff / n),
            c_1,
            c_μ: (1.0 - c_1).min(2.0 * (μ_eff - 2.0 + 1.0 / μ_eff) / ((n + 2.0).powi(2) + μ_eff)),
            expected: n.sqrt() * (1.0 - 1.0 / (4.0 * n) + 1.0 / (21.0 * n * n)),
        }
    }
}

impl CmaEs {
    /// Around `mean`.
    pub fn new(dimensions: SamplerDimensions, mean: Vec<f64>) -> Self {
        let n = mean.len();
        let half = dimensions.particles / 2;
        // weights that fall linearly with the rank: logarithms are not equal to the bit on every machine
        let raw: Vec<f64> = (0..half).map(|rank| (half - rank) as f64).collect();
        let sum: f64 = raw.iter().sum();
        let weights: Vec<f64> = raw.iter().map(|weight| weight / sum).collect();
        Self {
            rates: Rates::new(n as f64, &weights),
            dimensions,
            weights,
            mean: DVector::from_vec(mean),
            σ: INITIAL_DEVIATION * dimensions.bound_mps2,
            covariance: DMatrix::identity(n, n),
            root: DMatrix::identity(n, n),
            path: DVector::zeros(n),
            σ_path: DVector::zeros(n),
            samples: vec![DVector::zeros(n); dimensions.particles],
            iteration: 0,
        }
    }

    /// Updates mean, step size and covariance from the best particles' weighted means of z and L z.
    fn adapt(&mut self, best: &[usize]) {
        let Rates { μ_eff, c_σ, d_σ, c_c, c_1, c_μ, expected } = self.rates;
        let n = self.mean.len() as f64;
        let mut z = DVector::zeros(self.mean.len());
        let mut rank_μ = DMatrix::zeros(self.mean.len(), self.mean.len());
        for (&particle, &weight) in best.iter().zip(&self.weights) {
            let sample = &self.samples[particle];
            z.axpy(weight, sample, 1.0);
            let y = &self.root * sample;
            rank_μ.ger(weight, &y, &y, 1.0);
        }
        let y = &self.root * &z;
        self.mean.axpy(self.σ, &y, 1.0);
        self.σ_path = (1.0 - c_σ) * &self.σ_path + (c_σ * (2.0 - c_σ) * μ_eff).sqrt() * z;
        let length = self.σ_path.norm();
        let updates_path = length < (1.4 + 2.0 / (n + 1.0)) * expected;
        self.path = (1.0 - c_c) * &self.path + if updates_path { (c_c * (2.0 - c_c) * μ_eff).sqrt() } else { 0.0 } * y;
        self.covariance *= 1.0 - c_1 - c_μ;
        self.covariance.ger(c_1, &self.path, &self.path, 1.0);
        self.covariance += c_μ * rank_μ;
        self.σ *= exp_near_zero(c_σ / d_σ * (length / expected - 1.0));
    }
}

impl Sampler for CmaEs {
    fn propose(&mut self, iteration: usize, rng: CounterRng, batches: &mut [ParticleBatch]) {
        for particle in 0..self.dimensions.particles {
            let z = &mut self.samples[particle];
            for (unknown, value) in z.iter_mut().enumerate() {
                *value = rng.normal(self.dimensions.counter(iteration, particle, unknown));
            }
            let x = &self.mean + self.σ * (&self.root * &*z);
            batches[particle / WIDTH].set_particle(particle % WIDTH, x.as_slice());
        }
    }

    fn learn(&mut self, batches: &[ParticleBatch]) {
        let best: Vec<usize> = ranking(batches).iter().map(|&(batch, lane)| batch * WIDTH + lane).collect();
        self.adapt(&best[..self.weights.len()]);
        self.iteration += 1;
        if self.iteration.is_multiple_of(FACTORISATION_INTERVAL)
            && let Some(factor) = Cholesky::new(self.covariance.clone())
        {
            self.root = factor.unpack();
        }
    }
}

/// (1 + x/64)^64, an approximation of exp(x) for small x. Products alone are equal to the bit on every machine.
fn exp_near_zero(x: f64) -> f64 {
    (1.0 + x.clamp(-1.0, 1.0) / 64.0).powi(64)
}
