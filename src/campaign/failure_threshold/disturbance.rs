use clap::ValueEnum;
use scenarios::{Scenario, Wind};
use serde::Serialize;

use crate::families;

/// Disturbances of an ordinary day, for vehicles of one family.
pub struct TypicalDisturbances {
    /// Speed of a light breeze, m/s.
    pub wind_mps: f64,
    /// Standard deviation of the measured position, m.
    pub position_noise_m: f64,
}

/// A disturbance whose level is varied. Level 0 is a flight without it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, ValueEnum)]
#[serde(rename_all = "kebab-case")]
pub enum Disturbance {
    /// Speed of the mean wind, in the scenario's direction, or towards east; gusts and pulses grow with it
    Wind,
    /// True mass above the nominal one, as a fraction of it; of a slung load too
    Mass,
    /// Delay of the measurements that the tracker receives, in whole simulator steps
    Delay,
    /// Standard deviation of the measured position; all other noise, that of obstacle measurements included, grows with it
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
        let simulation = &mut scenario.simulation;
        match self {
            Self::Wind => {
                let asked = simulation.wind.take();
                simulation.wind = (level > 0.0).then(|| blowing(asked, level));
            }
            Self::Mass => {
                simulation.mismatch.mass_ratio = 1.0 + level;
                simulation.mismatch.load_mass_ratio = 1.0 + level;
            }
            Self::Delay => simulation.sensors.delay_s = level,
            Self::Noise => {
                let sensors = &mut simulation.sensors;
                let factor = if sensors.position_noise_m > 0.0 { level / sensors.position_noise_m } else { 0.0 };
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

/// A wind of this speed, m/s: the one that was asked for, with everything in it as much stronger as its mean is; one without a
/// mean but with pulses grows by its largest pulse; without a direction of its own it blows towards east.
fn blowing(asked: Option<Wind>, speed_mps: f64) -> Wind {
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

/// Speed of the mean wind; of one that only blows in pulses, of the strongest, m/s.
fn mean_speed_mps(wind: &Wind) -> f64 {
    let speed = |velocity: &[f64; 3]| velocity.iter().map(|component| component * component).sum::<f64>().sqrt();
    let mean_mps = speed(&wind.mean_mps);
    if mean_mps > 0.0 { mean_mps } else { wind.pulses.iter().map(|pulse| speed(&pulse.peak_mps)).fold(0.0, f64::max) }
}
