//! Smallest value over time of max(|horizontal part|, |vertical part| + c) of a cubic, by branch and bound.
//!
//! Both parts lie in the convex hull of their Bernstein coefficients. Where the larger of the two changes, the bounds approach
//! each other by a factor of two per halving, elsewhere by four.

use crate::verdict::bernstein::{self, Minimum};
use crate::verdict::compare::larger;

/// Most halvings of an interval, and most intervals looked at for one cubic. Beyond them the bounds stay apart, and the check
/// becomes undecided rather than wrong.
const MAX_DEPTH: u32 = 52;
const MAX_INTERVALS: u32 = 4000;
/// Rounding of a value, as a share of the largest coordinate.
const ROUNDING: f64 = 64.0 * f64::EPSILON;

/// The smallest value, as far as it is below `beat`, m.
///
/// - `points_m`: Bernstein coefficients of the cubic
/// - `raised_m`: c
/// - `resolution_m`: the distance between the bounds that is close enough, > 0
pub fn minimise(points_m: &[[f64; 3]; 4], raised_m: f64, beat: f64, resolution_m: f64) -> Minimum {
    let extent_m = points_m.iter().flatten().fold(raised_m.abs(), |extent_m, x| larger(extent_m, x.abs()));
    if !extent_m.is_finite() {
        return Minimum { lower: f64::NEG_INFINITY, upper: beat, at: None };
    }
    let mut search = Search { raised_m, resolution_m, lower: beat, upper: beat, at: None, intervals: 0 };
    search.descend(points_m, [0.0, 1.0], 0);
    let rounding_m = ROUNDING * extent_m;
    Minimum { lower: search.lower.min(search.upper) - rounding_m, upper: search.upper + rounding_m, at: search.at }
}

struct Search {
    raised_m: f64,
    resolution_m: f64,
    lower: f64,
    upper: f64,
    at: Option<f64>,
    intervals: u32,
}

impl Search {
    fn descend(&mut self, points_m: &[[f64; 3]; 4], span: [f64; 2], depth: u32) {
        self.intervals += 1;
        self.try_value(&points_m[0], span[0]);
        self.try_value(&points_m[3], span[1]);
        let bound = self.bound(points_m);
        if bound >= self.upper - self.resolution_m || depth == MAX_DEPTH || self.intervals >= MAX_INTERVALS {
            self.lower = self.lower.min(bound);
            return;
        }
        let middle = 0.5 * (span[0] + span[1]);
        let axes = [0, 1, 2].map(|axis| bernstein::split(&points_m.map(|point| point[axis]), 0.5));
        let left = std::array::from_fn(|k| [0, 1, 2].map(|axis| axes[axis].0[k]));
        let right = std::array::from_fn(|k| [0, 1, 2].map(|axis| axes[axis].1[k]));
        let (left_span, right_span) = ([span[0], middle], [middle, span[1]]);
        if self.bound(&left) <= self.bound(&right) {
            self.descend(&left, left_span, depth + 1);
            self.descend(&right, right_span, depth + 1);
        } else {
            self.descend(&right, right_span, depth + 1);
            self.descend(&left, left_span, depth + 1);
        }
    }

    fn try_value(&mut self, point_m: &[f64; 3], at: f64) {
        let value = (point_m[2].abs() + self.raised_m).max(point_m[0].hypot(point_m[1]));
        if value < self.upper {
            self.upper = value;
            self.at = Some(at);
        }
    }

    /// No value of the cubic is below it.
    fn bound(&self, points_m: &[[f64; 3]; 4]) -> f64 {
        let squared = bernstein::squared_norm(&points_m.map(|[x, y, _]| [x, y, 0.0]));
        let horizontal_m = squared.iter().copied().fold(f64::INFINITY, f64::min).max(0.0).sqrt();
        let [low_m, high_m] = points_m.iter().fold([f64::INFINITY, f64::NEG_INFINITY], |[low_m, high_m], point_m| {
            [low_m.min(point_m[2]), high_m.max(point_m[2])]
        });
        let vertical_m = low_m.max(-high_m).max(0.0);
        horizontal_m.max(vertical_m + self.raised_m)
    }
}

#[cfg(test)]
mod tests {
    use super::minimise;
    use crate::verdict::random::Uniform;

    fn value(points_m: &[[f64; 3]; 4], raised_m: f64, u: f64) -> f64 {
        let v = 1.0 - u;
        let weights = [v * v * v, 3.0 * v * v * u, 3.0 * v * u * u, u * u * u];
        let at =
            |axis: usize| points_m.iter().zip(weights).map(|(point_m, weight)| weight * point_m[axis]).sum::<f64>();
        (at(2).abs() + raised_m).max(at(0).hypot(at(1)))
    }

    /// One vehicle crosses another 3 m above it, straight on at 10 m/s, and sinks by 1 m meanwhile.
    #[test]
    fn a_crossing_is_as_close_as_geometry_says() {
        let line = |k: usize| [-15.0 + 10.0 * k as f64, 0.0, 3.5 - k as f64 / 3.0];
        let points_m: [[f64; 3]; 4] = std::array::from_fn(line);
        // Radius 5 m, height 4 m: the vertical distance decides from |x| = |z| + 1 on.
        let found = minimise(&points_m, 1.0, f64::INFINITY, 1e-9);
        // x = -15 + 30 u meets z + 1 = 4.5 - u behind the middle.
        let expected_m = 4.5 - 19.5 / 31.0;
        assert!(found.lower <= expected_m && expected_m <= found.upper + 1e-12, "{found:?} {expected_m}");
        assert!(found.upper - found.lower < 1.1e-9 && (found.at.unwrap() - 19.5 / 31.0).abs() < 1e-8, "{found:?}");
        // What is not below the value to beat is not found.
        assert_eq!(minimise(&points_m, 1.0, 3.0, 1e-9).at, None);
    }

    #[test]
    fn no_sample_of_a_random_cubic_is_below_the_bound() {
        let mut uniform = Uniform::seeded(3);
        for _ in 0..300 {
            let points_m: [[f64; 3]; 4] = std::array::from_fn(|_| [0, 1, 2].map(|_| uniform.between(-9.0, 9.0)));
            let raised_m = uniform.between(-3.0, 3.0);
            let found = minimise(&points_m, raised_m, f64::INFINITY, 1e-9);
            assert!(found.upper - found.lower < 2e-9, "{found:?}");
            let reached_m = value(&points_m, raised_m, found.at.unwrap());
            assert!((reached_m - found.upper).abs() < 1e-9, "{found:?} {reached_m}");
            for k in 0..=3000 {
                let sampled_m = value(&points_m, raised_m, f64::from(k) / 3000.0);
                assert!(sampled_m >= found.lower, "{found:?} {sampled_m}");
            }
        }
    }

    #[test]
    fn what_is_not_finite_is_below_anything() {
        let mut points_m = [[1.0; 3]; 4];
        points_m[1][2] = f64::NAN;
        assert_eq!(minimise(&points_m, 1.0, f64::INFINITY, 1e-9).lower, f64::NEG_INFINITY);
    }
}
