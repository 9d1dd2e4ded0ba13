use std::collections::VecDeque;

use nalgebra::{UnitQuaternion, Vector3};
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};

use crate::kinematics::AttitudeState;

/// Measured position, m, and velocity over ground, m/s, world frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Measurement {
    pub position_m: Vector3<f64>,
    pub velocity_mps: Vector3<f64>,
}

/// Sensors with white Gaussian noise, independent on every axis and at every step.
#[derive(Clone, Debug)]
pub(crate) struct Sensors {
    settings: scenarios::Sensors,
    rng: ChaCha8Rng,
}

impl Sensors {
    pub fn new(settings: &scenarios::Sensors, rng: ChaCha8Rng) -> Self {
        Self { settings: settings.clone(), rng }
    }

    /// Measures the vehicle's own position, m, and velocity over ground, m/s. A quantity without noise draws no random
    /// number.
    pub fn measure(&mut self, position_m: Vector3<f64>, velocity_mps: Vector3<f64>) -> Measurement {
        let scenarios::Sensors { position_noise_m, velocity_noise_mps, .. } = self.settings;
        self.with_noise([position_m, velocity_mps], [position_noise_m, velocity_noise_mps])
    }

    /// Measures the vehicle's own attitude and angular velocity.
    pub fn measure_attitude(&mut self, truth: &AttitudeState) -> AttitudeState {
        let scenarios::Sensors { attitude_noise_deg, rate_noise_degps, .. } = self.settings;
        let rotation = self.disturbed(Vector3::zeros(), attitude_noise_deg.to_radians());
        AttitudeState {
            attitude: truth.attitude * UnitQuaternion::from_scaled_axis(rotation),
            rate_radps: self.disturbed(truth.rate_radps, rate_noise_degps.to_radians()),
        }
    }

    /// Measures another moving body, as [`measure`](Self::measure).
    pub fn measure_other(&mut self, position_m: Vector3<f64>, velocity_mps: Vector3<f64>) -> Measurement {
        let scenarios::Sensors { sighting_position_noise_m, sighting_velocity_noise_mps, .. } = self.settings;
        self.with_noise([position_m, velocity_mps], [sighting_position_noise_m, sighting_velocity_noise_mps])
    }

    /// Measures a slung load, as [`measure`](Self::measure).
    pub fn measure_load(&mut self, position_m: Vector3<f64>, velocity_mps: Vector3<f64>) -> Measurement {
        let scenarios::Sensors { load_position_noise_m, load_velocity_noise_mps, .. } = self.settings;
        self.with_noise([position_m, velocity_mps], [load_position_noise_m, load_velocity_noise_mps])
    }

    fn with_noise(&mut self, truth: [Vector3<f64>; 2], sigma: [f64; 2]) -> Measurement {
        Measurement { position_m: self.disturbed(truth[0], sigma[0]), velocity_mps: self.disturbed(truth[1], sigma[1]) }
    }

    fn disturbed(&mut self, truth: Vector3<f64>, sigma: f64) -> Vector3<f64> {
        if sigma == 0.0 {
            return truth;
        }
        truth.map(|component| {
            let unit: f64 = StandardNormal.sample(&mut self.rng);
            component + sigma * unit
        })
    }
}

/// Delays measurements. Until the delay has passed, it returns the first measurement.
#[derive(Clone, Debug)]
pub(crate) struct Delay<T> {
    steps: usize,
    pending: VecDeque<T>,
}

impl<T: Copy> Delay<T> {
    /// A delay of `delay_s`, rounded to whole steps of the simulator.
    pub fn new(delay_s: f64, step_s: f64) -> Self {
        Self { steps: (delay_s / step_s).round() as usize, pending: VecDeque::new() }
    }

    /// Takes the measurement of this step, and returns the one that the vehicle receives now. To be called once per
    /// step.
    pub fn pass(&mut self, measured: T) -> T {
        self.pending.push_back(measured);
        let oldest = self.pending[0];
        if self.pending.len() > self.steps {
            self.pending.pop_front();
        }
        oldest
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn noise_has_the_standard_deviation_of_the_settings() {
        let settings = scenarios::Sensors { position_noise_m: 2.0, velocity_noise_mps: 0.1, ..Default::default() };
        let mut sensors = Sensors::new(&settings, scenarios::stream(3, "sensors/test"));
        let draws = 100_000;
        let (mut position, mut velocity, mut cross) = (Vector3::zeros(), Vector3::zeros(), 0.0);
        for _ in 0..draws {
            let Measurement { position_m, velocity_mps } = sensors.measure(Vector3::zeros(), Vector3::zeros());
            position += position_m.component_mul(&position_m) / f64::from(draws);
            velocity += velocity_mps.component_mul(&velocity_mps) / f64::from(draws);
            cross += position_m.x * velocity_mps.x / f64::from(draws);
        }
        // A variance from n samples has the relative standard deviation sqrt(2/n) = 0.0045.
        for axis in 0..3 {
            assert!((position[axis] / 4.0 - 1.0).abs() < 0.02, "{position}");
            assert!((velocity[axis] / 0.01 - 1.0).abs() < 0.02, "{velocity}");
        }
        assert!((cross / 0.2).abs() < 0.013, "{cross}");
    }

    #[test]
    fn without_noise_the_truth_is_measured() {
        let mut sensors = Sensors::new(&scenarios::Sensors::default(), scenarios::stream(0, "sensors/test"));
        let (p, v) = (Vector3::new(1.0, 2.0, 3.0), Vector3::new(4.0, 5.0, 6.0));
        assert_eq!(sensors.measure(p, v), Measurement { position_m: p, velocity_mps: v });
    }

    #[test]
    fn delayed_measurements_arrive_in_order_and_none_is_lost() {
        let mut delay = Delay::new(0.021, 0.01);
        assert_eq!([1, 2, 3, 4, 5].map(|value| delay.pass(value)), [1, 1, 1, 2, 3]);
        let mut none = Delay::new(0.0, 0.01);
        assert_eq!([1, 2, 3].map(|value| none.pass(value)), [1, 2, 3]);
    }
}
