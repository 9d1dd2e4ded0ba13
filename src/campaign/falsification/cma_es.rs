//! Covariance matrix adaptation (CMA-ES): a search for the minimum of a function whose derivatives are not known.
//!
//! Candidates are drawn from a normal distribution N(m, σ² C). Its mean moves to the better half of them, weighted by rank;
//! its covariance grows along the directions that led there. Parameters as in Hansen, "The CMA Evolution
//! Strategy: A Tutorial" (2016), section A.

use nalgebra::{DMatrix, DVector};
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};

/// The distribution, and what its adaptation remembers.
pub struct CmaEs {
    mean: DVector<f64>,
    sigma: f64,
    covariance: DMatrix<f64>,
    /// Evolution path of the covariance.
    path: DVector<f64>,
    /// Evolution path of the step size, with the covariance divided out.
    sigma_path: DVector<f64>,
    generation: i32,
    parameters: Parameters,
    /// Axes of the distribution and their lengths: C = B D² Bᵀ.
    axes: DMatrix<f64>,
    lengths: DVector<f64>,
}

/// What depends on the number of variables and of candidates alone.
struct Parameters {
    weights: Vec<f64>,
    /// μ_eff, the effective number of candidates that the mean is taken over.
    effective: f64,
    sigma_rate: f64,
    sigma_damping: f64,
    path_rate: f64,
    rank_one_rate: f64,
    rank_mu_rate: f64,
    /// Expected length of a standard normal vector.
    expected_length: f64,
    candidates: usize,
}

impl Parameters {
    fn new(variables: usize, candidates: usize) -> Self {
        let n = variables as f64;
        let half = candidates / 2;
        let raw: Vec<f64> =
            (1..=half).map(|rank| ((candidates as f64 + 1.0) / 2.0).ln() - (rank as f64).ln()).collect();
        let sum: f64 = raw.iter().sum();
        let weights: Vec<f64> = raw.iter().map(|weight| weight / sum).collect();
        let effective = 1.0 / weights.iter().map(|weight| weight * weight).sum::<f64>();
        let sigma_rate = (effective + 2.0) / (n + effective + 5.0);
        let excess = ((effective - 1.0) / (n + 1.0)).sqrt() - 1.0;
        let rank_one_rate = 2.0 / ((n + 1.3).powi(2) + effective);
        let rank_mu_rate = 2.0 * (0.25 + effective + 1.0 / effective - 2.0) / ((n + 2.0).powi(2) + effective);
        Self {
            weights,
            effective,
            sigma_rate,
            sigma_damping: 1.0 + 2.0 * excess.max(0.0) + sigma_rate,
            path_rate: (4.0 + effective / n) / (n + 4.0 + 2.0 * effective / n),
            rank_one_rate,
            rank_mu_rate: rank_mu_rate.min(1.0 - rank_one_rate),
            expected_length: n.sqrt() * (1.0 - 1.0 / (4.0 * n) + 1.0 / (21.0 * n * n)),
            candidates,
        }
    }
}

impl CmaEs {
    /// A round distribution about `mean`.
    ///
    /// - `sigma`: its standard deviation
    /// - `candidates`: per generation, at least 4
    pub fn new(mean: &[f64], sigma: f64, candidates: usize) -> Self {
        let n = mean.len();
        Self {
            mean: DVector::from_column_slice(mean),
            sigma,
            covariance: DMatrix::identity(n, n),
            path: DVector::zeros(n),
            sigma_path: DVector::zeros(n),
            generation: 0,
            parameters: Parameters::new(n, candidates.max(4)),
            axes: DMatrix::identity(n, n),
            lengths: DVector::from_element(n, 1.0),
        }
    }

    /// The number of candidates that is usual for so many variables.
    pub fn usual_candidates(variables: usize) -> usize {
        4 + (3.0 * (variables as f64).ln()).floor() as usize
    }

    /// Draws the candidates of one generation.
    pub fn ask(&self, random: &mut ChaCha8Rng) -> Vec<Vec<f64>> {
        let mut draw = || {
            let normal = DVector::from_fn(self.mean.len(), |_, _| StandardNormal.sample(random));
            let scaled: DVector<f64> = self.lengths.component_mul(&normal);
            (&self.mean + &self.axes * scaled * self.sigma).as_slice().to_vec()
        };
        (0..self.parameters.candidates).map(|_| draw()).collect()
    }

