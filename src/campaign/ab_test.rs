//! Is B better than A? Pairs of flights in equal worlds, until the answer is certain enough.
//!
//! Both systems fly every drawn scenario with the same seed, so that what both suffer from drops out of the difference of their
//! margins. [`sign_test`] decides, and bounds the median of the differences.

pub mod sign_test;

use rayon::prelude::*;
use serde::Serialize;

use crate::campaign::distribution::RandomField;
use crate::campaign::probability::RandomSpace;
use crate::campaign::probability::splitting::{self, Point};
use crate::campaign::trial::{TestSystem, Trial, has_several_quantities};
use sign_test::SignTest;

/// Version of the result format.
const SCHEMA: u32 = 1;
/// Pairs that are flown at once; those beyond the one that decides do not count.
const BATCH: usize = 8;

/// One of the systems: a planner in its scenario.
pub struct Contender<'a> {
    /// The scenario and its random fields.
    pub space: RandomSpace<'a>,
    /// The planner.
    pub system: TestSystem<'a>,
}

/// How long to look, and for what.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Options {
    /// Probability of deciding for a difference that is not there, however long the test goes on; in (0, 1).
    pub alpha: f64,
    /// Median differences up to this are of no interest, in the unit of the margin; 0 to ask for any difference.
    pub tolerance: f64,
    /// Largest number of pairs.
    pub pairs: usize,
    /// Seed of the draws.
    pub seed: u64,
}

/// The answer.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Outcome {
    /// The margin of B is smaller than that of A, by more than the tolerance.
    Worse,
    /// The margin of B is larger.
    Better,
    /// The margins differ by less than the tolerance.
    Equivalent,
    /// The pairs were used up before any of these was certain.
    Undecided,
}

/// The result.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct AbTest {
    /// Version of this format: 1.
    pub schema: u32,
    /// Names of scenario and planner of A.
    pub a: [String; 2],
    /// Names of scenario and planner of B.
    pub b: [String; 2],
    /// The check whose margins are compared; `None` for the one that is nearest to failing. Without a check, and of a check of
    /// several quantities, margins are fractions of their limits.
    pub check: Option<String>,
    /// Unit of the margins.
    pub unit: String,
    /// Seed of the draws.
    pub seed: u64,
    /// The random fields, as on the command line.
    pub fields: Vec<RandomField>,
    /// The answer.
    pub outcome: Outcome,
    /// Number of pairs that were compared.
    pub pairs: usize,
    /// Median of the margin of B minus that of A; absent if one of them mostly lacks a margin.
    pub median: Option<f64>,
    /// Ends of its confidence interval; an absent one is infinite.
    pub interval: [Option<f64>; 2],
    /// Probability of an error.
    pub alpha: f64,
    /// Differences of no interest.
    pub tolerance: f64,
    /// Pairs in which A and B failed.
    pub failed: [usize; 2],
    /// Pairs in which A and B had no margin: no plan, a skipped check. They count as worse than any margin.
    pub without_margin: [usize; 2],
    /// Whether all differences are the same number, as they are if nothing random acts on the flights.
    pub is_constant: bool,
    /// Whether the last pairs could not be drawn: both systems could fly hardly any of the drawn scenarios.
    pub is_cut_short: bool,
}

/// The margin of a trial, in the unit of its check.
#[derive(Clone, Debug, PartialEq)]
struct Measured {
    margin: Option<f64>,
    fails: bool,
    unit: Option<String>,
}

/// Flies pairs until the answer is certain.
///
/// - `progress`: is called with the number of pairs so far
pub fn run(a: &Contender<'_>, b: &Contender<'_>, options: &Options, progress: &mut dyn FnMut(usize)) -> AbTest {
    let pair = |number: usize| {
        let mut random = scenarios::stream(options.seed, &format!("pair/{number}"));
        (0..splitting::REJECTED_PER_PARTICLE).find_map(|_| {
            let point = splitting::draw(a.space.dimension(), true, &mut random);
            let (a, b) = rayon::join(|| a.measure(&point), || b.measure(&point));
            Some([a?, b?])
        })
    };
    let (outcome, record) = compare(&pair, options, progress);
    let names = |it: &Contender<'_>| [it.space.scenario_name().to_owned(), it.system.source.name().to_owned()];
    let finite = |value: f64| value.is_finite().then_some(value);
    AbTest {
        schema: SCHEMA,
        a: names(a),
        b: names(b),
        check: a.system.check.map(str::to_owned),
        unit: record.unit.unwrap_or_else(|| "-".to_owned()),
        seed: options.seed,
        fields: a.space.fields().to_vec(),
        outcome,
        pairs: record.test.pairs(),
        median: record.test.median().and_then(finite),
        interval: record.test.interval().map(finite),
        alpha: options.alpha,
        tolerance: options.tolerance,
        failed: record.failed,
        without_margin: record.without_margin,
        is_constant: record.test.pairs() > 1 && record.first.is_some_and(|_| !record.varies),
        is_cut_short: record.is_cut_short,
    }
}

