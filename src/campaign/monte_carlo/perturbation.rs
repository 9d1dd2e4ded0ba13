use rand_distr::{Distribution, Uniform, UnitDisc};
use scenarios::{Scenario, Wind};
use serde::{Deserialize, Serialize};

use crate::campaign::failure_threshold::Disturbance;
use crate::families;

/// Magnitudes of the random perturbations of a scenario; 0 leaves the scenario as it is.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Dispersions {
    /// A mean wind drawn from the horizontal disc of this radius is added to the scenario's, m/s.
    pub wind_mps: f64,
    /// Largest deviation of the true masses from the scenario's, as a fraction; vehicle and load are drawn independently.
    pub mass: f64,
    /// Largest standard deviation of the measured position, m; all other sensor noise grows with it.
    pub noise_m: f64,
    /// Starts are drawn from the horizontal disc of this radius, m.
    pub start_m: f64,
}

/// The perturbation of one sample.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Perturbation {
    /// Seed of its flight: gusts, noise, starts.
    pub seed: u64,
    /// Mean wind that is added to the scenario's, towards east and north, m/s.
    pub wind_mps: [f64; 2],
    /// True masses of vehicle and load, relative to the scenario's.
    pub mass_ratios: [f64; 2],
    /// Standard deviation of the measured position, m.
    pub noise_m: f64,
    /// Radius of the disc from which the starts are drawn, m.
    pub start_m: f64,
}

impl Dispersions {
    /// The default: a light breeze if wind can act on the vehicles, 3 % of mass, typical position noise (of a satellite receiver or a motion capture system,
    /// by vehicle family), and a start error of a tenth of the largest tracking error allowed.
    pub fn usual(scenario: &Scenario) -> Self {
        let own_m = scenario.simulation.sensors.position_noise_m;
        let noise_m = if own_m > 0.0 { own_m } else { Disturbance::Noise.first_step(scenario) };
        let breeze_mps = families::of(scenario.family()).typical_disturbances.wind_mps;
        let wind_mps = if Disturbance::Wind.without_effect(scenario).is_some() { 0.0 } else { breeze_mps };
        Self { wind_mps, mass: 0.03, noise_m, start_m: scenario.limits().tracking_max_m / 10.0 }
    }

    /// The perturbation of one seed.
    pub fn draw(&self, seed: u64) -> Perturbation {
        let stream = |name: &str| scenarios::stream(seed, &format!("sweep/{name}"));
        let uniform = Uniform::new_inclusive(-1.0, 1.0).expect("-1 is below 1");
        let wind: [f64; 2] = UnitDisc.sample(&mut stream("wind"));
        let ratio = |name: &str| 1.0 + self.mass * uniform.sample(&mut stream(name));
        let fraction = 0.5 + 0.5 * uniform.sample(&mut stream("noise"));
        Perturbation {
            seed,
            wind_mps: wind.map(|component| component * self.wind_mps),
            mass_ratios: [ratio("mass"), ratio("load mass")],
            noise_m: self.noise_m * fraction,
            start_m: self.start_m,
        }
    }
}

impl Perturbation {
    /// Applies it to a scenario.
    pub fn apply(&self, scenario: &mut Scenario) {
        if self.noise_m > 0.0 {
            Disturbance::Noise.set(scenario, self.noise_m);
        }
        let carries_load = scenario.family().carries_load();
        let simulation = &mut scenario.simulation;
        if self.wind_mps != [0.0; 2] {
            let still = Wind { mean_mps: [0.0; 3], gusts: None, pulses: Vec::new() };
            let mean_mps = &mut simulation.wind.get_or_insert(still).mean_mps;
            mean_mps[0] += self.wind_mps[0];
            mean_mps[1] += self.wind_mps[1];
        }
        simulation.mismatch.mass_ratio *= self.mass_ratios[0];
        if carries_load {
            simulation.mismatch.load_mass_ratio *= self.mass_ratios[1];
        }
        if self.start_m > 0.0 {
            simulation.mismatch.start_radius_m = self.start_m;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::Dispersions;

    const DISPERSIONS: Dispersions = Dispersions { wind_mps: 4.0, mass: 0.1, noise_m: 0.5, start_m: 1.0 };

    #[test]
    fn perturbations_fill_their_ranges() {
        let perturbations: Vec<_> = (0..2000).map(|seed| DISPERSIONS.draw(seed)).collect();
        let max = |of: fn(&super::Perturbation) -> f64| perturbations.iter().map(of).fold(f64::NEG_INFINITY, f64::max);
        let min = |of: fn(&super::Perturbation) -> f64| perturbations.iter().map(of).fold(f64::INFINITY, f64::min);
        let wind = |perturbation: &super::Perturbation| perturbation.wind_mps[0].hypot(perturbation.wind_mps[1]);
        assert!(max(wind) <= 4.0 && max(wind) > 3.9 && min(wind) < 0.4);
        assert!((1.09..=1.1).contains(&max(|perturbation| perturbation.mass_ratios[0])));
        assert!((0.9..0.91).contains(&min(|perturbation| perturbation.mass_ratios[1])));
        assert!(max(|perturbation| perturbation.noise_m) <= 0.5 && min(|perturbation| perturbation.noise_m) >= 0.0);
        // Half of the disc's area lies beyond 0.707 of its radius.
        let outer = perturbations.iter().filter(|perturbation| wind(perturbation) > 4.0 * 0.5_f64.sqrt()).count();
        assert!((900..1100).contains(&outer), "{outer}");
    }

    #[test]
    fn zero_dispersions_leave_the_scenario_as_it_is() {
        let perturbation = Dispersions { wind_mps: 0.0, mass: 0.0, noise_m: 0.0, start_m: 0.0 }.draw(7);
        assert_eq!((perturbation.wind_mps, perturbation.mass_ratios, perturbation.noise_m), ([0.0; 2], [1.0; 2], 0.0));
    }
}
