use clap::ValueEnum;
use scenarios::{Issue, Scenario, Wind, wind_without_effect};
use serde::Serialize;

use crate::families;

/// A disturbance whose level is varied. Level 0 is a flight without it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, ValueEnum)]
#[serde(rename_all = "kebab-case")]
pub enum Disturbance {
    /// Speed of the mean wind, m/s, in the direction of the scenario's wind, or towards east; gusts and pulses grow with it
    Wind,
    /// True mass above the nominal one, as a fraction of it; that of a slung load as well
    Mass,
    /// Delay of the measurements that the tracking controller receives, s, in whole simulator steps
    Delay,
    /// Standard deviation of the measured position, m; all other sensor noise grows with it, that of obstacles included
    Noise,
}

impl Disturbance {
    /// Unit of its levels.
    pub fn unit(self) -> &'static str {
        match self {
            Self::Wind => "m/s",
            Self::Mass => "-",
            Self::Delay => "s",
            Self::Noise => "m",
        }
    }

    /// Why it cannot act on the vehicles of a scenario; `None` if it can.
    pub fn without_effect(self, scenario: &Scenario) -> Option<Issue> {
        match self {
            Self::Wind => wind_without_effect(scenario),
            Self::Mass | Self::Delay | Self::Noise => None,
        }
    }

    /// The level in a scenario.
    pub fn level_of(self, scenario: &Scenario) -> f64 {
        let simulation = &scenario.simulation;
        match self {
            Self::Wind => simulation.wind.as_ref().map_or(0.0, mean_speed_mps),
            Self::Mass => simulation.mismatch.mass_ratio - 1.0,
            Self::Delay => simulation.sensors.delay_s,
            Self::Noise => simulation.sensors.position_noise_m,
        }
    }

    /// The first level that is tried after 0.
    pub fn first_step(self, scenario: &Scenario) -> f64 {
        match self {
            Self::Wind => 1.0,
            Self::Mass => 0.02,
            Self::Delay => scenario.simulation.step_s,
            Self::Noise => families::of(scenario.family()).typical_disturbances.position_noise_m,
        }
    }

    /// The largest level that is tried.
    pub fn max_level(self, scenario: &Scenario) -> f64 {
        match self {
            Self::Wind => 64.0,
            Self::Mass => 4.0,
            Self::Delay => 10.0,
            Self::Noise => 1000.0 * self.first_step(scenario),
        }
    }

    /// Smallest difference between two levels.
    pub fn level_step(self, scenario: &Scenario) -> f64 {
        match self {
            Self::Delay => scenario.simulation.step_s,
            Self::Wind | Self::Mass | Self::Noise => 0.0,
        }
    }

    /// The nearest level that can be flown: delays are whole simulator steps.
    pub fn round_level(self, scenario: &Scenario, level: f64) -> f64 {
        let finest = self.level_step(scenario);
        if finest > 0.0 { (level / finest).round() * finest } else { level }
    }

    /// Sets the level in a scenario.
    pub fn set(self, scenario: &mut Scenario, level: f64) {
        match self {
            Self::Wind => {
                let asked = scenario.simulation.wind.take();
                scenario.simulation.wind = (level > 0.0).then(|| scaled(asked, level));
            }
            Self::Mass => {
                scenario.simulation.mismatch.mass_ratio = 1.0 + level;
                if scenario.family().carries_load() {
                    scenario.simulation.mismatch.load_mass_ratio = 1.0 + level;
                }
            }
            Self::Delay => scenario.simulation.sensors.delay_s = level,
            Self::Noise => {
                let reference_m = Self::reference_noise_m(scenario);
                let sensors = &mut scenario.simulation.sensors;
                let factor = level / reference_m;
                sensors.position_noise_m = level;
                for other in [
                    &mut sensors.velocity_noise_mps,
                    &mut sensors.attitude_noise_deg,
                    &mut sensors.rate_noise_degps,
                    &mut sensors.load_position_noise_m,
                    &mut sensors.load_velocity_noise_mps,
                    &mut sensors.sighting_position_noise_m,
                    &mut sensors.sighting_velocity_noise_mps,
                ] {
                    *other *= factor;
                }
            }
        }
    }
}

