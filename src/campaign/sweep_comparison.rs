//! What got worse from one sweep to another: their samples are pairs, since sample k of both flies in the same world.
//!
//! Every check has a sign test of the differences of its margins ([`sign_test`](crate::campaign::ab_test::sign_test)), and the
//! verdicts one of the samples in which they differ. The tests share the probability of an error equally (Bonferroni), so that
//! two sweeps of one system seldom differ in anything.

use std::collections::BTreeMap;
use std::path::Path;

use serde::Serialize;

use crate::campaign::ab_test::Outcome;
use crate::campaign::ab_test::sign_test::SignTest;
use crate::campaign::monte_carlo::{Sample, Sweep, table};
use crate::error::Error;
use crate::number_format::signed;
use crate::output::report::table as text_table;
use crate::verdict;

/// Probability that two sweeps of one system differ in anything.
pub const ALPHA: f64 = 0.05;
/// Version of the result format.
const SCHEMA: u32 = 1;
/// Name of the comparison of verdicts.
const VERDICT: &str = "verdict";

/// Two sweeps, check by check.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SweepComparison {
    /// Version of this format: 1.
    pub schema: u32,
    /// Number of pairs: samples that both sweeps have.
    pub pairs: usize,
    /// Samples that passed, of the pairs: old and new.
    pub passed: [usize; 2],
    /// Probability of any error.
    pub alpha: f64,
    /// The verdict and every check.
    pub subjects: Vec<Subject>,
}

/// The verdict or a check.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Subject {
    /// `verdict`, or the name of the check.
    pub name: String,
    /// Unit of its margin.
    pub unit: String,
    /// Whether the new one is worse, better, equivalent (to the bit) or not decided.
    pub outcome: Outcome,
    /// Median of the new margin minus the old one; of verdicts, of those that differ: 1 if the new one passes.
    pub median: Option<f64>,
    /// Confidence interval of the median; an absent end is infinite.
    pub interval: [Option<f64>; 2],
    /// Number of differences: of pairs with margins in one unit, or of verdicts that differ.
    pub differences: usize,
}

impl SweepComparison {
    /// Whether anything got worse.
    pub fn has_losses(&self) -> bool {
        self.subjects.iter().any(|subject| subject.outcome == Outcome::Worse)
    }
}

/// Compares two tables of samples.
///
/// # Errors
///
/// [`Error::Samples`] if one of them cannot be read, or their samples are no pairs: other scenarios, seeds or dispersions.
pub fn compare(old: &Path, new: &Path) -> Result<SweepComparison, Error> {
    let (old_sweep, old_samples) = table::read(old)?;
    let (new_sweep, new_samples) = table::read(new)?;
    let error = |reason: &str| Error::Samples { path: new.to_owned(), reason: reason.to_owned() };
    let differs = [
        ("its scenario differs", old_sweep.scenario != new_sweep.scenario),
        ("its seed differs", old_sweep.seed != new_sweep.seed),
        ("its dispersions differ", old_sweep.dispersions != new_sweep.dispersions),
    ];
    if let Some((what, _)) = differs.iter().find(|(_, differs)| *differs) {
        return Err(error(&format!("{what} from {}, so that the samples are no pairs", old.display())));
    }
    let pairs = pairs(&old_samples, &new_samples);
    if pairs.is_empty() {
        return Err(error(&format!("it has no sample of the same number as one in {}", old.display())));
    }
    Ok(of_pairs(&old_sweep, &new_sweep, &pairs))
}

fn pairs<'a>(old: &'a [Sample], new: &'a [Sample]) -> Vec<[&'a Sample; 2]> {
    let of_number: BTreeMap<usize, &Sample> = new.iter().map(|sample| (sample.number, sample)).collect();
    old.iter().filter_map(|sample| Some([sample, *of_number.get(&sample.number)?])).collect()
}

fn of_pairs(old: &Sweep, new: &Sweep, pairs: &[[&Sample; 2]]) -> SweepComparison {
    let place = |sweep: &Sweep, name: &str| sweep.checks.iter().position(|(known, _)| known == name);
    let shared: Vec<(&str, [usize; 2])> = old
        .checks
        .iter()
        .filter_map(|(name, _)| Some((name.as_str(), [place(old, name)?, place(new, name)?])))
        .collect();
    let alpha = ALPHA / (shared.len() + 1) as f64;
    let has_passed = |sample: &Sample| sample.verdict == verdict::Outcome::Pass;
    let differing = pairs.iter().map(|[a, b]| f64::from(has_passed(b)) - f64::from(has_passed(a)));
    let verdict = subject(VERDICT, "-", alpha, differing.filter(|difference| *difference != 0.0));
    let checks = shared.iter().filter_map(|(name, at)| {
        let unit = units_in_common(pairs, *at)?;
        Some(subject(name, unit, alpha, pairs.iter().filter_map(|pair| difference(*pair, *at, unit))))
    });
    SweepComparison {
        schema: SCHEMA,
        pairs: pairs.len(),
        passed: [0, 1].map(|side| pairs.iter().filter(|pair| has_passed(pair[side])).count()),
        alpha: ALPHA,
        subjects: [verdict].into_iter().chain(checks).collect(),
    }
}

