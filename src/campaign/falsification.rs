//! The search for scenarios in which a planner fails.
//!
//! Some fields of a scenario are free within their ranges. The relative margin of the check that is nearest to failing guides
//! the search: a restart of covariance matrix adaptation descends until it has found failures or stands still, and the next
//! one begins at a random place with more candidates. Every trial plans, flies and judges.

mod cma_es;
mod space;

use clap::ValueEnum;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rayon::prelude::*;
use serde::Serialize;

use crate::campaign::scenario_document::ScenarioDocument;
use crate::campaign::trial::{Finding, TestSystem, Trial};
use cma_es::CmaEs;
pub use space::{Space, VariedField};

/// Standard deviation of the first candidates, as a fraction of the ranges.
const FIRST_SIGMA: f64 = 0.3;
/// A restart ends when its candidates are this close to each other.
const SMALLEST_SIGMA: f64 = 1e-3;
/// A restart ends after so many failures: the next place may hold another kind.
const ENOUGH_FAILURES: usize = 6;
/// A restart ends after so many generations without a better candidate.
const PATIENCE: usize = 12;
/// Trials without a flight per flight of the budget, at most, so that a search among invalid scenarios ends.
const REJECTED_PER_FLIGHT: usize = 20;
/// Version of the result format.
const SCHEMA: u32 = 1;

/// How candidates are chosen.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, ValueEnum)]
#[serde(rename_all = "kebab-case")]
pub enum Method {
    /// Covariance matrix adaptation, guided by the margins
    CmaEs,
    /// Uniform in the ranges: the baseline
    Random,
}

/// What a search may spend, and how.
#[derive(Clone, Copy, Debug)]
pub struct SearchOptions {
    /// Number of flights.
    pub flights: usize,
    /// How candidates are chosen.
    pub method: Method,
    /// Seed of the choice.
    pub seed: u64,
}

/// The result of a search.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Falsification {
    /// Version of this format: 1.
    pub schema: u32,
    /// Name of the scenario.
    pub scenario: String,
    /// Name of the planner.
    pub planner: String,
    /// How candidates were chosen.
    pub method: Method,
    /// Seed of the choice.
    pub seed: u64,
    /// The varied fields.
    pub fields: Vec<String>,
    /// Number of flights.
    pub flights: usize,
    /// Number of candidates that were not valid scenarios; they cost no flight.
    pub rejected: usize,
    /// Number of candidates for which the planner returned no trajectory.
    pub no_plan: usize,
    /// Number of flights in which the check that is asked was not answered.
    pub unanswered: usize,
    /// Number of flights that failed.
    pub failed: usize,
    /// The failures, one of each kind: the one that fails by most, kinds in the order in which they were found.
    pub failures: Vec<FoundFailure>,
    /// The flight that came nearest to failing, or failed by most.
    pub worst: Option<FoundFailure>,
}

/// A candidate and what was found there.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct FoundFailure {
    /// Values of the varied fields, in their order.
    pub values: Vec<f64>,
    /// Number of the flight, from 1.
    pub flight: usize,
    /// The check that decides.
    #[serde(flatten)]
    pub finding: Finding,
}

/// Searches a space until the flights are used up.
///
/// - `progress`: is called with the number of flights so far
pub fn search(
    space: &Space<'_>,
    system: &TestSystem<'_>,
    options: SearchOptions,
    progress: &mut dyn FnMut(usize),
) -> Falsification {
    let found = search_with(space, &|document| system.try_out(document), options, progress);
    Falsification { planner: system.source.name().to_owned(), ..found }
}

