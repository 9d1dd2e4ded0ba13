//! Means and quantiles, defined once.

/// Mean; `None` without values.
pub fn mean(values: impl Iterator<Item = f64>) -> Option<f64> {
    let (count, sum) = values.fold((0.0, 0.0), |(count, sum), value| (count + 1.0, sum + value));
    (count > 0.0).then(|| sum / count)
}

/// Median of sorted values, the mean of the middle two if their number is even; `None` without values.
pub fn median(sorted: &[f64]) -> Option<f64> {
    let last = sorted.len().checked_sub(1)?;
    Some(f64::midpoint(sorted[last / 2], sorted[sorted.len() / 2]))
}

/// Index of the largest of `count` sorted values that at most the fraction `p` of the others is below.
///
/// Of margins this is the careful choice: no quantile is larger than a value that was measured.
pub fn quantile_index(count: usize, p: f64) -> Option<usize> {
    Some((p * count.checked_sub(1)? as f64).floor() as usize)
}

#[cfg(test)]
mod tests {
    use super::{mean, median, quantile_index};

    #[test]
    fn of_few_values() {
        assert_eq!(mean([1.0, 2.0, 6.0].into_iter()), Some(3.0));
        assert_eq!(mean(std::iter::empty()), None);
        assert_eq!(median(&[1.0, 2.0, 6.0]), Some(2.0));
        assert_eq!(median(&[1.0, 2.0, 4.0, 6.0]), Some(3.0));
        assert_eq!(median(&[]), None);
        assert_eq!([0.0, 0.05, 0.5, 1.0].map(|p| quantile_index(40, p)), [Some(0), Some(1), Some(19), Some(39)]);
        assert_eq!(quantile_index(0, 0.5), None);
    }
}
