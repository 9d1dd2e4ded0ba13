//! Closest approach during one slab of time.

use super::super::shooting::SUBSTEPS;
use super::track::{Instant, Slab, between};

/// Rounds of the search inside one Runge-Kutta step; each halves or better.
const ROUNDS: usize = 30;

/// Where the distance is smallest.
#[derive(Clone, Copy, Debug)]
pub struct Approach {
    /// Share of the slab at which it is, in [0, 1].
    pub share: f64,
    /// Motion relative to the other at that instant.
    pub relative: Instant,
    /// Distance, m.
    pub distance_m: f64,
}

/// Closest approach of two vehicles in a slab of `width_s`.
pub fn of_vehicles(a: &Slab, b: &Slab, width_s: f64) -> Approach {
    let relative = std::array::from_fn(|m| Instant {
        position_m: difference(a[m].position_m, b[m].position_m),
        velocity_mps: difference(a[m].velocity_mps, b[m].velocity_mps),
    });
    to_origin(&relative, width_s)
}

/// Closest approach of a vehicle and a point that stands still.
pub fn to_point(a: &Slab, point_m: [f64; 2], width_s: f64) -> Approach {
    to_origin(&a.map(|at| Instant { position_m: difference(at.position_m, point_m), ..at }), width_s)
}

fn to_origin(relative: &Slab, width_s: f64) -> Approach {
    let step_s = width_s / SUBSTEPS as f64;
    let mut nearest = approach(0.0, relative[0]);
    for step in 0..SUBSTEPS {
        let (a, b) = (&relative[step], &relative[step + 1]);
        let mut consider = |share: f64, at: Instant| {
            let candidate = approach((step as f64 + share) / SUBSTEPS as f64, at);
            if candidate.distance_m < nearest.distance_m {
                nearest = candidate;
            }
        };
        consider(1.0, *b);
        // the distance may turn round in either half of the step
        let middle = between(a, b, 0.5, step_s);
        for (from, to, [begin, end]) in [(a, &middle, [0.0, 0.5]), (&middle, b, [0.5, 1.0])] {
            if rate(from) < 0.0 && rate(to) > 0.0 {
                let share = turning_share(a, b, [begin, end], step_s);
                consider(share, between(a, b, share, step_s));
            }
        }
    }
    nearest
}

fn approach(share: f64, relative: Instant) -> Approach {
    let [x, y] = relative.position_m;
    Approach { share, relative, distance_m: x.hypot(y) }
}

/// Half the time derivative of the squared distance, m²/s.
fn rate(at: &Instant) -> f64 {
    at.position_m[0] * at.velocity_mps[0] + at.position_m[1] * at.velocity_mps[1]
}

/// Where the rate changes its sign from minus to plus: false position with bisection as the fallback.
fn turning_share(a: &Instant, b: &Instant, [mut low, mut high]: [f64; 2], step_s: f64) -> f64 {
    let rate_at = |share: f64| rate(&between(a, b, share, step_s));
    let (mut rate_low, mut rate_high) = (rate_at(low), rate_at(high));
    for _ in 0..ROUNDS {
        let share = (low + (high - low) * rate_low / (rate_low - rate_high)).clamp(low, high);
        let here = rate_at(share);
        if here < 0.0 {
            (low, rate_low, rate_high) = (share, here, 0.5 * rate_high);
        } else {
            (high, rate_high, rate_low) = (share, here, 0.5 * rate_low);
        }
        if high - low < 1e-9 || here == 0.0 {
            return share;
        }
    }
    0.5 * (low + high)
}

fn difference(a: [f64; 2], b: [f64; 2]) -> [f64; 2] {
    [a[0] - b[0], a[1] - b[1]]
}

#[cfg(test)]
mod tests {
    use super::*;

    const WIDTH_S: f64 = 4.0;

    /// x = 100 - 60 t, y = 5 + t²: cubic Hermite pieces hold it exactly.
    fn passing() -> Slab {
        std::array::from_fn(|m| {
            let t_s = WIDTH_S * m as f64 / SUBSTEPS as f64;
            Instant { position_m: [100.0 - 60.0 * t_s, 5.0 + t_s * t_s], velocity_mps: [-60.0, 2.0 * t_s] }
        })
    }

    #[test]
    fn closest_approach_agrees_with_dense_samples() {
        let found = to_point(&passing(), [0.0, 0.0], WIDTH_S);
        let distance_m = |t_s: f64| (100.0 - 60.0 * t_s).hypot(5.0 + t_s * t_s);
        let samples = (0..=400_000).map(|k| distance_m(1e-5 * f64::from(k)));
        let smallest_m = samples.fold(f64::INFINITY, f64::min);
        assert!((found.distance_m - smallest_m).abs() < 1e-6, "{} m, {smallest_m} m", found.distance_m);
        assert!((distance_m(WIDTH_S * found.share) - found.distance_m).abs() < 1e-9);
        assert!(rate(&found.relative).abs() < 1e-3);
    }

    #[test]
    fn nothing_is_nearer_than_vehicles_that_fly_side_by_side() {
        let shifted = passing().map(|at| Instant { position_m: [at.position_m[0], at.position_m[1] + 30.0], ..at });
        let found = of_vehicles(&passing(), &shifted, WIDTH_S);
        assert!((found.distance_m - 30.0).abs() < 1e-12);
    }

    #[test]
    fn approach_at_an_end_is_found_there() {
        let found = to_point(&passing(), [500.0, 5.0], WIDTH_S);
        assert_eq!((found.share, found.distance_m), (0.0, 400.0));
    }
}
