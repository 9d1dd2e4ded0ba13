use nalgebra::Vector3;
use scenarios::{GustPulse, Wind};

use super::pulse;
use crate::flight::Sample;

/// Intervals of a replay for each single gust.
const INTERVALS_PER_PULSE: f64 = 8.0;

/// The air over the step between two samples of a flight log: at both ends as logged, in between the single gusts of the
/// scenario, and the rest linear in time.
#[derive(Clone, Debug)]
pub struct LoggedAir<'a> {
    times_s: [f64; 2],
    /// Single gusts that blow during the step.
    pulses: Vec<&'a GustPulse>,
    /// What else moves, at the two ends, m/s.
    rest_mps: [Vector3<f64>; 2],
}

impl<'a> LoggedAir<'a> {
    /// Between two samples that follow each other, in the wind of their scenario.
    pub fn new(wind: Option<&'a Wind>, samples: [&Sample; 2]) -> Self {
        let times_s = samples.map(|sample| sample.t_s);
        let pulses = wind.iter().flat_map(|wind| &wind.pulses).filter(|it| pulse::overlaps(it, times_s));
        let pulses: Vec<&GustPulse> = pulses.collect();
        let rest_mps = samples.map(|sample| Vector3::from(sample.wind_mps) - pulses_mps(&pulses, sample.t_s));
        Self { times_s, pulses, rest_mps }
    }

    /// Time between the two samples, s.
    pub fn step_s(&self) -> f64 {
        self.times_s[1] - self.times_s[0]
    }

    /// Velocity of the air, world frame, m/s, at a fraction of the step, in [0, 1].
    pub fn velocity_mps(&self, fraction: f64) -> Vector3<f64> {
        let t_s = self.times_s[0] + self.step_s() * fraction;
        self.rest_mps[0] + (self.rest_mps[1] - self.rest_mps[0]) * fraction + pulses_mps(&self.pulses, t_s)
    }

    /// Ends of the intervals in which the air is smooth, as ascending fractions of the step, from 0 to 1.
    pub(crate) fn smooth_intervals(&self) -> Vec<f64> {
        let ends_s = self.pulses.iter().flat_map(|pulse| {
            let part_s = pulse.duration_s / INTERVALS_PER_PULSE;
            (0..=INTERVALS_PER_PULSE as usize).map(move |part| pulse.start_s + part as f64 * part_s)
        });
        let inside = ends_s.map(|end_s| (end_s - self.times_s[0]) / self.step_s()).filter(|it| 0.0 < *it && *it < 1.0);
        let mut fractions: Vec<f64> = [0.0, 1.0].into_iter().chain(inside).collect();
        fractions.sort_by(f64::total_cmp);
        fractions
    }
}

fn pulses_mps(pulses: &[&GustPulse], t_s: f64) -> Vector3<f64> {
    pulses.iter().fold(Vector3::zeros(), |sum, it| sum + pulse::velocity_mps(it, t_s))
}
