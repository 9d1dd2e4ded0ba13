use rand_distr::{Distribution, Uniform, UnitDisc};
use scenarios::{Scenario, Wind};
use serde::{Deserialize, Serialize};

use crate::campaign::failure_threshold::Disturbance;
use crate::families;

/// How far the world may be from the scenario's; what is 0 is as the scenario has it.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Dispersions {
    /// A mean wind drawn from the horizontal disc of this radius is added to the scenario's, m/s.
    pub wind_mps: f64,
    /// True masses are drawn this far to either side of the scenario's, as a share; that of a load on its own.
    pub mass: f64,
    /// Standard deviation of the measured position is drawn up to this, m; all other noise grows with it.
    pub noise_m: f64,
    /// Starts are drawn from the horizontal disc of this radius, m.
    pub start_m: f64,
}

/// What was drawn for one sample.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Perturbation {
    /// Seed of its flight: gusts, noise, starts.
    pub seed: u64,
    /// Wind that is added to the scenario's, towards east and north, m/s.
    pub wind_mps: [f64; 2],
    /// True masses of vehicle and load, relative to the scenario's, -.
    pub mass_ratios: [f64; 2],
    /// Standard deviation of the measured position, m.
    pub noise_m: f64,
    /// Radius of the disc from which the starts are drawn, m.
    pub start_m: f64,
}

impl Dispersions {
    /// What is drawn if nobody says: a light breeze, a few percent of mass, the noise of an ordinary receiver (of a motion
    /// capture system for those who fly in centimetres), and a start off by a tenth of what tracking may be.
    pub fn usual(scenario: &Scenario) -> Self {
        let own_m = scenario.simulation.sensors.position_noise_m;
        let noise_m = if own_m > 0.0 { own_m } else { Disturbance::Noise.first_step(scenario) };
        let wind_mps = families::of(scenario.family()).typical_disturbances.wind_mps;
        Self { wind_mps, mass: 0.03, noise_m, start_m: scenario.limits().tracking_max_m / 10.0 }
    }

    /// The perturbation of one seed.
    pub fn draw(&self, seed: u64) -> Perturbation {
        let stream = |name: &str| scenarios::stream(seed, &format!("sweep/{name}"));
        let uniform = Uniform::new_inclusive(-1.0, 1.0).expect("-1 is below 1");
        let wind: [f64; 2] = UnitDisc.sample(&mut stream("wind"));
        let ratio = |name: &str| 1.0 + self.mass * uniform.sample(&mut stream(name));
        let share = 0.5 + 0.5 * uniform.sample(&mut stream("noise"));
        Perturbation {
            seed,
            wind_mps: wind.map(|component| component * self.wind_mps),
            mass_ratios: [ratio("mass"), ratio("load mass")],
            noise_m: self.noise_m * share,
            start_m: self.start_m,
        }
    }
}

impl Perturbation {
    /// Changes a scenario's world by it.
    pub fn apply(&self, scenario: &mut Scenario) {
        if self.noise_m > 0.0 {
            Disturbance::Noise.set(scenario, self.noise_m);
        }
        let simulation = &mut scenario.simulation;
        if self.wind_mps != [0.0; 2] {
            let still = Wind { mean_mps: [0.0; 3], gusts: None, pulses: Vec::new() };
            let mean_mps = &mut simulation.wind.get_or_insert(still).mean_mps;
            mean_mps[0] += self.wind_mps[0];
            mean_mps[1] += self.wind_mps[1];
        }
        simulation.mismatch.mass_ratio *= self.mass_ratios[0];
        simulation.mismatch.load_mass_ratio *= self.mass_ratios[1];
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
    fn draws_fill_their_ranges_and_nothing_else() {
        let perturbations: Vec<_> = (0..2000).map(|seed| DISPERSIONS.draw(seed)).collect();
        let most = |of: fn(&super::Perturbation) -> f64| perturbations.iter().map(of).fold(f64::NEG_INFINITY, f64::max);
        let least = |of: fn(&super::Perturbation) -> f64| perturbations.iter().map(of).fold(f64::INFINITY, f64::min);
        let wind = |perturbation: &super::Perturbation| perturbation.wind_mps[0].hypot(perturbation.wind_mps[1]);
        assert!(most(wind) <= 4.0 && most(wind) > 3.9 && least(wind) < 0.4);
        assert!((1.09..=1.1).contains(&most(|perturbation| perturbation.mass_ratios[0])));
        assert!((0.9..0.91).contains(&least(|perturbation| perturbation.mass_ratios[1])));
        assert!(most(|perturbation| perturbation.noise_m) <= 0.5 && least(|perturbation| perturbation.noise_m) >= 0.0);
        // Half of the disc's area lies beyond 0.707 of its radius.
        let outer = perturbations.iter().filter(|perturbation| wind(perturbation) > 4.0 * 0.5_f64.sqrt()).count();
        assert!((900..1100).contains(&outer), "{outer}");
    }

    #[test]
    fn a_spread_of_nothing_is_the_scenario_itself() {
        let perturbation = Dispersions { wind_mps: 0.0, mass: 0.0, noise_m: 0.0, start_m: 0.0 }.draw(7);
        assert_eq!((perturbation.wind_mps, perturbation.mass_ratios, perturbation.noise_m), ([0.0; 2], [1.0; 2], 0.0));
    }
}
