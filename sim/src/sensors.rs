use std::collections::VecDeque;

use nalgebra::{UnitQuaternion, Vector3};
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};

use crate::quadrotor::AttitudeState;
use crate::slung_load::SlungLoadState;

/// What the sensors say of position (m) and velocity over ground (m/s), world frame.
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

    /// One measurement. What has no noise draws no random number.
    pub fn measure(&mut self, position_m: Vector3<f64>, velocity_mps: Vector3<f64>) -> Measurement {
        Measurement {
            position_m: self.disturbed(position_m, self.settings.position_noise_m),
            velocity_mps: self.disturbed(velocity_mps, self.settings.velocity_noise_mps),
        }
    }

    /// What is measured of the attitude (world from body) and of the angular velocity in body axes, rad/s.
    pub fn measure_turning(&mut self, truth: &AttitudeState) -> AttitudeState {
        let scenarios::Sensors { attitude_noise_deg, rate_noise_degps, .. } = self.settings;
        let turn = self.disturbed(Vector3::zeros(), attitude_noise_deg.to_radians());
        AttitudeState {
            attitude: truth.attitude * UnitQuaternion::from_scaled_axis(turn),
            rate_radps: self.disturbed(truth.rate_radps, rate_noise_degps.to_radians()),
        }
    }

    /// What is measured of something else that moves: position, m, and velocity, m/s.
    pub fn sight(&mut self, position_m: Vector3<f64>, velocity_mps: Vector3<f64>) -> Measurement {
        Measurement {
            position_m: self.disturbed(position_m, self.settings.sighting_position_noise_m),
            velocity_mps: self.disturbed(velocity_mps, self.settings.sighting_velocity_noise_mps),
        }
    }

    /// One measurement of a quadrotor and its load.
    pub fn measure_slung_load(&mut self, truth: &SlungLoadState) -> SlungLoadState {
        let Measurement { position_m, velocity_mps } = self.measure(truth.position_m, truth.velocity_mps);
        let turning = AttitudeState { attitude: truth.attitude, rate_radps: truth.body_rate_radps };
        let AttitudeState { attitude, rate_radps } = self.measure_turning(&turning);
        SlungLoadState {
            position_m,
            velocity_mps,
            attitude,
            body_rate_radps: rate_radps,
            load_position_m: self.disturbed(truth.load_position_m, self.settings.load_position_noise_m),
            load_velocity_mps: self.disturbed(truth.load_velocity_mps, self.settings.load_velocity_noise_mps),
        }
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

/// Hands on what was measured a while ago; in the beginning, the first that there was.
#[derive(Clone, Debug)]
pub(crate) struct Delay<T> {
    steps: usize,
    under_way: VecDeque<T>,
}

impl<T: Copy> Delay<T> {
    /// By so much time, s, in steps of the simulator.
    pub fn new(delay_s: f64, step_s: f64) -> Self {
        Self { steps: (delay_s / step_s).round() as usize, under_way: VecDeque::new() }
    }

    /// Takes what is measured now, once per step, and returns what the vehicle gets to know now.
    pub fn pass(&mut self, measured: T) -> T {
        self.under_way.push_back(measured);
        let oldest = self.under_way[0];
        if self.under_way.len() > self.steps {
            self.under_way.pop_front();
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
    fn what_is_late_comes_in_order_and_nothing_is_lost() {
        let mut delay = Delay::new(0.021, 0.01);
        assert_eq!([1, 2, 3, 4, 5].map(|value| delay.pass(value)), [1, 1, 1, 2, 3]);
        let mut none = Delay::new(0.0, 0.01);
        assert_eq!([1, 2, 3].map(|value| none.pass(value)), [1, 2, 3]);
    }
}
