//! Statistics of the samples of a sweep.

use std::collections::BTreeSet;

use serde::Serialize;

use super::{Sample, Sweep};
use crate::statistics::quantile_index;
use crate::verdict::Outcome;

/// Statistics of a sweep.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Statistics {
    /// Number of samples.
    pub samples: usize,
    /// Number of those that passed.
    pub passed: usize,
    /// 95 % confidence interval of the pass rate, as fractions.
    pub pass_share_95: [f64; 2],
    /// One for every check, and every unit of its margins, that was measured or failed at least once.
    pub checks: Vec<CheckStatistics>,
}

/// Statistics of one check. A check of several quantities has one for each unit.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct CheckStatistics {
    /// Full name of the check.
    pub name: String,
    /// Unit of the margins.
    pub unit: String,
    /// Number of samples in which it failed.
    #[serde(rename = "red")]
    pub failures: usize,
    /// Smallest margin, 5 % quantile and median; absent if no sample has a margin.
    pub margins: Option<[f64; 3]>,
    /// Number of the sample with the smallest margin.
    pub worst: Option<usize>,
}

/// Two-sided 95 % quantile of the standard normal distribution.
const Z_95: f64 = 1.959_963_984_540_054;

impl Statistics {
    /// Computes the statistics of all samples of a sweep, or of a partition.
    pub fn of(sweep: &Sweep, samples: &[Sample]) -> Self {
        let passed = samples.iter().filter(|sample| sample.verdict == Outcome::Pass).count();
        let rows = sweep.checks.iter().enumerate().flat_map(|(index, (name, unit))| {
            units(samples, index, unit).into_iter().map(move |unit| (index, name, unit))
        });
        let checks = rows.map(|(index, name, unit)| {
            let in_unit = || samples.iter().filter(|sample| sample.units[index] == unit);
            let mut margins: Vec<(f64, usize)> =
                in_unit().map(|sample| (sample.margins[index], sample.number)).collect();
            margins.retain(|(margin, _)| !margin.is_nan());
            margins.sort_by(|a, b| a.0.total_cmp(&b.0));
            let quantile = |p: f64| quantile_index(margins.len(), p).map_or(f64::NAN, |index| margins[index].0);
            CheckStatistics {
                name: name.clone(),
                unit: unit.to_owned(),
                failures: in_unit().filter(|sample| sample.failed_checks.contains(name)).count(),
                margins: (!margins.is_empty()).then(|| [0.0, 0.05, 0.5].map(quantile)),
                worst: margins.first().map(|(_, number)| *number),
            }
        });
        Self {
            samples: samples.len(),
            passed,
            pass_share_95: wilson(passed, samples.len()),
            checks: checks.filter(|check| check.failures > 0 || check.margins.is_some()).collect(),
        }
    }
}

/// The units in which a check of the samples has margins, in the order of their names; the declared one if there is none.
fn units<'a>(samples: &'a [Sample], check: usize, declared: &'a str) -> BTreeSet<&'a str> {
    let found: BTreeSet<&str> = samples.iter().map(|sample| sample.units[check].as_str()).collect();
    if found.is_empty() { BTreeSet::from([declared]) } else { found }
}

/// The number of the sample with the most failed checks, the first of equals; `None` if all passed.
pub fn worst(samples: &[Sample]) -> Option<usize> {
    let failed = samples.iter().filter(|sample| sample.verdict != Outcome::Pass);
    failed
        .max_by_key(|sample| (sample.failed_checks.len(), std::cmp::Reverse(sample.number)))
        .map(|sample| sample.number)
}

/// 95 % confidence interval of a success rate.                                                         [Wilson, 1927]
fn wilson(successes: usize, trials: usize) -> [f64; 2] {
    if trials == 0 {
        return [0.0, 1.0];
    }
    let n = trials as f64;
    let p = successes as f64 / n;
    let centre = (p + Z_95 * Z_95 / (2.0 * n)) / (1.0 + Z_95 * Z_95 / n);
    let half_width = Z_95 / (1.0 + Z_95 * Z_95 / n) * (p * (1.0 - p) / n + Z_95 * Z_95 / (4.0 * n * n)).sqrt();
    [(centre - half_width).max(0.0), (centre + half_width).min(1.0)]
}

#[cfg(test)]
mod tests {
    use super::wilson;

    /// Tabulated values: 8 of 10 gives 0.4902 to 0.9433, 0 of 10 gives 0 to 0.2775.
    #[test]
    fn the_interval_agrees_with_tabulated_values() {
        let is = |interval: [f64; 2], wanted: [f64; 2]| {
            assert!((interval[0] - wanted[0]).abs() < 1e-4 && (interval[1] - wanted[1]).abs() < 1e-4, "{interval:?}");
        };
        is(wilson(8, 10), [0.4902, 0.9433]);
        is(wilson(0, 10), [0.0, 0.2775]);
        assert_eq!(wilson(0, 0), [0.0, 1.0]);
    }
}
