//! Single gusts of 1 - cos shape.

use std::f64::consts::TAU;

use nalgebra::Vector3;
use scenarios::GustPulse;

/// Velocity of the air in all single gusts at `t_s`, m/s.
pub(super) fn sum_mps(pulses: &[GustPulse], t_s: f64) -> Vector3<f64> {
    pulses.iter().fold(Vector3::zeros(), |sum, pulse| sum + velocity_mps(pulse, t_s))
}

/// Does a single gust blow at some time in the open interval between these two, s?
pub(crate) fn overlaps(pulse: &GustPulse, [from_s, to_s]: [f64; 2]) -> bool {
    pulse.start_s < to_s && from_s < pulse.start_s + pulse.duration_s
}

pub(super) fn velocity_mps(pulse: &GustPulse, t_s: f64) -> Vector3<f64> {
    let fraction = (t_s - pulse.start_s) / pulse.duration_s;
    let height = if (0.0..=1.0).contains(&fraction) { 0.5 * (1.0 - (TAU * fraction).cos()) } else { 0.0 };
    Vector3::from(pulse.peak_mps) * height
}