impl Contender<'_> {
    /// `None` if the scenario is not valid.
    fn measure(&self, point: &Point) -> Option<Measured> {
        let seed = point.seed.unwrap_or(self.system.seed);
        match self.system.try_out_with(&self.space.document(point), seed) {
            Trial::Rejected => None,
            Trial::NoPlan => Some(Measured { margin: None, fails: true, unit: None }),
            Trial::Unanswered => Some(Measured { margin: None, fails: false, unit: None }),
            Trial::Judged(finding) => Some(match self.system.check {
                Some(check) if !has_several_quantities(check) => {
                    Measured { margin: finding.margin, fails: finding.fails, unit: Some(finding.unit) }
                }
                _ => Measured { margin: Some(finding.relative), fails: finding.fails, unit: None },
            }),
        }
    }
}

/// What was observed so far.
struct Record {
    test: SignTest,
    failed: [usize; 2],
    without_margin: [usize; 2],
    unit: Option<String>,
    first: Option<f64>,
    varies: bool,
    is_cut_short: bool,
}

impl Record {
    fn add(&mut self, pair: [Measured; 2]) {
        for (side, measured) in pair.iter().enumerate() {
            self.failed[side] += usize::from(measured.fails);
            self.without_margin[side] += usize::from(measured.margin.is_none());
        }
        let difference = difference(&pair);
        self.varies |= self.first.is_some_and(|first| first != difference);
        self.first.get_or_insert(difference);
        self.test.add(difference);
        self.unit = self.unit.take().or_else(|| pair.into_iter().find_map(|measured| measured.unit));
    }
}

/// The margin of B minus that of A. No margin is worse than any.
fn difference([a, b]: &[Measured; 2]) -> f64 {
    match [a.margin, b.margin].map(|margin| margin.filter(|margin| !margin.is_nan())) {
        [None, None] => 0.0,
        [Some(_), None] => f64::NEG_INFINITY,
        [None, Some(_)] => f64::INFINITY,
        [Some(a), Some(b)] if a == b => 0.0,
        [Some(a), Some(b)] => b - a,
    }
}

/// Takes pairs in the order of their numbers until the interval decides.
fn compare(
    pair: &(dyn Fn(usize) -> Option<[Measured; 2]> + Sync),
    options: &Options,
    progress: &mut dyn FnMut(usize),
) -> (Outcome, Record) {
    let mut record = Record {
        test: SignTest::new(options.alpha),
        failed: [0; 2],
        without_margin: [0; 2],
        unit: None,
        first: None,
        varies: false,
        is_cut_short: false,
    };
    let mut next = 0;
    while next < options.pairs {
        let end = (next + BATCH).min(options.pairs);
        let flown: Vec<Option<[Measured; 2]>> = (next..end).into_par_iter().map(pair).collect();
        for measured in flown {
            let Some(measured) = measured else {
                record.is_cut_short = true;
                return (Outcome::Undecided, record);
            };
            record.add(measured);
            progress(record.test.pairs());
            if let Some(outcome) = decided(record.test.interval(), options.tolerance) {
                return (outcome, record);
            }
        }
        next = end;
    }
    (Outcome::Undecided, record)
}

/// What an interval of the median difference of B and A decides.
fn decided([low, high]: [f64; 2], tolerance: f64) -> Option<Outcome> {
    if high < -tolerance {
        Some(Outcome::Worse)
    } else if low > tolerance {
        Some(Outcome::Better)
    } else if -tolerance <= low && high <= tolerance {
        Some(Outcome::Equivalent)
    } else {
        None
    }
}

#[cfg(test)]
mod tests {
    use rand_distr::{Distribution, Normal};

    use super::{Measured, Options, Outcome, Record, compare, decided, difference};

