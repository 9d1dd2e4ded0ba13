//! A sign test of the median of differences that may be looked at after every pair.
//!
//! The null hypothesis "the median is at most m" says that a difference is above m with probability 1/2 at most. A gambler who
//! stakes a fraction of the capital on every difference being above m, at even odds, cannot expect to gain under it. The
//! capital, averaged over the fractions 2θ - 1 with θ uniform in (1/2, 1], is after k of n differences above m
//!
//! ```text
//! E(k, n) = 2 ∫ (2θ)^k (2 - 2θ)^(n-k) dθ over (1/2, 1] = 2^(n+1) B(k+1, n-k+1) (1 - I½(k+1, n-k+1))
//! ```
//!
//! and by Ville's inequality it ever reaches 1/α with probability α at most, however often one looks. Differences need neither
//! bounds nor moments, and infinite ones (a flight without a margin is worse than any other) count like the rest. Those equal
//! to m count as not above and as not below, which makes the test careful. The interval holds every m that neither side
//! rejects at α/2.
//!
//! Robbins, "Statistical methods related to the law of the iterated logarithm" (1970); Howard, Ramdas, "Sequential estimation of
//! quantiles with applications to A/B testing and best-arm identification" (2022); Ramdas, Grünwald, Vovk, Shafer,
//! "Game-theoretic statistics and safe anytime-valid inference" (2023).

use statrs::function::beta::{beta_reg, ln_beta};

/// Differences so far.
#[derive(Clone, Debug)]
pub struct SignTest {
    alpha: f64,
    /// In ascending order.
    sorted: Vec<f64>,
    /// Smallest number of differences on one side that rejects at this number of pairs; larger than it if none does.
    needed: usize,
}

impl SignTest {
    /// A test of two sides.
    ///
    /// - `alpha`: probability of an error, however long the test goes on; in (0, 1)
    pub fn new(alpha: f64) -> Self {
        Self { alpha, sorted: Vec::new(), needed: 1 }
    }

    /// Takes another difference. NaN is not a difference.
    ///
    /// # Panics
    ///
    /// If it is NaN (a bug in the caller).
    pub fn add(&mut self, difference: f64) {
        assert!(!difference.is_nan(), "a difference is a number");
        let place = self.sorted.partition_point(|known| *known < difference);
        self.sorted.insert(place, difference);
        // One more pair never needs fewer on one side, and never more than one more.
        let pairs = self.sorted.len();
        while self.needed <= pairs && log_capital(self.needed, pairs) < (2.0 / self.alpha).ln() {
            self.needed += 1;
        }
    }

    /// Number of differences.
    pub fn pairs(&self) -> usize {
        self.sorted.len()
    }

    /// Median of the differences; `None` without any.
    pub fn median(&self) -> Option<f64> {
        crate::statistics::median(&self.sorted).map(|median| if median.is_nan() { 0.0 } else { median })
    }

    /// Confidence interval of the median, valid at all times together; the whole line while there are few differences.
    pub fn interval(&self) -> [f64; 2] {
        let pairs = self.sorted.len();
        if self.needed > pairs {
            return [f64::NEG_INFINITY, f64::INFINITY];
        }
        // So many differences are at or above the lower end, or at or below the upper end.
        [self.sorted[pairs - self.needed], self.sorted[self.needed - 1]]
    }
}

/// ln E(k, n).
fn log_capital(above: usize, pairs: usize) -> f64 {
    let (a, b) = (above as f64 + 1.0, (pairs - above) as f64 + 1.0);
    // 1 - I½(a, b) = I½(b, a)
    (pairs as f64 + 1.0) * std::f64::consts::LN_2 + ln_beta(a, b) + beta_reg(b, a, 0.5).ln()
}

#[cfg(test)]
mod tests {
    use rand_distr::{Cauchy, Distribution};

    use super::{SignTest, log_capital};

