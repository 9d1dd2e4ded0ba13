//! Dryden's forming filters, driven by white noise and discretised exactly.
//!
//! The independent variable is s = t V / L (the distance through the air, in scale lengths), and the output has unit
//! variance, so that intensity, scale length and airspeed may change without a transient. MIL-F-8785C, 3.7.1.2:
//!
//! ```text
//! H_u(p) = sqrt(2) / (1 + p)                    autocorrelation e^-s             (longitudinal)
//! H_v(p) = (1 + sqrt(3) p) / (1 + p)²           autocorrelation e^-s (1 - s/2)   (transverse: v, w)
//! ```

use nalgebra::{Matrix2, Vector2};
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};

/// First-order filter of the component along the wind.
#[derive(Clone, Copy, Debug)]
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

    /// Draws the state in the middle of a step of `s` > 0 scale lengths between two known ones.
    ///
    /// ```text
    /// mean (z_0 + z_1) e^-s/2 / (1 + e^-s),   variance (1 - e^-s) / (1 + e^-s)
    /// ```
    pub fn between([start, end]: [&Self; 2], s: f64, rng: &mut ChaCha8Rng) -> Self {
        let noise: f64 = StandardNormal.sample(rng);
        let weight = 1.0 / (1.0 + (-s).exp());
        Self((start.0 + end.0) * (-s / 2.0).exp() * weight + (-(-s).exp_m1() * weight).sqrt() * noise)
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
#[derive(Clone, Copy, Debug)]
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

    /// Draws the state in the middle of a step of `s` > 0 scale lengths between two known ones.
    ///
    /// With Φ and Q of half the step, the state at its end is z_1 = Φ z_m + noise of covariance Q:
    ///
    /// ```text
    /// K = Q Φᵀ (Φ Q Φᵀ + Q)⁻¹,   mean Φ z_0 + K (z_1 - Φ² z_0),   covariance Q - K Φ Q
    /// ```
    pub fn between([start, end]: [&Self; 2], s: f64, rng: &mut ChaCha8Rng) -> Self {
        let noise = Vector2::new(StandardNormal.sample(rng), StandardNormal.sample(rng));
        let [[φ11, φ12], [φ21, φ22]] = transition(s / 2.0);
        let [l11, l21, l22] = noise_factor(s / 2.0);
        let (φ, factor) = (Matrix2::new(φ11, φ12, φ21, φ22), Matrix2::new(l11, 0.0, l21, l22));
        let q = factor * factor.transpose();
        let Some(inverse) = (φ * q * φ.transpose() + q).try_inverse() else { return *start };
        let gain = q * φ.transpose() * inverse;
        let expected = φ * Vector2::from(start.0);
        let mean = expected + gain * (Vector2::from(end.0) - φ * expected);
        Self((mean + lower_factor(&(q - gain * φ * q)) * noise).into())
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

/// Lower Cholesky factor of a covariance, in which rounding may have left a negative variance.
fn lower_factor(covariance: &Matrix2<f64>) -> Matrix2<f64> {
    let l11 = covariance.m11.max(0.0).sqrt();
    let l21 = if l11 > 0.0 { covariance.m21 / l11 } else { 0.0 };
    Matrix2::new(l11, 0.0, l21, (covariance.m22 - l21 * l21).max(0.0).sqrt())
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

    /// Steps of `s`, and the state in the middle of each.
    #[test]
    fn states_between_two_samples_have_drydens_autocorrelation() {
        for s in [0.02, 0.5] {
            let lags = [0, 1, 2, 3, (1.0 / s) as usize + 1];
            let steps = (SCALE_LENGTHS / s) as usize;
            let (mut rng, mut bridge) = (scenarios::stream(13, "dryden"), scenarios::stream(13, "bridge"));
            let (mut u, mut v) = (Longitudinal::stationary(&mut rng), Transverse::stationary(&mut rng));
            let (mut found_u, mut found_v) = (Vec::new(), Vec::new());
            for _ in 0..steps {
                let before = (u, v);
                u.advance(s, &mut rng);
                v.advance(s, &mut rng);
                found_u.extend([Longitudinal::between([&before.0, &u], s, &mut bridge).output(), u.output()]);
                found_v.extend([Transverse::between([&before.1, &v], s, &mut bridge).output(), v.output()]);
            }
            let mut outputs = found_u.into_iter();
            let found_u = autocorrelation(|| outputs.next().unwrap(), 2 * steps, &lags);
            let mut outputs = found_v.into_iter();
            let found_v = autocorrelation(|| outputs.next().unwrap(), 2 * steps, &lags);
            for ((lag, found_u), found_v) in lags.iter().zip(found_u).zip(found_v) {
                let x = *lag as f64 * s / 2.0;
                assert!((found_u - (-x).exp()).abs() < FIVE_SIGMA, "u, lag {x}: {found_u}");
                assert!((found_v - (-x).exp() * (1.0 - x / 2.0)).abs() < FIVE_SIGMA, "v, lag {x}: {found_v}");
            }
        }
    }

    /// Mean square of the output in the middle of a short step, less the mean of its ends. Straight lines between samples
    /// would leave 0; white noise through the filters leaves their variance: s/2 for u, 3/2 of that for v.
    #[test]
    fn the_middle_of_a_short_step_is_as_rough_as_the_filter() {
        let s = 1e-3;
        let (mut rng, mut bridge) = (scenarios::stream(14, "dryden"), scenarios::stream(14, "bridge"));
        let (mut u, mut v) = (Longitudinal::stationary(&mut rng), Transverse::stationary(&mut rng));
        let (mut sum_u, mut sum_v, steps) = (0.0, 0.0, 100_000);
        for _ in 0..steps {
            let before = (u, v);
            u.advance(s, &mut rng);
            v.advance(s, &mut rng);
            let middle_u = Longitudinal::between([&before.0, &u], s, &mut bridge).output();
            let middle_v = Transverse::between([&before.1, &v], s, &mut bridge).output();
            sum_u += (middle_u - (before.0.output() + u.output()) / 2.0).powi(2) / f64::from(steps);
            sum_v += (middle_v - (before.1.output() + v.output()) / 2.0).powi(2) / f64::from(steps);
        }
        assert!((sum_u / (s / 2.0) - 1.0).abs() < 0.03, "{sum_u}");
        assert!((sum_v / (0.75 * s) - 1.0).abs() < 0.03, "{sum_v}");
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
