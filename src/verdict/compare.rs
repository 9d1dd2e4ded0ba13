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

/// Is `value` a new smallest after `so_far`? NaN is smaller than anything, and stays.
pub fn is_smaller(value: f64, so_far: f64) -> bool {
    is_larger(-value, -so_far)
}

#[cfg(test)]
mod tests {
    use super::{exceeds, is_larger, is_smaller};

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