/// The unit of a check in most samples; `None` without a margin.
fn units_in_common<'a>(pairs: &[[&'a Sample; 2]], at: [usize; 2]) -> Option<&'a str> {
    let mut counts = BTreeMap::<&str, usize>::new();
    for pair in pairs {
        for (sample, index) in pair.iter().zip(at) {
            if !sample.margins[index].is_nan() {
                *counts.entry(&sample.units[index]).or_default() += 1;
            }
        }
    }
    counts.into_iter().max_by_key(|(_, count)| *count).map(|(unit, _)| unit)
}

/// The new margin minus the old one. No margin is worse than any, where the other has one; `None` if neither has, or if another
/// quantity decides.
fn difference(pair: [&Sample; 2], at: [usize; 2], unit: &str) -> Option<f64> {
    let of = |side: usize| Some(pair[side].margins[at[side]]).filter(|margin| !margin.is_nan());
    let is_other = |side: usize| of(side).is_some() && pair[side].units[at[side]] != unit;
    match [of(0), of(1)] {
        _ if is_other(0) || is_other(1) => None,
        [None, None] => None,
        [Some(_), None] => Some(f64::NEG_INFINITY),
        [None, Some(_)] => Some(f64::INFINITY),
        [Some(old), Some(new)] => Some(new - old),
    }
}

fn subject(name: &str, unit: &str, alpha: f64, differences: impl Iterator<Item = f64>) -> Subject {
    let mut test = SignTest::new(alpha);
    differences.for_each(|difference| test.add(difference));
    let [low, high] = test.interval();
    let outcome = match (low, high) {
        _ if high < 0.0 => Outcome::Worse,
        _ if low > 0.0 => Outcome::Better,
        (0.0, 0.0) => Outcome::Equivalent,
        _ => Outcome::Undecided,
    };
    let finite = |value: f64| value.is_finite().then_some(value);
    Subject {
        name: name.to_owned(),
        unit: unit.to_owned(),
        outcome,
        median: test.median().and_then(finite),
        interval: [low, high].map(finite),
        differences: test.pairs(),
    }
}

/// The comparison on the terminal: what differs, worse first, and the counts.
pub fn text(comparison: &SweepComparison) -> String {
    let mut table = text_table::with_header(&["", "what", "median change", "interval", "unit"], &[2]);
    let of = |wanted: Outcome| comparison.subjects.iter().filter(move |subject| subject.outcome == wanted);
    for subject in of(Outcome::Worse).chain(of(Outcome::Better)) {
        let in_words = if subject.outcome == Outcome::Worse { "worse" } else { "better" };
        let number =
            |value: Option<f64>, infinite: &str| value.map_or(infinite.to_owned(), |it| signed(it, &subject.unit));
        let [low, high] = subject.interval;
        let interval = format!("[{}, {}]", number(low, "-inf"), number(high, "+inf"));
        let median = number(subject.median, "unbounded");
        table.add_row([in_words.to_owned(), subject.name.clone(), median, interval, subject.unit.clone()]);
    }
    let [old, new] = comparison.passed;
    let (pairs, worse, better) = (comparison.pairs, of(Outcome::Worse).count(), of(Outcome::Better).count());
    let equal = of(Outcome::Equivalent).count();
    let rows = if worse + better > 0 { table.trim_fmt() + "\n" } else { String::new() };
    format!(
        "{rows}{pairs} pairs compared: {worse} worse, {better} better, {equal} equal, the others undecided \
         (alpha {}); passed {old} before, {new} now",
        comparison.alpha
    )
}

#[cfg(test)]
mod tests {
    use rand_distr::{Distribution, Normal};

    use super::{Outcome, SweepComparison, of_pairs, pairs};
    use crate::campaign::monte_carlo::{Dispersions, Perturbation, Sample, Sweep};
    use crate::verdict;

