use nalgebra::Vector3;
use rand_chacha::ChaCha8Rng;

use super::dryden::{Longitudinal, Transverse};

const M_PER_FT: f64 = 0.3048;

/// Lowest height for which the low-altitude form is given, ft.
const MIN_HEIGHT_FT: f64 = 10.0;

/// Top of the low-altitude form, and bottom of the form for medium and high altitude, ft.
const LOW_FT: f64 = 1000.0;
const ALOFT_FT: f64 = 2000.0;

/// Scale length of all components at medium and high altitude, ft.
const SCALE_ALOFT_FT: f64 = 1750.0;

/// Minimum airspeed at which the vehicle moves through the gusts, m/s: frozen turbulence does not change around a
/// vehicle at rest.
const MIN_AIRSPEED_MPS: f64 = 1.0;

/// Continuous gusts in Dryden's form (MIL-F-8785C, 3.7): longitudinal u, lateral v, vertical w, independent.
#[derive(Clone, Debug)]
pub(super) struct Turbulence {
    settings: scenarios::Gusts,
    now: Filters,
    rng: ChaCha8Rng,
    /// One for every halving of the distance between samples, so that a finer flight has the samples of a coarser one.
    refinement: Vec<ChaCha8Rng>,
}

impl Turbulence {
    /// In the stationary distribution.
    ///
    /// - `rng`, `refinement`: for the samples at the end of every step, and for those between them: at its middle, at its
    ///   quarters ...
    pub fn new(settings: &scenarios::Gusts, mut rng: ChaCha8Rng, refinement: Vec<ChaCha8Rng>) -> Self {
        Self { settings: settings.clone(), now: Filters::stationary(&mut rng), rng, refinement }
    }

    /// Advances the gusts by `step_s` around a vehicle that flies at an airspeed, m/s. Returns them, (u, v, w), m/s, at
    /// equidistant instants, the last of which is the end of the step.
    pub fn advance(&mut self, step_s: f64, altitude_m: f64, airspeed_mps: f64) -> Vec<Vector3<f64>> {
        let scales = Scales::at(&self.settings, altitude_m);
        let passed_m = airspeed_mps.max(MIN_AIRSPEED_MPS) * step_s;
        let mut passed = [passed_m / scales.horizontal_length_m, passed_m / scales.vertical_length_m];
        let mut samples = vec![self.now];
        self.now.advance(passed, &mut self.rng);
        samples.push(self.now);
        for rng in &mut self.refinement {
            samples = refined(&samples, passed, rng);
            passed = passed.map(|passed| passed / 2.0);
        }
        samples[1..].iter().map(|filters| filters.gust_mps(&scales)).collect()
    }

    /// (u, v, w), m/s.
    pub fn gust_mps(&self, altitude_m: f64) -> Vector3<f64> {
        self.now.gust_mps(&Scales::at(&self.settings, altitude_m))
    }
}

/// States of the filters of all components.
#[derive(Clone, Copy, Debug)]
struct Filters {
    u: Longitudinal,
    v: Transverse,
    w: Transverse,
}

impl Filters {
    fn stationary(rng: &mut ChaCha8Rng) -> Self {
        let u = Longitudinal::stationary(rng);
        let v = Transverse::stationary(rng);
        Self { u, v, w: Transverse::stationary(rng) }
    }

    /// Advances by so many scale lengths, horizontal and vertical.
    fn advance(&mut self, [horizontal, vertical]: [f64; 2], rng: &mut ChaCha8Rng) {
        self.u.advance(horizontal, rng);
        self.v.advance(horizontal, rng);
        self.w.advance(vertical, rng);
    }

    /// Draws the states in the middle between two known ones, so many scale lengths apart, horizontal and vertical.
    fn between([start, end]: [&Self; 2], [horizontal, vertical]: [f64; 2], rng: &mut ChaCha8Rng) -> Self {
        Self {
            u: Longitudinal::between([&start.u, &end.u], horizontal, rng),
            v: Transverse::between([&start.v, &end.v], horizontal, rng),
            w: Transverse::between([&start.w, &end.w], vertical, rng),
        }
    }

    /// (u, v, w), m/s.
    fn gust_mps(&self, scales: &Scales) -> Vector3<f64> {
        let Scales { horizontal_sigma_mps, vertical_sigma_mps, .. } = scales;
        Vector3::new(
            horizontal_sigma_mps * self.u.output(),
            horizontal_sigma_mps * self.v.output(),
            vertical_sigma_mps * self.w.output(),
        )
    }
}

