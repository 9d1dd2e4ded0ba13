//! A quantity over time, and its decimation for plots.

/// A quantity over time: finite times, s, and as many finite values.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Curve {
    /// Times, s.
    pub times_s: Vec<f64>,
    /// Values.
    pub values: Vec<f64>,
}

impl Curve {
    /// Appends a point, unless its time or value is NaN or infinite: that leaves a gap.
    pub fn push(&mut self, t_s: f64, value: f64) {
        if t_s.is_finite() && value.is_finite() {
            self.times_s.push(t_s);
            self.values.push(value);
        }
    }

    /// Smallest value, or `None` without points.
    pub fn min(&self) -> Option<f64> {
        self.values.iter().copied().reduce(f64::min)
    }

    /// Largest value, or `None` without points.
    pub fn max(&self) -> Option<f64> {
        self.values.iter().copied().reduce(f64::max)
    }

    /// Value of the last point at or before `t_s`.
    pub fn held_at(&self, t_s: f64) -> Option<f64> {
        let after = self.times_s.partition_point(|time_s| *time_s <= t_s);
        after.checked_sub(1).map(|last| self.values[last])
    }

    /// Min-max decimation to at most `points` points (at least 4): the smallest and the largest value of each of equally
    /// long runs of neighbours, and the two end points. Extremes are never lost.
    pub fn decimated(self, points: usize) -> Self {
        let n = self.values.len();
        if n <= points {
            return self;
        }
        let run = n.div_ceil((points.max(4) - 2) / 2);
        let mut kept = vec![0];
        for start in (0..n).step_by(run) {
            let indices = start..(start + run).min(n);
            let low = indices.clone().min_by(|&a, &b| self.values[a].total_cmp(&self.values[b]));
            let high = indices.max_by(|&a, &b| self.values[a].total_cmp(&self.values[b]));
            kept.extend(low.into_iter().chain(high));
        }
        kept.push(n - 1);
        kept.sort_unstable();
        kept.dedup();
        Self {
            times_s: kept.iter().map(|&i| self.times_s[i]).collect(),
            values: kept.iter().map(|&i| self.values[i]).collect(),
        }
    }
}

impl FromIterator<(f64, f64)> for Curve {
    fn from_iter<T: IntoIterator<Item = (f64, f64)>>(points: T) -> Self {
        let mut curve = Self::default();
        points.into_iter().for_each(|(t_s, value)| curve.push(t_s, value));
        curve
    }
}

#[cfg(test)]
mod tests {
    use super::Curve;

    #[test]
    fn a_spike_of_one_point_survives() {
        let value = |i: usize| if i == 7_777 { -3.0 } else { (i as f64 * 1e-3).sin() };
        let curve: Curve = (0..20_000).map(|i| (i as f64 * 0.01, value(i))).collect();
        let decimated = curve.clone().decimated(200);
        assert!(decimated.values.len() <= 200, "{} points", decimated.values.len());
        assert_eq!((decimated.min(), decimated.max()), (curve.min(), curve.max()));
        assert_eq!(decimated.times_s[decimated.values.iter().position(|&v| v == -3.0).unwrap()], 77.77);
        assert!(decimated.times_s.windows(2).all(|pair| pair[0] < pair[1]));
        assert_eq!((decimated.times_s[0], *decimated.times_s.last().unwrap()), (0.0, 199.99));
    }

    #[test]
    fn values_that_are_not_finite_leave_gaps() {
        let curve: Curve =
            [(0.0, 1.0), (1.0, f64::NAN), (f64::NAN, 2.0), (3.0, f64::INFINITY), (4.0, 5.0)].into_iter().collect();
        assert_eq!(curve, Curve { times_s: vec![0.0, 4.0], values: vec![1.0, 5.0] });
        assert_eq!(Curve::default().decimated(10), Curve::default());
    }
}
