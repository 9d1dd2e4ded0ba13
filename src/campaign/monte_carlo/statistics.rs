//! Statistics of the samples of a sweep.

use std::collections::BTreeSet;

use serde::Serialize;

use super::{Sample, Sweep};
use crate::verdict::Outcome;

/// Of a sweep.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Statistics {
    /// Number of samples.
    pub samples: usize,
    /// Number of those that passed.
    pub passed: usize,
    /// Within these lies the share that would pass of endlessly many, with 95 % confidence, -.
    pub pass_share_95: [f64; 2],
    /// One for every check that was measured, or failed, at least once.
    pub checks: Vec<CheckStatistics>,
}

/// Of one check.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct CheckStatistics {
    /// Its name.
    pub name: String,
    /// Unit of the margins.
    pub unit: String,
    /// How often it decided against a flight.
    #[serde(rename = "red")]
    pub failures: usize,
    /// Smallest margin, 5 % quantile, and median of the samples that have one; absent if none has.
    pub margins: Option<[f64; 3]>,
    /// Number of the sample with the smallest margin.
    pub worst: Option<usize>,
}

/// Quantile of the normal distribution for 95 % on both sides.
const Z: f64 = 1.959_963_984_540_054;

impl Statistics {
    /// Over samples of one sweep.
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
            let quantile = |share: f64| margins[(share * (margins.len() - 1) as f64).floor() as usize].0;
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

/// The sample that failed by most: of those that failed the one with most checks against it, the first of equals; `None` if
/// all passed.
pub fn worst(samples: &[Sample]) -> Option<usize> {
    let failed = samples.iter().filter(|sample| sample.verdict != Outcome::Pass);
    failed
        .max_by_key(|sample| (sample.failed_checks.len(), std::cmp::Reverse(sample.number)))
        .map(|sample| sample.number)
}

/// Interval of a share of successes with 95 % confidence.                                              [Wilson, 1927]
fn wilson(successes: usize, trials: usize) -> [f64; 2] {
    if trials == 0 {
        return [0.0, 1.0];
    }
    let n = trials as f64;
    let p = successes as f64 / n;
    let middle = (p + Z * Z / (2.0 * n)) / (1.0 + Z * Z / n);
    let half = Z / (1.0 + Z * Z / n) * (p * (1.0 - p) / n + Z * Z / (4.0 * n * n)).sqrt();
    [(middle - half).max(0.0), (middle + half).min(1.0)]
}

#[cfg(test)]
mod tests {
    use super::wilson;

    /// 8 of 10: 0.4902 to 0.9433; 0 of 10: 0 to 0.2775, as tables have it.
    #[test]
    fn the_interval_is_wilson_s() {
        let is = |interval: [f64; 2], wanted: [f64; 2]| {
            assert!((interval[0] - wanted[0]).abs() < 1e-4 && (interval[1] - wanted[1]).abs() < 1e-4, "{interval:?}");
        };
        is(wilson(8, 10), [0.4902, 0.9433]);
        is(wilson(0, 10), [0.0, 0.2775]);
        assert_eq!(wilson(0, 0), [0.0, 1.0]);
    }
}