    /// Learns the values of the candidates of one generation. Of equal values the earlier one ranks first.
    pub fn tell(&mut self, candidates: &[Vec<f64>], values: &[f64]) {
        let mut ranked: Vec<usize> = (0..candidates.len()).collect();
        ranked.sort_by(|&a, &b| values[a].total_cmp(&values[b]));
        let steps: Vec<DVector<f64>> = ranked
            .iter()
            .take(self.parameters.weights.len())
            .map(|&index| (DVector::from_column_slice(&candidates[index]) - &self.mean) / self.sigma)
            .collect();
        let mean_step: DVector<f64> =
            steps.iter().zip(&self.parameters.weights).map(|(step, weight)| step * *weight).sum();
        self.mean += &mean_step * self.sigma;
        self.generation += 1;
        self.adapt(&steps, &mean_step);
        self.decompose();
    }

    /// Standard deviation along the longest axis.
    pub fn spread(&self) -> f64 {
        self.sigma * self.lengths.max()
    }

    fn adapt(&mut self, steps: &[DVector<f64>], mean_step: &DVector<f64>) {
        let p = &self.parameters;
        let whitened = &self.axes * (self.axes.transpose() * mean_step).component_div(&self.lengths);
        let sigma_gain = (p.sigma_rate * (2.0 - p.sigma_rate) * p.effective).sqrt();
        self.sigma_path = &self.sigma_path * (1.0 - p.sigma_rate) + whitened * sigma_gain;
        let length = self.sigma_path.norm() / p.expected_length;
        let warm_up = (1.0 - (1.0 - p.sigma_rate).powi(2 * self.generation)).sqrt();
        // A long path of the step size means that σ lags behind; C must not grow meanwhile.
        let is_steady = length / warm_up < 1.4 + 2.0 / (self.mean.len() as f64 + 1.0);
        let gain = if is_steady { (p.path_rate * (2.0 - p.path_rate) * p.effective).sqrt() } else { 0.0 };
        self.path = &self.path * (1.0 - p.path_rate) + mean_step * gain;
        let forgotten = if is_steady { 0.0 } else { p.rank_one_rate * p.path_rate * (2.0 - p.path_rate) };
        let keep = 1.0 - p.rank_one_rate - p.rank_mu_rate + forgotten;
        let rank_one = &self.path * self.path.transpose() * p.rank_one_rate;
        let rank_mu: DMatrix<f64> = steps
            .iter()
            .zip(&p.weights)
            .map(|(step, weight)| step * step.transpose() * (p.rank_mu_rate * weight))
            .sum();
        self.covariance = &self.covariance * keep + rank_one + rank_mu;
        self.sigma *= (p.sigma_rate / p.sigma_damping * (length - 1.0)).min(1.0).exp();
    }

    fn decompose(&mut self) {
        let symmetric = (&self.covariance + self.covariance.transpose()) * 0.5;
        let eigen = symmetric.symmetric_eigen();
        self.lengths = eigen.eigenvalues.map(|value| value.max(1e-20).sqrt());
        self.axes = eigen.eigenvectors;
    }
}

#[cfg(test)]
mod tests {
    use rand::SeedableRng;
    use rand_chacha::ChaCha8Rng;

    use super::CmaEs;

    /// Evaluations until the value is below 1e-10, from a point at a distance of about 1.
    fn evaluations(variables: usize, function: impl Fn(&[f64]) -> f64) -> usize {
        let mut search = CmaEs::new(&vec![0.7; variables], 0.3, CmaEs::usual_candidates(variables));
        let mut random = ChaCha8Rng::seed_from_u64(1);
        let mut used = 0;
        while used < 20_000 {
            let candidates = search.ask(&mut random);
            let values: Vec<f64> = candidates.iter().map(|candidate| function(candidate)).collect();
            used += values.len();
            if values.iter().any(|value| *value < 1e-10) {
                return used;
            }
            search.tell(&candidates, &values);
        }
        usize::MAX
    }

    #[test]
    fn standard_functions_are_minimised() {
        assert!(evaluations(5, |x| x.iter().map(|x| x * x).sum()) < 1200);
        let ellipsoid = |x: &[f64]| (0..5).map(|i| 1e6_f64.powf(i as f64 / 4.0) * x[i] * x[i]).sum();
        assert!(evaluations(5, ellipsoid) < 4000);
        let rosenbrock = |x: &[f64]| {
            x.windows(2).map(|pair| 100.0 * (pair[1] - pair[0] * pair[0]).powi(2) + (1.0 - pair[0]).powi(2)).sum()
        };
        assert!(evaluations(4, rosenbrock) < 5000);
        assert!(evaluations(1, |x| x[0] * x[0]) < 400);
    }
}
