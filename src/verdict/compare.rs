//! Comparisons that NaN never slips through.

use std::cmp::Ordering;

/// Is `value` above `limit`, or can it not be told because one of them is NaN?
pub fn exceeds(value: f64, limit: f64) -> bool {
    !matches!(value.partial_cmp(&limit), Some(Ordering::Less | Ordering::Equal))
}

/// Is `value` a new largest after `so_far`? NaN is larger than anything, and stays.
pub fn is_larger(value: f64, so_far: f64) -> bool {
    exceeds(value, so_far) && !so_far.is_nan()
}

/// The larger of two numbers. NaN counts as larger than any.
pub fn larger(a: f64, b: f64) -> f64 {
    if is_larger(b, a) { b } else { a }
}

/// Is `value` a new smallest after `so_far`? NaN is smaller than anything, and stays.
pub fn is_smaller(value: f64, so_far: f64) -> bool {
    is_larger(-value, -so_far)
}

/// Is a value within these bounds worse than another one, where `limit` is the most that is allowed? What certainly exceeds
/// it is worse than what may. NaN is the worst.
///
/// - `bounds`, `so_far`: lower and upper bound
pub fn is_worse(bounds: [f64; 2], so_far: [f64; 2], limit: f64) -> bool {
    match [bounds, so_far].map(|[lower, _]| exceeds(lower, limit)) {
        [true, true] => is_larger(bounds[0], so_far[0]),
        [false, false] => is_larger(bounds[1], so_far[1]),
        [certainly_exceeds, _] => certainly_exceeds,
    }
}

#[cfg(test)]
mod tests {
    use super::{exceeds, is_larger, is_smaller, is_worse};

    #[test]
    fn what_certainly_exceeds_is_worse_than_what_may() {
        assert!(is_worse([2.0, 2.0], [0.0, 9.0], 1.0) && !is_worse([0.0, 9.0], [2.0, 2.0], 1.0));
        assert!(is_worse([0.0, 9.0], [0.5, 0.5], 1.0) && is_worse([3.0, 3.0], [2.0, 9.0], 1.0));
        assert!(is_worse([f64::NAN, f64::NAN], [3.0, 3.0], 1.0) && !is_worse([3.0, 3.0], [f64::NAN, f64::NAN], 1.0));
    }

    #[test]
    fn nan_exceeds_and_is_exceeded() {
        assert!(exceeds(2.0, 1.0) && exceeds(f64::INFINITY, 1.0));
        assert!(!exceeds(1.0, 1.0) && !exceeds(f64::NEG_INFINITY, 1.0));
        assert!(exceeds(f64::NAN, 1.0) && exceeds(1.0, f64::NAN) && exceeds(f64::NAN, f64::NAN));
    }

    #[test]
    fn nan_is_the_worst_wherever_it_stands_in_a_series() {
        for series in [[f64::NAN, 1.0, 2.0], [1.0, f64::NAN, 2.0], [1.0, 2.0, f64::NAN]] {
            for is_worse in [is_larger, is_smaller] {
                let worst =
                    series.into_iter().reduce(|worst, value| if is_worse(value, worst) { value } else { worst });
                assert!(worst.is_some_and(f64::is_nan));
            }
        }
        assert!(is_larger(2.0, 1.0) && !is_larger(1.0, 1.0) && is_smaller(1.0, 2.0) && !is_smaller(1.0, 1.0));
    }
}