    fn sweep() -> Sweep {
        Sweep {
            schema: 1,
            version: "0".to_owned(),
            scenario: "pair".to_owned(),
            planner: "by-hand".to_owned(),
            seed: 0,
            samples: 200,
            fingerprint: String::new(),
            dispersions: Dispersions { wind_mps: 1.0, mass: 0.0, noise_m: 0.0, start_m: 0.0 },
            checks: ["flight.separation", "flight.clearance"].map(|name| (name.to_owned(), "m".to_owned())).into(),
        }
    }

    /// A common disturbance of 1 m, own noise of 0.1 m, and a shift of the clearance; negative margins fail.
    fn samples(seed: u64, side: &str, shift_m: f64) -> Vec<Sample> {
        let normal = Normal::new(0.0, 1.0).unwrap();
        let sample = |number: usize| {
            let draw = |name: String| normal.sample(&mut scenarios::stream(seed, &name));
            let common = 2.0 + draw(format!("common/{number}"));
            let margins: Vec<f64> = [0.0, shift_m]
                .iter()
                .enumerate()
                .map(|(check, shift)| common + shift + 0.1 * draw(format!("{side}/{check}/{number}")))
                .collect();
            let has_failed = margins.iter().any(|margin| *margin < 0.0);
            Sample {
                number,
                perturbation: Perturbation {
                    seed: number as u64,
                    wind_mps: [0.0; 2],
                    mass_ratios: [1.0; 2],
                    noise_m: 0.0,
                    start_m: 0.0,
                },
                verdict: if has_failed { verdict::Outcome::Fail } else { verdict::Outcome::Pass },
                failed_checks: Vec::new(),
                margins,
                units: vec!["m".to_owned(); 2],
            }
        };
        (0..200).map(sample).collect()
    }

    fn compared(seed: u64, shift_m: f64) -> SweepComparison {
        let (old, new) = (samples(seed, "old", 0.0), samples(seed, "new", shift_m));
        of_pairs(&sweep(), &sweep(), &pairs(&old, &new))
    }

    /// 400 pairs of sweeps of one system: at most 5 % differ in anything, plus binomial slack.
    #[test]
    fn sweeps_of_one_system_seldom_differ() {
        let alarms = (0..400)
            .filter(|seed| compared(*seed, 0.0).subjects.iter().any(|it| it.outcome != Outcome::Undecided))
            .count();
        assert!(alarms <= 33, "{alarms} of 400");
    }

    #[test]
    fn a_shift_is_found_in_the_check_that_has_it() {
        let outcomes = |shift_m: f64| -> Vec<Outcome> {
            compared(1, shift_m).subjects.iter().map(|subject| subject.outcome).collect()
        };
        assert_eq!(outcomes(-0.1)[1..], [Outcome::Undecided, Outcome::Worse]);
        assert_eq!(outcomes(0.1)[1..], [Outcome::Undecided, Outcome::Better]);
        assert_eq!(outcomes(-2.0)[0], Outcome::Worse, "half of the new samples fail");
        let found = compared(1, -0.1);
        let [low, high] = found.subjects[2].interval.map(Option::unwrap);
        assert!(low < -0.1 && -0.1 < high && found.has_losses(), "{low} to {high}");
    }

    #[test]
    fn a_sweep_is_equivalent_to_itself_and_lost_margins_are_worse() {
        let old = samples(1, "old", 0.0);
        let itself = of_pairs(&sweep(), &sweep(), &pairs(&old, &old));
        assert_eq!(itself.subjects[1].outcome, Outcome::Equivalent);
        assert_eq!((itself.subjects[0].outcome, itself.subjects[0].differences), (Outcome::Undecided, 0));
        let mut new = old.clone();
        new.iter_mut().for_each(|sample| sample.margins[0] = f64::NAN);
        let lost = of_pairs(&sweep(), &sweep(), &pairs(&old, &new));
        assert_eq!((lost.subjects[1].outcome, lost.subjects[1].median), (Outcome::Worse, None));
    }

    /// Metres of one and degrees of the other are not compared.
    #[test]
    fn margins_of_other_quantities_are_left_out() {
        let old = samples(1, "old", 0.0);
        let mut new = old.clone();
        for sample in new.iter_mut().take(50) {
            (sample.margins[0], sample.units[0]) = (-90.0, "deg".to_owned());
        }
        let found = of_pairs(&sweep(), &sweep(), &pairs(&old, &new));
        assert_eq!((found.subjects[1].outcome, found.subjects[1].differences), (Outcome::Equivalent, 150));
    }
}