/// Samples with another one in the middle between each two of them, which are `passed` scale lengths apart.
fn refined(samples: &[Filters], passed: [f64; 2], rng: &mut ChaCha8Rng) -> Vec<Filters> {
    let pairs = samples.windows(2);
    let later = pairs.flat_map(|pair| [Filters::between([&pair[0], &pair[1]], passed, rng), pair[1]]);
    std::iter::once(samples[0]).chain(later).collect()
}

/// Scale lengths L, m, and intensities σ, m/s; u and v have the same.
#[derive(Clone, Copy, Debug)]
struct Scales {
    horizontal_length_m: f64,
    vertical_length_m: f64,
    horizontal_sigma_mps: f64,
    vertical_sigma_mps: f64,
}

impl Scales {
    /// At an altitude above ground, which is at z = 0: the low-altitude form up to 1000 ft, isotropic from 2000 ft on,
    /// linear in between.
    fn at(gusts: &scenarios::Gusts, altitude_m: f64) -> Self {
        let height_ft = altitude_m / M_PER_FT;
        let low = Self::low(gusts, height_ft.clamp(MIN_HEIGHT_FT, LOW_FT));
        if height_ft <= LOW_FT {
            return low;
        }
        let fraction = ((height_ft - LOW_FT) / (ALOFT_FT - LOW_FT)).min(1.0);
        let blend = |low: f64, aloft: f64| low + (aloft - low) * fraction;
        Self {
            horizontal_length_m: blend(low.horizontal_length_m, SCALE_ALOFT_FT * M_PER_FT),
            vertical_length_m: blend(low.vertical_length_m, SCALE_ALOFT_FT * M_PER_FT),
            horizontal_sigma_mps: blend(low.horizontal_sigma_mps, gusts.sigma_aloft_mps),
            vertical_sigma_mps: blend(low.vertical_sigma_mps, gusts.sigma_aloft_mps),
        }
    }