    const OPTIONS: Options = Options { alpha: 0.05, tolerance: 0.0, pairs: 400, seed: 0 };

    fn measured(margin: f64) -> Measured {
        Measured { margin: Some(margin), fails: margin < 0.0, unit: Some("m".to_owned()) }
    }

    /// Two systems in the same weather, which moves both margins by far more than their difference.
    fn of_systems(seed: u64, shift: f64, options: &Options) -> (Outcome, Record) {
        let (weather, own) = (Normal::new(2.0, 1.0).unwrap(), Normal::new(0.0, 0.1).unwrap());
        let pair = |number: usize| {
            let mut random = scenarios::stream(seed, &format!("test/{number}"));
            let common = weather.sample(&mut random);
            Some([0.0, shift].map(|shift| measured(common + shift + own.sample(&mut random))))
        };
        compare(&pair, options, &mut |_| {})
    }

    /// 1,000 comparisons of a system with itself: at most 5 % false alarms, plus binomial slack.
    #[test]
    fn comparisons_of_a_system_with_itself_seldom_decide() {
        let alarms = (0..1000).filter(|seed| of_systems(*seed, 0.0, &OPTIONS).0 != Outcome::Undecided).count();
        assert!(alarms <= 70, "{alarms} of 1000");
    }

    #[test]
    fn a_difference_is_decided_after_few_pairs_with_its_size() {
        for (shift, wanted) in [(-0.12, Outcome::Worse), (0.12, Outcome::Better)] {
            for seed in 0..20 {
                let (outcome, record) = of_systems(seed, shift, &OPTIONS);
                let [low, high] = record.test.interval();
                assert_eq!(outcome, wanted, "seed {seed}");
                assert!(
                    record.test.pairs() < 120 && high - low < 0.6,
                    "{} pairs: {low} to {high}",
                    record.test.pairs()
                );
            }
        }
    }

    #[test]
    fn equivalence_is_decided_within_a_tolerance_and_small_differences_are_not_reported() {
        let options = Options { tolerance: 0.1, ..OPTIONS };
        let outcomes: Vec<Outcome> = (0..20).map(|seed| of_systems(seed, 0.02, &options).0).collect();
        assert!(outcomes.iter().all(|it| *it == Outcome::Equivalent), "{outcomes:?}");
        assert_eq!(of_systems(1, 0.3, &options).0, Outcome::Better);
    }

    #[test]
    fn the_pair_that_decides_does_not_depend_on_the_threads() {
        let with = |threads: usize| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            let (outcome, record) = pool.install(|| of_systems(3, -0.12, &OPTIONS));
            (outcome, record.test.pairs(), record.test.interval(), record.failed)
        };
        assert_eq!(with(1), with(4));
    }

    #[test]
    fn a_flight_without_a_margin_is_worse_than_any() {
        let none = || Measured { margin: None, fails: true, unit: None };
        assert_eq!(difference(&[measured(-3.0), none()]), f64::NEG_INFINITY);
        assert_eq!(difference(&[none(), measured(-3.0)]), f64::INFINITY);
        assert_eq!(difference(&[none(), none()]), 0.0);
        let (outcome, record) = compare(&|_| Some([measured(1.0), none()]), &OPTIONS, &mut |_| {});
        assert_eq!((outcome, record.without_margin, record.failed), (Outcome::Worse, [0, 8], [0, 8]));
    }

    #[test]
    fn scenarios_that_cannot_be_drawn_end_the_test() {
        let (outcome, record) =
            compare(&|number| (number < 5).then(|| [0.0, 1.0].map(measured)), &OPTIONS, &mut |_| {});
        assert_eq!((outcome, record.test.pairs(), record.is_cut_short), (Outcome::Undecided, 5, true));
    }

    #[test]
    fn intervals_decide_only_what_they_exclude() {
        assert_eq!(decided([-0.2, -0.1], 0.0), Some(Outcome::Worse));
        assert_eq!(decided([-0.2, 0.0], 0.0), None);
        assert_eq!(decided([0.01, 0.2], 0.1), None);
        assert_eq!(decided([-0.05, 0.1], 0.1), Some(Outcome::Equivalent));
        assert_eq!(decided([0.0, 0.0], 0.0), Some(Outcome::Equivalent));
        assert_eq!(decided([f64::NEG_INFINITY, f64::INFINITY], 0.1), None);
    }
}
