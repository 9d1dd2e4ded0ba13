//! Confidence intervals of probabilities.

use serde::Serialize;
use statrs::distribution::{Beta, ChiSquared, ContinuousCDF, StudentsT};

use super::splitting::Run;

/// An estimate of a probability and its two-sided confidence interval.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Interval {
    /// The estimate; 0 if no failure was met.
    pub estimate: f64,
    /// Lower end.
    pub lower: f64,
    /// Upper end.
    pub upper: f64,
}

/// Of independent runs of splitting.
///
/// The interval of -ln p is the hull of two. The first is that of the mean of the runs' Λ by Student's t, which needs nothing
/// but that the runs are independent, equally distributed and nearly normal, as sums of many removals are; it widens if moves
/// that are too short make the runs scatter. The second is that of the number of removals, a Poisson variable if the moves are
/// perfect [Garwood 1936]; it keeps the interval wide where few runs happen to agree.
///
/// Runs that ended before they met failures bound p from above only: the lower end is 0.
///
/// - `confidence`: in (0, 1)
pub fn of_runs(runs: &[Run], particles: usize, confidence: f64) -> Interval {
    let count = runs.len() as f64;
    let mean = runs.iter().map(|run| run.hazard).sum::<f64>() / count;
    let removed: usize = runs.iter().map(|run| run.removed).sum();
    let [fewest, most] = poisson(removed, confidence);
    // 1/n per removal; more if particles of equal score went at once.
    let per_removal = if removed > 0 { count * mean / removed as f64 } else { 1.0 / particles as f64 };
    let half_width = half_width_by_t(runs, mean, confidence);
    let smallest = (per_removal * fewest / count).min(mean - half_width).max(0.0);
    let largest = (per_removal * most / count).max(mean + half_width);
    let is_complete = runs.iter().all(Run::is_complete);
    let lower = if is_complete { (-largest).exp() } else { 0.0 };
    let has_failed = runs.iter().any(|run| run.likeliest.is_some());
    let estimate = if has_failed { (-mean).exp() } else { 0.0 };
    Interval { estimate, lower, upper: (-smallest).exp() }
}

/// Of the share of failures among independent draws [Clopper, Pearson 1934].
///
/// - `confidence`: in (0, 1)
pub fn of_counts(failures: usize, draws: usize, confidence: f64) -> Interval {
    let tail = 0.5 * (1.0 - confidence);
    let (k, n) = (failures as f64, draws as f64);
    let quantile = |a: f64, b: f64, p: f64| Beta::new(a, b).map_or(f64::NAN, |beta| beta.inverse_cdf(p));
    Interval {
        estimate: if draws == 0 { 0.0 } else { k / n },
        lower: if failures == 0 { 0.0 } else { quantile(k, n - k + 1.0, tail) },
        upper: if failures == draws { 1.0 } else { quantile(k + 1.0, n - k, 1.0 - tail) },
    }
}

/// How much more the runs scatter than with perfect moves: the variance of their Λ as a multiple of Λ/n. `None` of fewer than
/// two runs, or without removals.
pub fn scatter(runs: &[Run], particles: usize) -> Option<f64> {
    let mean = runs.iter().map(|run| run.hazard).sum::<f64>() / runs.len() as f64;
    (runs.len() > 1 && mean > 0.0).then(|| variance(runs, mean) * particles as f64 / mean)
}

fn variance(runs: &[Run], mean: f64) -> f64 {
    runs.iter().map(|run| (run.hazard - mean).powi(2)).sum::<f64>() / (runs.len() as f64 - 1.0)
}

fn half_width_by_t(runs: &[Run], mean: f64, confidence: f64) -> f64 {
    if runs.len() < 2 {
        return f64::INFINITY;
    }
    let count = runs.len() as f64;
    let quantile =
        StudentsT::new(0.0, 1.0, count - 1.0).map_or(f64::INFINITY, |t| t.inverse_cdf(0.5 * (1.0 + confidence)));
    quantile * (variance(runs, mean) / count).sqrt()
}

/// Exact interval of the mean of a Poisson variable that was observed once.
fn poisson(observed: usize, confidence: f64) -> [f64; 2] {
    let tail = 0.5 * (1.0 - confidence);
    let quantile = |freedom: f64, p: f64| ChiSquared::new(freedom).map_or(f64::INFINITY, |it| 0.5 * it.inverse_cdf(p));
    let fewest = if observed == 0 { 0.0 } else { quantile(2.0 * observed as f64, tail) };
    [fewest, quantile(2.0 * observed as f64 + 2.0, 1.0 - tail)]
}

#[cfg(test)]
mod tests {
    use super::{of_counts, of_runs, poisson};
    use crate::campaign::probability::splitting::{Run, RunEnd};

    fn run(hazard: f64, removed: usize, end: RunEnd) -> Run {
        let likeliest = None;
        Run { hazard, removed, flights: 1, end, likeliest }
    }

    /// Tabulated values: 5 of 100 gives 1.643 % to 11.284 %; 0 of 30 at most 11.570 %; Poisson 4: 1.0899 to 10.2416.
    #[test]
    fn intervals_agree_with_tabulated_values() {
        let is = |found: f64, wanted: f64| assert!((found / wanted - 1.0).abs() < 1e-3, "{found} instead of {wanted}");
        let some = of_counts(5, 100, 0.95);
        is(some.lower, 0.016_431_9);
        is(some.upper, 0.112_835);
        is(of_counts(0, 30, 0.95).upper, 0.115_703);
        assert_eq!((of_counts(0, 30, 0.95).lower, of_counts(30, 30, 0.95).upper), (0.0, 1.0));
        is(poisson(4, 0.95)[0], 1.089_865);
        is(poisson(4, 0.95)[1], 10.241_59);
        is(poisson(0, 0.95)[1], 3.688_879);
        is(poisson(2000, 0.95)[1], 2089.6);
    }

    #[test]
    fn runs_that_agree_have_the_interval_of_the_law_and_runs_that_scatter_a_wider_one() {
        let agree = of_runs(&[10.0, 10.0, 10.0].map(|hazard| run(hazard, 100, RunEnd::Failed)), 10, 0.95);
        let scatter = of_runs(&[8.0, 10.0, 12.0].map(|hazard| run(hazard, 100, RunEnd::Failed)), 10, 0.95);
        assert!(agree.lower < agree.upper && agree.upper < (-8.0_f64).exp(), "{agree:?}");
        // t(2) = 4.303, deviation 2: ± 4.97
        assert!((scatter.upper.ln() + 10.0 - 4.969).abs() < 1e-3, "{scatter:?}");
        assert!(scatter.lower < agree.lower);
    }

    #[test]
    fn where_everything_fails_the_interval_is_not_a_point() {
        let all = of_runs(&[0.0, 0.0].map(|hazard| run(hazard, 0, RunEnd::Failed)), 10, 0.95);
        assert!(all.upper == 1.0 && (0.8..0.9).contains(&all.lower), "{all:?}");
    }

    #[test]
    fn runs_that_met_no_failure_bound_from_above_only() {
        let cut = of_runs(&[14.0, 14.0].map(|hazard| run(hazard, 140, RunEnd::Rarer)), 10, 0.95);
        assert!(cut.lower == 0.0 && cut.estimate == 0.0 && cut.upper < 1e-5, "{cut:?}");
    }
}
