//! What may lie between the rows of a plan that gives no controls.
//!
//! Between two rows the vehicle may do anything that its limits allow, so that |p''| ≤ a with the largest acceleration a that
//! they admit. On an interval of length T let u = t/T ∈ [0, 1].
//!
//! **Positions are given.** Let c be the chord between two rows. p - c vanishes at both, so that
//! p(t) - c(t) = -∫ G(t, s) p''(s) ds with Green's function G ≥ 0 of the second derivative, ∫ G ds = t (T - t)/2, and
//!
//! ```text
//! |p - c| ≤ a T² u (1 - u)/2 ≤ a T²/8        |p' - c'| ≤ a T (u² + (1 - u)²)/2 ≤ a T/2
//! ```
//!
//! **Velocities are given too.** Let h be the cubic Hermite through both rows. Interpolation reproduces cubics, so by Peano's
//! theorem p(t) - h(t) = ∫ K(t, s) p''(s) ds, where for s > t, with w = 1 - s/T,
//! K = T (u² (1 - u) - u² (3 - 2u) w), and likewise for s < t with u and w replaced by 1 - u and 1 - w. Integrating the
//! absolute values of these linear functions gives
//!
//! ```text
//! |p - h| ≤ a T² κ(u),   κ(u) = u² (1 - u)²/2 ((1 + 4 (1 - u)²)/(3 - 2u) + (1 + 4u²)/(1 + 2u)) ≤ κ(1/2) = 1/16
//! |p' - h'| ≤ a T ρ(u) ≤ 0.252 a T
//! ```
//!
//! where ρ is the same integral over |∂K/∂t|. Both bounds are sharp: accelerations of magnitude a that change sign with the
//! kernel attain them. The reconstructed motion q is known, so that |p - q| ≤ |p - c| + |c - q|, and with h for c.

use crate::verdict::compare::larger;
use crate::verdict::provenance::GivenRows;

/// Largest ρ, rounded up.
const MAX_VELOCITY_FACTOR: f64 = 0.252;

/// Largest distance of the vehicle's motion from the curve through two rows, m.
///
/// - `interval_s`: between the rows
pub fn max_distance_m(given: &GivenRows, acceleration_mps2: f64, interval_s: f64) -> f64 {
    acceleration_mps2 * interval_s * interval_s * max_position_factor(given, [0.0, 1.0])
}

/// Largest distance of the vehicle's motion from the chord between two positions, a T² u (1 - u)/2, m.
///
/// - `u`: the instant, as a fraction of the interval
pub fn max_distance_from_chord_m(acceleration_mps2: f64, interval_s: f64, u: f64) -> f64 {
    acceleration_mps2 * interval_s * interval_s * max_position_factor(&GivenRows::Positions, [u, u])
}

/// Largest difference of the vehicle's velocity from that of the chord, a T (u² + (1 - u)²)/2, m/s.
pub fn max_velocity_from_chord_mps(acceleration_mps2: f64, interval_s: f64, u: f64) -> f64 {
    acceleration_mps2 * interval_s * max_velocity_factor(&GivenRows::Positions, [u, u])
}

/// Largest angle by which a velocity turns if up to `error_mps` is added: asin(|error|/|velocity|), deg.
pub fn max_turn_deg(error_mps: f64, speed_mps: f64) -> f64 {
    match error_mps {
        0.0 => 0.0,
        _ if error_mps < speed_mps => (error_mps / speed_mps).asin().to_degrees(),
        _ => 180.0,
    }
}

/// Largest |p - c|/(a T²), or |p - h|/(a T²), over a part of the interval.
pub fn max_position_factor(given: &GivenRows, [from, to]: [f64; 2]) -> f64 {
    let at = |u: f64| match given {
        GivenRows::Positions => u * (1.0 - u) / 2.0,
        GivenRows::States(_) => {
            let ends = (u * (1.0 - u)).powi(2) / 2.0;
            let later = (1.0 + 4.0 * (1.0 - u).powi(2)) / (3.0 - 2.0 * u);
            ends * (later + (1.0 + 4.0 * u * u) / (1.0 + 2.0 * u))
        }
        GivenRows::Everything => 0.0,
    };
    // Both rise until the middle and fall after it.
    at(0.5_f64.clamp(from, to))
}

/// Largest |p' - c'|/(a T), or |p' - h'|/(a T), over a part of the interval.
pub fn max_velocity_factor(given: &GivenRows, [from, to]: [f64; 2]) -> f64 {
    match given {
        GivenRows::Positions => [from, to].map(|u| (u * u + (1.0 - u).powi(2)) / 2.0).into_iter().fold(0.0, larger),
        GivenRows::States(_) => MAX_VELOCITY_FACTOR,
        GivenRows::Everything => 0.0,
    }
}

#[cfg(test)]
mod tests;