fn search_with(
    space: &Space<'_>,
    try_out: &(dyn Fn(&ScenarioDocument) -> Trial + Sync),
    options: SearchOptions,
    progress: &mut dyn FnMut(usize),
) -> Falsification {
    let mut record = Record::new(space, options);
    let mut random = ChaCha8Rng::seed_from_u64(options.seed);
    let mut evaluate = |points: &[Vec<f64>], record: &mut Record| {
        let values: Vec<Vec<f64>> =
            points.iter().take(record.flights_left()).map(|point| space.values(point)).collect();
        let trials: Vec<Trial> = values.par_iter().map(|values| try_out(&space.document(values))).collect();
        for (values, trial) in values.into_iter().zip(&trials) {
            record.add(values, trial);
        }
        progress(record.result.flights);
        trials
    };
    let mut begin = space.origin();
    evaluate(&[begin.clone()], &mut record);
    let usual = CmaEs::usual_candidates(space.dimension());
    let mut candidates = usual;
    while !record.is_spent() {
        match options.method {
            Method::Random => {
                let points: Vec<Vec<f64>> = (0..usual).map(|_| anywhere(space, &mut random)).collect();
                evaluate(&points, &mut record);
            }
            Method::CmaEs => {
                descend(CmaEs::new(&begin, FIRST_SIGMA, candidates), &mut random, &mut record, &mut evaluate);
                begin = anywhere(space, &mut random);
                candidates = (candidates * 3 / 2).min(4 * usual);
            }
        }
    }
    record.result
}

/// One restart.
fn descend(
    mut search: CmaEs,
    random: &mut ChaCha8Rng,
    record: &mut Record,
    evaluate: &mut impl FnMut(&[Vec<f64>], &mut Record) -> Vec<Trial>,
) {
    let (mut failures, mut best): (usize, Vec<f64>) = (0, Vec::new());
    while !record.is_spent() && failures < ENOUGH_FAILURES && search.spread() > SMALLEST_SIGMA {
        let points = search.ask(random);
        let trials = evaluate(&points, record);
        // The last generation may be cut short.
        if record.is_spent() || trials.len() < points.len() {
            return;
        }
        let values: Vec<f64> = trials.iter().map(Trial::value).collect();
        failures += trials.iter().filter(|trial| trial.fails()).count();
        best.push(values.iter().copied().fold(f64::INFINITY, f64::min));
        let before = best.iter().take(best.len().saturating_sub(PATIENCE)).copied().fold(f64::INFINITY, f64::min);
        let lately = best.iter().rev().take(PATIENCE).copied().fold(f64::INFINITY, f64::min);
        if best.len() > PATIENCE && lately >= before {
            return;
        }
        search.tell(&points, &values);
    }
}

fn anywhere(space: &Space<'_>, random: &mut ChaCha8Rng) -> Vec<f64> {
    (0..space.dimension()).map(|_| random.random::<f64>()).collect()
}

/// What was found so far.
struct Record {
    budget: usize,
    result: Falsification,
}

impl Record {
    fn new(space: &Space<'_>, options: SearchOptions) -> Self {
        let result = Falsification {
            schema: SCHEMA,
            scenario: space.scenario_name().to_owned(),
            planner: String::new(),
            method: options.method,
            seed: options.seed,
            fields: space.field_names(),
            flights: 0,
            rejected: 0,
            no_plan: 0,
            unanswered: 0,
            failed: 0,
            failures: Vec::new(),
            worst: None,
        };
        Self { budget: options.flights, result }
    }

    fn is_spent(&self) -> bool {
        self.result.flights >= self.budget || self.result.rejected >= REJECTED_PER_FLIGHT * self.budget
    }

    fn flights_left(&self) -> usize {
        self.budget.saturating_sub(self.result.flights)
    }

    fn add(&mut self, values: Vec<f64>, trial: &Trial) {
        let result = &mut self.result;
        match trial {
            Trial::Rejected => result.rejected += 1,
            Trial::NoPlan => {
                result.flights += 1;
                result.no_plan += 1;
            }
            Trial::Unanswered => {
                result.flights += 1;
                result.unanswered += 1;
            }
            Trial::Judged(finding) => {
                result.flights += 1;
                let found = FoundFailure { values, flight: result.flights, finding: finding.clone() };
                if finding.fails {
                    result.failed += 1;
                    keep_worst(&mut result.failures, &found);
                }
                if result.worst.as_ref().is_none_or(|worst| finding.relative < worst.finding.relative) {
                    result.worst = Some(found);
                }
            }
        }
    }
}

