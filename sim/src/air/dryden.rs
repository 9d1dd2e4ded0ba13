//! Dryden's forming filters, driven by white noise and discretised exactly.
//!
//! The independent variable is s = t V / L (the distance through the air, in scale lengths), and the output has unit
//! variance, so that intensity, scale length and airspeed may change without a transient. MIL-F-8785C, 3.7.1.2:
//!
//! ```text
//! H_u(p) = sqrt(2) / (1 + p)                    autocorrelation e^-s             (longitudinal)
//! H_v(p) = (1 + sqrt(3) p) / (1 + p)²           autocorrelation e^-s (1 - s/2)   (transverse: v, w)
//! ```

use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};

/// First-order filter of the component along the wind.
#[derive(Clone, Debug)]
pub(super) struct Longitudinal(f64);

impl Longitudinal {
    /// In the stationary distribution.
    pub fn stationary(rng: &mut ChaCha8Rng) -> Self {
        Self(StandardNormal.sample(rng))
    }

    /// Advances by `s` >= 0 scale lengths.
    pub fn advance(&mut self, s: f64, rng: &mut ChaCha8Rng) {
        let noise: f64 = StandardNormal.sample(rng);
        self.0 = (-s).exp() * self.0 + (-(-2.0 * s).exp_m1()).sqrt() * noise;
    }

    /// Gust over its intensity, -.
    pub fn output(&self) -> f64 {
        self.0
    }
}

/// Second-order filter of a component across the wind.
///
/// ```text
/// z' = [0 1; -1 -2] z + [0; 2] noise,   output (z_1 + sqrt(3) z_2) / 2
/// ```
///
/// in which the stationary covariance of z is the identity.
#[derive(Clone, Debug)]
pub(super) struct Transverse([f64; 2]);

impl Transverse {
    /// In the stationary distribution.
    pub fn stationary(rng: &mut ChaCha8Rng) -> Self {
        Self([StandardNormal.sample(rng), StandardNormal.sample(rng)])
    }

    /// Advances by `s` >= 0 scale lengths.
    pub fn advance(&mut self, s: f64, rng: &mut ChaCha8Rng) {
        let [z1, z2] = self.0;
        let noise: [f64; 2] = [StandardNormal.sample(rng), StandardNormal.sample(rng)];
        let [[φ11, φ12], [φ21, φ22]] = transition(s);
        let [l11, l21, l22] = noise_factor(s);
        self.0 = [φ11 * z1 + φ12 * z2 + l11 * noise[0], φ21 * z1 + φ22 * z2 + l21 * noise[0] + l22 * noise[1]];
    }

    /// Gust over its intensity, -.
    pub fn output(&self) -> f64 {
        (self.0[0] + 3.0_f64.sqrt() * self.0[1]) / 2.0
    }
}

/// Φ = exp(A s) = e^-s [1+s s; -s 1-s], by rows.
fn transition(s: f64) -> [[f64; 2]; 2] {
    let decay = (-s).exp();
    [[decay * (1.0 + s), decay * s], [-decay * s, decay * (1.0 - s)]]
}

/// Lower Cholesky factor (l11, l21, l22) of the joint covariance of the noise that enters both states, Q = I - Φ Φᵀ:
///
/// ```text
/// Q_11 = 1 - e^-2s (1 + 2s + 2s²),   Q_12 = 2 s² e^-2s,   Q_22 = 1 - e^-2s (1 - 2s + 2s²)
/// ```
fn noise_factor(s: f64) -> [f64; 3] {
    if s <= 0.0 {
        return [0.0; 3];
    }
    let decay = (-2.0 * s).exp();
    let q11 = decay * exponential_tail(2.0 * s);
    let q12 = 2.0 * s * s * decay;
    let q22 = decay * (exponential_tail(2.0 * s) + 4.0 * s);
    let l11 = q11.sqrt();
    let l21 = q12 / l11;
    [l11, l21, (q22 - l21 * l21).max(0.0).sqrt()]
}

/// e^x - 1 - x - x²/2, to full relative precision.
fn exponential_tail(x: f64) -> f64 {
    if x > 0.5 {
        return x.exp() - 1.0 - x - x * x / 2.0;
    }
    // x³/3! (1 + x/4 (1 + x/5 (...)))
    let series = (4..=16).rev().fold(1.0, |sum, k| 1.0 + sum * x / f64::from(k));
    x * x * x / 6.0 * series
}

#[cfg(test)]
mod tests {
    use nalgebra::{Matrix2, Vector2};

    use super::*;

    const A: Matrix2<f64> = Matrix2::new(0.0, 1.0, -1.0, -2.0);
    const B: Vector2<f64> = Vector2::new(0.0, 2.0);

    /// ∫ e^Ax B Bᵀ e^Aᵀx dx over [0, s] by Simpson's rule: what white noise leaves in the states.
    fn covariance_by_quadrature(s: f64) -> Matrix2<f64> {
        let n = 2000;
        let integrand = |i: i32| {
            let state = (A * (s * f64::from(i) / f64::from(n))).exp() * B;
            state * state.transpose()
        };
        let sum = (0..=n).fold(Matrix2::zeros(), |sum, i| {
            sum + integrand(i) * if i == 0 || i == n { 1.0 } else { 2.0 + 2.0 * f64::from(i % 2) }
        });
        sum * (s / f64::from(n) / 3.0)
    }

    #[test]
    fn transition_is_the_matrix_exponential() {
        for s in [1e-4, 0.03, 0.7, 4.0] {
            let [[a, b], [c, d]] = transition(s);
            assert!((Matrix2::new(a, b, c, d) - (A * s).exp()).norm() < 1e-14);
        }
    }

