//! Covariance matrix adaptation: the distribution takes the shape of the cost (Hansen, Ostermeier 2001; here with the
//! triangular root of the covariance, as in Suttorp, Hansen, Igel 2009).

use nalgebra::{Cholesky, DMatrix, DVector};

use super::{Frame, Sampler, ranking};
use crate::horizon::draw::Draws;
use crate::horizon::group::Group;
use crate::lanes::WIDTH;

/// First deviation over the bound.
const FIRST_DEVIATION: f64 = 0.3;

/// Iterations between two factorisations of the covariance.
const REFACTOR: usize = 2;

/// A normal distribution x = m + σ L z with covariance σ² L L^T.
#[derive(Clone, Debug)]
pub struct CmaEs {
    frame: Frame,
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
    /// Around `center`.
    pub fn new(frame: Frame, center: Vec<f64>) -> Self {
        let n = center.len();
        let half = frame.particles / 2;
        // weights that fall linearly with the rank: logarithms have different digits on different machines
        let raw: Vec<f64> = (0..half).map(|rank| (half - rank) as f64).collect();
        let sum: f64 = raw.iter().sum();
        let weights: Vec<f64> = raw.iter().map(|weight| weight / sum).collect();
        Self {
            rates: Rates::new(n as f64, &weights),
            frame,
            weights,
            mean: DVector::from_vec(center),
            σ: FIRST_DEVIATION * frame.bound_mps2,
            covariance: DMatrix::identity(n, n),
            root: DMatrix::identity(n, n),
            path: DVector::zeros(n),
            σ_path: DVector::zeros(n),
            samples: vec![DVector::zeros(n); frame.particles],
            iteration: 0,
        }
    }

    /// Moves mean, width and covariance along the weighted means of z and L z.
    fn adapt(&mut self, best: &[usize]) {
        let Rates { μ_eff, c_σ, d_σ, c_c, c_1, c_μ, expected } = self.rates;
        let n = self.mean.len() as f64;
        let mut z = DVector::zeros(self.mean.len());
        let mut spread = DMatrix::zeros(self.mean.len(), self.mean.len());
        for (&particle, &weight) in best.iter().zip(&self.weights) {
            let sample = &self.samples[particle];
            z.axpy(weight, sample, 1.0);
            let y = &self.root * sample;
            spread.ger(weight, &y, &y, 1.0);
        }
        let y = &self.root * &z;
        self.mean.axpy(self.σ, &y, 1.0);
        self.σ_path = (1.0 - c_σ) * &self.σ_path + (c_σ * (2.0 - c_σ) * μ_eff).sqrt() * z;
        let length = self.σ_path.norm();
        let moves = length < (1.4 + 2.0 / (n + 1.0)) * expected;
        self.path = (1.0 - c_c) * &self.path + if moves { (c_c * (2.0 - c_c) * μ_eff).sqrt() } else { 0.0 } * y;
        self.covariance *= 1.0 - c_1 - c_μ;
        self.covariance.ger(c_1, &self.path, &self.path, 1.0);
        self.covariance += c_μ * spread;
        self.σ *= growing(c_σ / d_σ * (length / expected - 1.0));
    }
}

impl Sampler for CmaEs {
    fn propose(&mut self, iteration: usize, draws: Draws, groups: &mut [Group]) {
        for particle in 0..self.frame.particles {
            let z = &mut self.samples[particle];
            for (unknown, value) in z.iter_mut().enumerate() {
                *value = draws.normal(self.frame.place(iteration, particle, unknown));
            }
            let x = &self.mean + self.σ * (&self.root * &*z);
            groups[particle / WIDTH].set_particle(particle % WIDTH, x.as_slice());
        }
    }

    fn learn(&mut self, groups: &[Group]) {
        let best: Vec<usize> = ranking(groups).iter().map(|&(group, lane)| group * WIDTH + lane).collect();
        self.adapt(&best[..self.weights.len()]);
        self.iteration += 1;
        if self.iteration.is_multiple_of(REFACTOR)
            && let Some(factor) = Cholesky::new(self.covariance.clone())
        {
            self.root = factor.unpack();
        }
    }
}

/// exp(x) for small x, from products alone: the same digits on every machine.
fn growing(x: f64) -> f64 {
    (1.0 + x.clamp(-1.0, 1.0) / 64.0).powi(64)
}
