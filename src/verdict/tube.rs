//! How far the true motion of a vehicle may be from the one that is judged, stretch by stretch.

use crate::verdict::compare::larger;
use crate::verdict::motion::Motion;

/// The deviations over the time of a plan.
#[derive(Clone, Debug, Default)]
pub struct Tube {
    stretches: Vec<Stretch>,
}

/// A stretch of time and the largest deviations during it.
#[derive(Clone, Copy, Debug)]
pub struct Stretch {
    /// Its end, s.
    pub end_s: f64,
    /// Distance, m.
    pub position_m: f64,
    /// Difference of the velocities, m/s.
    pub velocity_mps: f64,
}

/// How far the true end of a vehicle's plan may be from the one that is judged.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct EndError {
    /// Distance, m.
    pub position_m: f64,
    /// Difference of the velocities, m/s.
    pub velocity_mps: f64,
}

impl Tube {
    /// The tube with these stretches, in the order of time.
    pub fn new(stretches: Vec<Stretch>) -> Self {
        Self { stretches }
    }

    /// The same tube around rows that are known up to a distance, m.
    pub fn widened(mut self, distance_m: f64) -> Self {
        self.stretches.iter_mut().for_each(|stretch| stretch.position_m += distance_m);
        self
    }

    /// Whether the true motion may be anywhere else.
    pub fn has_width(&self) -> bool {
        self.stretches.iter().any(|stretch| stretch.position_m != 0.0)
    }

    /// The motion in its tube.
    pub fn surround(&self, motion: Motion) -> Motion {
        if self.has_width() { motion.within(|segment| self.distance_m(segment.t_s)) } else { motion }
    }

    /// Largest distance from the judged motion during an interval of time, m.
    pub fn distance_m(&self, t_s: [f64; 2]) -> f64 {
        self.during(t_s).map(|stretch| stretch.position_m).fold(0.0, larger)
    }

    /// Largest difference of the velocities at a time, m/s.
    pub fn velocity_mps(&self, t_s: f64) -> f64 {
        self.during([t_s, t_s]).map(|stretch| stretch.velocity_mps).fold(0.0, larger)
    }

    /// The stretches that touch an interval of time; beyond the end the last one.
    fn during(&self, [from_s, to_s]: [f64; 2]) -> impl Iterator<Item = &Stretch> {
        let last = self.stretches.len().saturating_sub(1);
        let first = self.stretches.partition_point(|stretch| stretch.end_s < from_s).min(last);
        let end = self.stretches.partition_point(|stretch| stretch.end_s < to_s).min(last);
        self.stretches.iter().skip(first).take(end + 1 - first)
    }
}