    #[test]
    fn noise_covariance_is_the_integral_over_the_step() {
        for s in [1e-5, 1e-3, 0.1, 0.24, 0.26, 1.0, 5.0] {
            let [l11, l21, l22] = noise_factor(s);
            let factor = Matrix2::new(l11, 0.0, l21, l22);
            let (found, expected) = (factor * factor.transpose(), covariance_by_quadrature(s));
            for (a, b) in found.iter().zip(expected.iter()) {
                assert!((a / b - 1.0).abs() < 1e-8, "s = {s}: {found} against {expected}");
            }
        }
    }

    #[test]
    fn no_time_adds_no_noise() {
        assert_eq!(noise_factor(0.0), [0.0; 3]);
    }

    /// Mean of output(i) output(i + lag) for each lag, over `steps` steps of `s`.
    fn autocorrelation(mut next: impl FnMut() -> f64, steps: usize, lags: &[usize]) -> Vec<f64> {
        let outputs: Vec<f64> = (0..steps).map(|_| next()).collect();
        let mean_product =
            |lag: usize| outputs.iter().zip(&outputs[lag..]).map(|(a, b)| a * b).sum::<f64>() / (steps - lag) as f64;
        lags.iter().map(|lag| mean_product(*lag)).collect()
    }

    /// Over T scale lengths an estimate has a standard deviation of at most sqrt(2 ∫R² / T), R² < e^-2|s|: 0.007 here.
    const SCALE_LENGTHS: f64 = 40_000.0;
    const FIVE_SIGMA: f64 = 0.035;

    #[test]
    fn autocorrelation_is_drydens_at_any_step() {
        for s in [0.02, 0.5] {
            let lags: Vec<usize> = [0.0, 0.5, 1.0, 2.0, 3.0].iter().map(|lag| (lag / s) as usize).collect();
            let steps = (SCALE_LENGTHS / s) as usize;
            let mut rng = scenarios::stream(11, "dryden");
            let mut u = Longitudinal::stationary(&mut rng);
            let found_u = autocorrelation(
                || {
                    u.advance(s, &mut rng);
                    u.output()
                },
                steps,
                &lags,
            );
            let mut v = Transverse::stationary(&mut rng);
            let found_v = autocorrelation(
                || {
                    v.advance(s, &mut rng);
                    v.output()
                },
                steps,
                &lags,
            );
            for ((lag, found_u), found_v) in lags.iter().zip(found_u).zip(found_v) {
                let x = *lag as f64 * s;
                assert!((found_u - (-x).exp()).abs() < FIVE_SIGMA, "u, lag {x}: {found_u}");
                assert!((found_v - (-x).exp() * (1.0 - x / 2.0)).abs() < FIVE_SIGMA, "v, lag {x}: {found_v}");
            }
        }
    }

    /// Power spectral density of `next`, by averaged periodograms (Welch, Hann window), over eight neighbouring
    /// frequencies from each of `ω` (radians per scale length) on, the samples being `s` scale lengths apart.
    fn spectrum(mut next: impl FnMut() -> f64, s: f64, frequencies: &[f64]) -> Vec<f64> {
        let (length, segments, bins) = (4096, 200, 8);
        let spacing = std::f64::consts::TAU / (length as f64 * s);
        let hann = |i: usize| (std::f64::consts::PI * i as f64 / length as f64).sin().powi(2);
        let window_power: f64 = (0..length).map(|i| hann(i).powi(2)).sum();
        let mut density = vec![0.0; frequencies.len()];
        for _ in 0..segments {
            let samples: Vec<f64> = (0..length).map(|i| next() * hann(i)).collect();
            for (density, ω) in density.iter_mut().zip(frequencies) {
                for bin in 0..bins {
                    let step = ((ω / spacing).round() + f64::from(bin)) * spacing * s;
                    let (mut cosine, mut sine) = (0.0, 0.0);
                    for (i, sample) in samples.iter().enumerate() {
                        let (sin, cos) = (step * i as f64).sin_cos();
                        (cosine, sine) = (cosine + sample * cos, sine + sample * sin);
                    }
                    *density += (cosine * cosine + sine * sine) * s / window_power / f64::from(segments * bins);
                }
            }
        }
        density
    }

    #[test]
    fn spectrum_is_drydens() {
        let (s, frequencies) = (0.05, [0.25, 0.5, 1.0, 2.0, 4.0]);
        let mut rng = scenarios::stream(12, "dryden");
        let mut u = Longitudinal::stationary(&mut rng);
        let found_u = spectrum(
            || {
                u.advance(s, &mut rng);
                u.output()
            },
            s,
            &frequencies,
        );
        let mut v = Transverse::stationary(&mut rng);
        let found_v = spectrum(
            || {
                v.advance(s, &mut rng);
                v.output()
            },
            s,
            &frequencies,
        );
        // |H|² at the middle of the eight frequencies; 1600 periodograms leave a standard deviation of about 3 %
        let middle = 3.5 * std::f64::consts::TAU / (4096.0 * s);
        for (ω, (found_u, found_v)) in frequencies.iter().zip(found_u.into_iter().zip(found_v)) {
            let square = (ω + middle).powi(2);
            let expected_u = 2.0 / (1.0 + square);
            let expected_v = (1.0 + 3.0 * square) / (1.0 + square).powi(2);
            assert!((found_u / expected_u - 1.0).abs() < 0.15, "u at {ω}: {found_u} against {expected_u}");
            assert!((found_v / expected_v - 1.0).abs() < 0.15, "v at {ω}: {found_v} against {expected_v}");
        }
    }
}
