//! Closest approach during one time slice.

use nalgebra::Vector2;

use super::super::shooting::SUBSTEPS;
use super::motion::{MotionSample, TimeSlice, interpolate};

/// Maximum number of iterations of the root search within one Runge-Kutta step.
const MAX_ROOT_ITERATIONS: usize = 30;

/// The instant of smallest distance.
#[derive(Clone, Copy, Debug)]
pub struct ClosestApproach {
    /// Fraction of the time slice that has passed, in [0, 1].
    pub fraction: f64,
    /// Motion relative to the other at that instant.
    pub relative: MotionSample,
    /// Distance, m.
    pub distance_m: f64,
}

/// Closest approach of two vehicles in a time slice of `width_s`, until a fraction of it at which one of them arrives.
pub fn of_vehicles(a: &TimeSlice, b: &TimeSlice, width_s: f64, until: f64) -> ClosestApproach {
    let relative = std::array::from_fn(|m| MotionSample {
        position_m: a[m].position_m - b[m].position_m,
        velocity_mps: a[m].velocity_mps - b[m].velocity_mps,
    });
    to_origin(&relative, width_s, until)
}

/// Closest approach of a vehicle and a fixed point in a time slice of `width_s`.
pub fn to_point(a: &TimeSlice, point_m: Vector2<f64>, width_s: f64) -> ClosestApproach {
    to_origin(&a.map(|at| MotionSample { position_m: at.position_m - point_m, ..at }), width_s, 1.0)
}

fn to_origin(relative: &TimeSlice, width_s: f64, until: f64) -> ClosestApproach {
    let step_s = width_s / SUBSTEPS as f64;
    let mut nearest = approach(0.0, relative[0]);
    for step in 0..SUBSTEPS {
        let end = (until * SUBSTEPS as f64 - step as f64).min(1.0);
        if end <= 0.0 {
            break;
        }
        let (a, b) = (&relative[step], &relative[step + 1]);
        let last = if end < 1.0 { interpolate(a, b, end, step_s) } else { *b };
        let mut consider = |fraction: f64, at: MotionSample| {
            let candidate = approach((step as f64 + fraction) / SUBSTEPS as f64, at);
            if candidate.distance_m < nearest.distance_m {
                nearest = candidate;
            }
        };
        consider(end, last);
        // either half of the step may contain a minimum
        let middle = interpolate(a, b, 0.5 * end, step_s);
        for (from, to, [begin, end]) in [(a, &middle, [0.0, 0.5 * end]), (&middle, &last, [0.5 * end, end])] {
            if rate(from) < 0.0 && rate(to) > 0.0 {
                let fraction = minimum_fraction(a, b, [begin, end], step_s);
                consider(fraction, interpolate(a, b, fraction, step_s));
            }
        }
    }
    nearest
}

fn approach(fraction: f64, relative: MotionSample) -> ClosestApproach {
    let distance_m = relative.position_m.x.hypot(relative.position_m.y);
    ClosestApproach { fraction, relative, distance_m }
}

/// Half the time derivative of the squared distance, m²/s.
fn rate(at: &MotionSample) -> f64 {
    at.position_m.dot(&at.velocity_mps)
}

/// Fraction of the step at which the rate changes sign from negative to positive, by false position; halving the rate
/// at the retained end keeps both ends moving.
fn minimum_fraction(a: &MotionSample, b: &MotionSample, [mut low, mut high]: [f64; 2], step_s: f64) -> f64 {
    let rate_at = |fraction: f64| rate(&interpolate(a, b, fraction, step_s));
    let (mut rate_low, mut rate_high) = (rate_at(low), rate_at(high));
    for _ in 0..MAX_ROOT_ITERATIONS {
        let fraction = (low + (high - low) * rate_low / (rate_low - rate_high)).clamp(low, high);
        let rate = rate_at(fraction);
        if rate < 0.0 {
            (low, rate_low, rate_high) = (fraction, rate, 0.5 * rate_high);
        } else {
            (high, rate_high, rate_low) = (fraction, rate, 0.5 * rate_low);
        }
        if high - low < 1e-9 || rate == 0.0 {
            return fraction;
        }
    }
    0.5 * (low + high)
}

#[cfg(test)]
mod tests {
    use super::*;

    const WIDTH_S: f64 = 4.0;

    /// x = 100 - 60 t, y = 5 + t²: cubic Hermite interpolation is exact.
    fn passing() -> TimeSlice {
        std::array::from_fn(|m| {
            let t_s = WIDTH_S * m as f64 / SUBSTEPS as f64;
            MotionSample {
                position_m: Vector2::new(100.0 - 60.0 * t_s, 5.0 + t_s * t_s),
                velocity_mps: Vector2::new(-60.0, 2.0 * t_s),
            }
        })
    }

    #[test]
    fn closest_approach_agrees_with_dense_samples() {
        let found = to_point(&passing(), Vector2::zeros(), WIDTH_S);
        let distance_m = |t_s: f64| (100.0 - 60.0 * t_s).hypot(5.0 + t_s * t_s);
        let samples = (0..=400_000).map(|k| distance_m(1e-5 * f64::from(k)));
        let smallest_m = samples.fold(f64::INFINITY, f64::min);
        assert!((found.distance_m - smallest_m).abs() < 1e-6, "{} m, {smallest_m} m", found.distance_m);
        assert!((distance_m(WIDTH_S * found.fraction) - found.distance_m).abs() < 1e-9);
        assert!(rate(&found.relative).abs() < 1e-3);
    }

    #[test]
    fn vehicles_side_by_side_keep_their_distance() {
        let shifted = passing().map(|at| MotionSample { position_m: at.position_m + Vector2::new(0.0, 30.0), ..at });
        let found = of_vehicles(&passing(), &shifted, WIDTH_S, 1.0);
        assert!((found.distance_m - 30.0).abs() < 1e-12);
    }

    #[test]
    fn closest_approach_may_lie_at_an_end() {
        let found = to_point(&passing(), Vector2::new(500.0, 5.0), WIDTH_S);
        assert_eq!((found.fraction, found.distance_m), (0.0, 400.0));
    }

    #[test]
    fn vehicles_count_until_one_of_them_arrives() {
        let still = passing().map(|_| MotionSample { position_m: Vector2::zeros(), velocity_mps: Vector2::zeros() });
        let until = 1.3 / WIDTH_S;
        let found = of_vehicles(&passing(), &still, WIDTH_S, until);
        let distance_m = (100.0_f64 - 60.0 * 1.3).hypot(5.0 + 1.3 * 1.3);
        assert!((found.fraction - until).abs() < 1e-12 && (found.distance_m - distance_m).abs() < 1e-9, "{found:?}");
    }
}