/// One failure of each kind.
fn keep_worst(failures: &mut Vec<FoundFailure>, found: &FoundFailure) {
    match failures.iter_mut().find(|failure| failure.finding.is_same_failure(&found.finding)) {
        Some(known) if found.finding.relative < known.finding.relative => *known = found.clone(),
        Some(_) => {}
        None => failures.push(found.clone()),
    }
}

#[cfg(test)]
mod tests {
    use scenarios::ScenarioFile;

    use super::{Falsification, Method, SearchOptions, Space, VariedField, search_with};
    use crate::campaign::scenario_document::{FieldPath, ScenarioDocument};
    use crate::campaign::trial::{Finding, Trial};

    /// Two pockets, each 0.13 % of a square, in which different checks fail; a corner is not valid.
    fn pockets(document: &ScenarioDocument) -> Trial {
        let [x, y] = ["a.x", "a.y"].map(|path| document.number(&FieldPath::parse(path).unwrap()).unwrap());
        if x + y > 1.8 {
            return Trial::Rejected;
        }
        let away = |[cx, cy]: [f64; 2]| (x - cx).hypot(y - cy) - 0.02;
        let (first, second) = (away([0.2, 0.7]), away([0.8, 0.3]));
        let (check, margin) = if first < second { ("left", first) } else { ("right", second) };
        Trial::Judged(Finding {
            fails: margin < 0.0,
            check: check.to_owned(),
            margin: Some(margin),
            unit: "m".to_owned(),
            relative: margin,
            at_s: None,
            between: Vec::new(),
        })
    }

    fn found(method: Method, seed: u64) -> Falsification {
        let document = ScenarioDocument::of(&ScenarioFile::new("a.toml", "name = \"a\"\n[a]\nx = 0.5\ny = 0.95\n"));
        let fields: Vec<VariedField> = ["a.x=0..1", "a.y=0..1"].map(|text| text.parse().unwrap()).into();
        let space = Space::new(&document, &fields).unwrap();
        search_with(&space, &pockets, SearchOptions { flights: 100, method, seed }, &mut |_| {})
    }

    #[test]
    fn guided_search_finds_what_a_random_one_misses() {
        let searches = |method| (0..20).filter(|seed| found(method, *seed).failed > 0).count();
        let [guided, random] = [Method::CmaEs, Method::Random].map(searches);
        assert!(guided >= 16 && random <= 8, "{guided} and {random} of 20 searches found a failure");
        let kinds = (0..20).map(|seed| found(Method::CmaEs, seed).failures.len()).sum::<usize>();
        assert!(kinds > guided, "no search found both kinds");
    }

    /// Near the corner that is not valid, a generation is cut short by the budget without a flight.
    #[test]
    fn any_budget_ends_a_search_among_invalid_candidates() {
        let document = ScenarioDocument::of(&ScenarioFile::new("a.toml", "name = \"a\"\n[a]\nx = 0.99\ny = 0.99\n"));
        let fields: Vec<VariedField> = ["a.x=0.95..1", "a.y=0.95..1"].map(|text| text.parse().unwrap()).into();
        let space = Space::new(&document, &fields).unwrap();
        for flights in 1..20 {
            let options = SearchOptions { flights, method: Method::CmaEs, seed: 0 };
            let found = search_with(&space, &pockets, options, &mut |_| {});
            assert!(found.flights == 0 && found.rejected >= 20 * flights, "{found:?}");
        }
    }

    #[test]
    fn a_search_is_reproducible_and_keeps_its_budget() {
        let first = found(Method::CmaEs, 3);
        assert_eq!(first, found(Method::CmaEs, 3));
        assert_eq!(first.flights, 100);
        assert!(first.failures.iter().all(|failure| failure.finding.margin.unwrap() < 0.0));
    }
}