    /// E(n, n) = 2^(n+1) (1 - 2^-(n+1)) / (n + 1); E(1, 2) = 8 ∫ (θ - θ²) dθ over (1/2, 1] = 2/3.
    #[test]
    fn the_capital_agrees_with_closed_forms() {
        for n in [1_usize, 5, 40] {
            let wanted = (2.0_f64.powi(n as i32 + 1) - 1.0) / (n as f64 + 1.0);
            assert!((log_capital(n, n) - wanted.ln()).abs() < 1e-9, "{n}");
        }
        assert!((log_capital(1, 2) - (2.0_f64 / 3.0).ln()).abs() < 1e-9);
        // A fair game: the expectation over fair coins is 1.
        let binomial = |n: u64, k: u64| (1..=k).fold(1.0, |c, i| c * (n - k + i) as f64 / i as f64);
        let mean: f64 = (0..=20).map(|k| binomial(20, k) * log_capital(k as usize, 20).exp() / 2.0_f64.powi(20)).sum();
        assert!((mean - 1.0).abs() < 1e-9, "{mean}");
    }

    /// Whether the interval ever leaves out `median` during `pairs` differences of heavy tails, and when it first leaves out 0.
    fn watched(seed: u64, median: f64, pairs: usize) -> (bool, Option<usize>) {
        let cauchy = Cauchy::new(median, 1.0).unwrap();
        let (mut test, mut random) = (SignTest::new(0.05), scenarios::stream(seed, "sign test"));
        let (mut has_erred, mut decided) = (false, None);
        for pair in 1..=pairs {
            test.add(cauchy.sample(&mut random));
            let [low, high] = test.interval();
            has_erred |= median < low || median > high;
            if decided.is_none() && (low > 0.0 || high < 0.0) {
                decided = Some(pair);
            }
        }
        (has_erred, decided)
    }

    /// 1,000 comparisons of a system with itself, each watched over 500 pairs: at most 5 % false alarms, plus binomial slack
    /// (71 or more of 1,000 have a probability below 0.2 % at 5 %).
    #[test]
    fn comparisons_of_equals_raise_few_false_alarms_however_often_one_looks() {
        let alarms = (0..1000).filter(|seed| watched(*seed, 0.0, 500).1.is_some()).count();
        assert!(alarms <= 70, "{alarms} of 1000");
    }

    #[test]
    fn the_interval_contains_the_median_at_all_times() {
        let errors = (0..300).filter(|seed| watched(*seed, 0.7, 300).0).count();
        assert!(errors <= 26, "{errors} of 300");
    }

    #[test]
    fn a_difference_is_found_although_it_has_no_mean() {
        let decided: Vec<usize> = (0..100).filter_map(|seed| watched(seed, 1.0, 500).1).collect();
        assert!(decided.len() == 100 && decided.iter().sum::<usize>() < 6000, "{decided:?}");
    }

    #[test]
    fn equal_and_infinite_differences_are_counted() {
        let interval = |differences: &[f64]| {
            let mut test = SignTest::new(0.05);
            differences.iter().for_each(|difference| test.add(*difference));
            (test.interval(), test.median())
        };
        assert_eq!(interval(&[0.0; 50]), ([0.0, 0.0], Some(0.0)));
        assert_eq!(interval(&[0.5; 7]).0, [f64::NEG_INFINITY, f64::INFINITY]);
        assert_eq!(interval(&[0.5; 8]).0, [0.5, 0.5]);
        assert_eq!(interval(&[f64::INFINITY; 8]).0[0], f64::INFINITY);
        assert_eq!(interval(&[f64::NEG_INFINITY, f64::INFINITY]).1, Some(0.0));
    }

    /// The number that rejects is found step by step; here it is searched for.
    #[test]
    fn the_needed_number_is_the_smallest_that_rejects() {
        let mut test = SignTest::new(0.05);
        for pairs in 1..=200 {
            test.add(0.0);
            let smallest = (0..=pairs).find(|k| log_capital(*k, pairs) >= 40.0_f64.ln()).unwrap_or(pairs + 1);
            assert_eq!(test.needed, smallest, "{pairs}");
        }
    }
}