    /// L_w = h,  L_u = L_v = h / (0.177 + 0.000823 h)^1.2,  σ_w = 0.1 W_20,  σ_u = σ_v = σ_w / (0.177 + 0.000823 h)^0.4,
    /// h in ft.        [MIL-F-8785C, 3.7.3.4, figures 10 and 11]
    fn low(gusts: &scenarios::Gusts, height_ft: f64) -> Self {
        let shear = (0.177 + 0.000823 * height_ft).powf(0.4);
        let vertical_sigma_mps = 0.1 * gusts.wind_at_20ft_mps;
        Self {
            horizontal_length_m: height_ft / (shear * shear * shear) * M_PER_FT,
            vertical_length_m: height_ft * M_PER_FT,
            horizontal_sigma_mps: vertical_sigma_mps / shear,
            vertical_sigma_mps,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const GUSTS: scenarios::Gusts = scenarios::Gusts { wind_at_20ft_mps: 15.0, sigma_aloft_mps: 0.9 };

    /// Worked by hand: (height ft, L_u ft, L_w ft, σ_u m/s, σ_w m/s).
    const WORKED: [[f64; 5]; 5] = [
        [100.0, 505.169_335, 100.0, 2.573_773_07, 1.5],
        [500.0, 944.657_210, 500.0, 1.854_354_11, 1.5],
        [1000.0, 1000.0, 1000.0, 1.5, 1.5],
        [1500.0, 1375.0, 1375.0, 1.2, 1.2],
        [3000.0, 1750.0, 1750.0, 0.9, 0.9],
    ];

    #[test]
    fn scales_are_the_standards() {
        for [height_ft, length_u_ft, length_w_ft, sigma_u, sigma_w] in WORKED {
            let scales = Scales::at(&GUSTS, height_ft * M_PER_FT);
            for (found, expected) in [
                (scales.horizontal_length_m, length_u_ft * M_PER_FT),
                (scales.vertical_length_m, length_w_ft * M_PER_FT),
                (scales.horizontal_sigma_mps, sigma_u),
                (scales.vertical_sigma_mps, sigma_w),
            ] {
                assert!((found / expected - 1.0).abs() < 1e-6, "{height_ft} ft: {found}, expected {expected}");
            }
        }
    }

    #[test]
    fn the_low_form_ends_at_ten_feet() {
        let [ground, lowest] = [-50.0, MIN_HEIGHT_FT * M_PER_FT].map(|altitude| Scales::at(&GUSTS, altitude));
        assert_eq!(ground.horizontal_length_m, lowest.horizontal_length_m);
        assert_eq!(ground.horizontal_sigma_mps, lowest.horizontal_sigma_mps);
    }

    /// Fast, so that little time holds many scale lengths.
    const AIRSPEED_MPS: f64 = 350.0;

    /// Gusts at every `step_s` over `duration_s`.
    fn gusts_mps(altitude_m: f64, step_s: f64, duration_s: f64) -> Vec<Vector3<f64>> {
        let mut turbulence = Turbulence::new(&GUSTS, scenarios::stream(5, "turbulence"), Vec::new());
        let mut next = || {
            turbulence.advance(step_s, altitude_m, AIRSPEED_MPS);
            turbulence.gust_mps(altitude_m)
        };
        (0..(duration_s / step_s) as usize).map(|_| next()).collect()
    }

    /// Mean over time of the products of each component at t and at t + lag, m²/s².
    fn autocorrelation(gusts: &[Vector3<f64>], lag: usize) -> Vector3<f64> {
        let sum: Vector3<f64> = gusts.iter().zip(&gusts[lag..]).map(|(a, b)| a.component_mul(b)).sum();
        sum / (gusts.len() - lag) as f64
    }

    /// Dryden's autocorrelation over σ², with x the distance in scale lengths.
    fn dryden(lag_s: f64, scales: [[f64; 2]; 3]) -> Vector3<f64> {
        let [u, v, w] = scales.map(|[length_m, sigma_mps]| (lag_s * AIRSPEED_MPS / length_m, sigma_mps.powi(2)));
        let transverse = |(x, variance): (f64, f64)| variance * (-x).exp() * (1.0 - x / 2.0);
        Vector3::new(u.1 * (-u.0).exp(), transverse(v), transverse(w))
    }

    /// 500 ft and 1500 ft, from the table above, at the simulator's step and at ten times that. Over T = 40,000 s, some
    /// 33,000 scale lengths of the longest, an estimate's relative standard deviation is below sqrt(2/33,000) = 0.008.
    #[test]
    fn variance_and_autocorrelation_are_drydens_at_any_step() {
        for [height_ft, length_u_ft, length_w_ft, sigma_u, sigma_w] in [WORKED[1], WORKED[3]] {
            let horizontal = [length_u_ft * M_PER_FT, sigma_u];
            let scales = [horizontal, horizontal, [length_w_ft * M_PER_FT, sigma_w]];
            for step_s in [0.1, 0.01] {
                let gusts = gusts_mps(height_ft * M_PER_FT, step_s, 40_000.0);
                for lag_s in [0.0, 0.2, 0.6, 1.5, 4.0] {
                    let found = autocorrelation(&gusts, (lag_s / step_s + 0.5) as usize);
                    let error = found - dryden(lag_s, scales);
                    let relative = error.component_div(&dryden(0.0, scales));
                    assert!(relative.amax() < 0.04, "{height_ft} ft, step {step_s} s, lag {lag_s} s: {relative}");
                }
            }
        }
    }

    #[test]
    fn a_refined_path_passes_through_the_samples_of_a_coarser_one() {
        let path = |halvings: u64| {
            let refinement = (0..halvings).map(|halving| scenarios::stream(halving, "refinement")).collect();
            let mut turbulence = Turbulence::new(&GUSTS, scenarios::stream(5, "turbulence"), refinement);
            (0..20).flat_map(|_| turbulence.advance(0.1, 150.0, 35.0)).collect::<Vec<_>>()
        };
        let [coarse, half, quarter] = [0, 1, 2].map(path);
        assert_eq!([coarse.len(), half.len(), quarter.len()], [20, 40, 80]);
        assert!((0..20).all(|step| coarse[step] == half[2 * step + 1] && coarse[step] == quarter[4 * step + 3]));
        assert!((0..40).all(|step| half[step] == quarter[2 * step + 1]));
        assert!((0..20).all(|step| half[2 * step] != half[2 * step + 1]));
    }

    #[test]
    fn components_are_independent() {
        let gusts = gusts_mps(150.0, 0.1, 40_000.0);
        let mean_product = |i: usize, j: usize| {
            let product: f64 = gusts.iter().map(|gust| gust[i] * gust[j]).sum();
            let power = |axis: usize| gusts.iter().map(|gust| gust[axis].powi(2)).sum::<f64>();
            product / (power(i) * power(j)).sqrt()
        };
        for (i, j) in [(0, 1), (1, 2), (2, 0)] {
            assert!(mean_product(i, j).abs() < 0.04, "{i}{j}: {}", mean_product(i, j));
        }
    }
}