impl Disturbance {
    /// The noise of the measured position to which the scenario's other noise belongs, m: the scenario's, or the typical one
    /// of the family if the scenario has exact positions.
    fn reference_noise_m(scenario: &Scenario) -> f64 {
        let own_m = scenario.simulation.sensors.position_noise_m;
        if own_m > 0.0 { own_m } else { Self::Noise.first_step(scenario) }
    }
}

/// The scenario's wind, scaled so that its mean has this speed, m/s. A wind without a mean is scaled by its strongest pulse;
/// a wind without either, or none, becomes a mean wind towards east.
fn scaled(asked: Option<Wind>, speed_mps: f64) -> Wind {
    let mut wind = asked.unwrap_or(Wind { mean_mps: [0.0; 3], gusts: None, pulses: Vec::new() });
    let now_mps = mean_speed_mps(&wind);
    if now_mps == 0.0 {
        return Wind { mean_mps: [speed_mps, 0.0, 0.0], ..wind };
    }
    let factor = speed_mps / now_mps;
    let stronger = |velocity: &mut [f64; 3]| velocity.iter_mut().for_each(|component| *component *= factor);
    stronger(&mut wind.mean_mps);
    wind.pulses.iter_mut().for_each(|pulse| stronger(&mut pulse.peak_mps));
    if let Some(gusts) = &mut wind.gusts {
        gusts.wind_at_20ft_mps *= factor;
        gusts.sigma_aloft_mps *= factor;
    }
    wind
}

/// Speed of the mean wind, m/s; without a mean wind, that of the strongest pulse.
fn mean_speed_mps(wind: &Wind) -> f64 {
    let speed = |velocity: &[f64; 3]| velocity.iter().map(|component| component * component).sum::<f64>().sqrt();
    let mean_mps = speed(&wind.mean_mps);
    if mean_mps > 0.0 { mean_mps } else { wind.pulses.iter().map(|pulse| speed(&pulse.peak_mps)).fold(0.0, f64::max) }
}

#[cfg(test)]
mod tests {
    use scenarios::Scenario;

    use super::Disturbance;

    fn scenario() -> Scenario {
        let text = include_str!("../../../scenarios/multirotor/corridor-moving.toml");
        let mut scenario = scenarios::parse("corridor-moving.toml", text).unwrap();
        scenario.simulation.sensors.sighting_position_noise_m = 0.1;
        scenario
    }

    #[test]
    fn noise_of_obstacle_measurements_grows_with_that_of_the_position() {
        let mut scenario = scenario();
        scenario.simulation.sensors.position_noise_m = 0.02;
        Disturbance::Noise.set(&mut scenario, 0.06);
        let sensors = &scenario.simulation.sensors;
        assert_eq!(sensors.position_noise_m, 0.06);
        assert!((sensors.sighting_position_noise_m - 0.3).abs() < 1e-12, "{sensors:?}");
    }

    #[test]
    fn noise_of_obstacle_measurements_alone_grows_from_its_typical_level() {
        let mut scenario = scenario();
        scenario.simulation.sensors.position_noise_m = 0.0;
        let typical_m = Disturbance::Noise.first_step(&scenario);
        Disturbance::Noise.set(&mut scenario, 3.0 * typical_m);
        assert!((scenario.simulation.sensors.sighting_position_noise_m - 0.3).abs() < 1e-12);
        let mut exact = self::scenario();
        exact.simulation.sensors.position_noise_m = 0.0;
        Disturbance::Noise.set(&mut exact, 0.0);
        assert_eq!(exact.simulation.sensors.sighting_position_noise_m, 0.0, "level 0 is without noise");
    }
}
