//! How likely a failure is, down to probabilities that no number of plain draws would show.
//!
//! Some fields of a scenario are random. Adaptive multilevel splitting ([`splitting`]) goes from the usual scenarios to the
//! failing ones through ever smaller margins; independent runs of it give the estimate and its confidence interval
//! ([`interval`]). Plain Monte Carlo is the reference.

pub mod interval;
mod random_space;
pub mod splitting;

use std::ops::Range;
use std::sync::atomic::{AtomicUsize, Ordering};

use clap::ValueEnum;
use rayon::prelude::*;
use serde::Serialize;

use crate::campaign::distribution::RandomField;
use crate::campaign::trial::{Finding, TestSystem, Trial};
use interval::Interval;
pub use random_space::RandomSpace;
use splitting::{Point, Run, RunEnd, RunSettings, Score};

/// Version of the result format.
const SCHEMA: u32 = 1;
/// What is rarer than this fraction of the probability in question does not matter.
const NEGLIGIBLE: f64 = 0.01;
/// What is rarer than this does not matter if no probability is in question.
const SMALLEST: f64 = 1e-12;

/// How probabilities are estimated.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, ValueEnum)]
#[serde(rename_all = "kebab-case")]
pub enum Method {
    /// Adaptive multilevel splitting, guided by the margins
    Splitting,
    /// Independent draws: the reference
    MonteCarlo,
}

/// What is asked, and what it may cost.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Options {
    /// How the probability is estimated.
    pub method: Method,
    /// The probability in question; `None` for an estimate alone.
    pub at_most: Option<f64>,
    /// Confidence of the two-sided interval, in (0, 1).
    pub confidence: f64,
    /// Largest number of flights.
    pub flights: usize,
    /// Number of independent runs, at least 2.
    pub runs: usize,
    /// Number of particles of each run, at least 2.
    pub particles: usize,
    /// Metropolis steps of every copied particle.
    pub moves: usize,
    /// Seed of the draws.
    pub seed: u64,
}

/// Whether the probability is at most the one in question.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Decision {
    /// The whole interval is at or below it.
    Yes,
    /// The whole interval is above it.
    No,
    /// The interval contains it.
    Undecided,
}

/// The result.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct FailureProbability {
    /// Version of this format: 1.
    pub schema: u32,
    /// Name of the scenario.
    pub scenario: String,
    /// Name of the planner.
    pub planner: String,
    /// The check; `None` for any.
    pub check: Option<String>,
    /// How the probability was estimated.
    pub method: Method,
    /// Seed of the draws.
    pub seed: u64,
    /// The random fields, as on the command line.
    pub fields: Vec<RandomField>,
    /// Whether every flight has a random seed.
    pub any_seed: bool,
    /// Probability of a failure among valid scenarios, with its confidence interval.
    #[serde(flatten)]
    pub interval: Interval,
    /// Confidence of the interval.
    pub confidence: f64,
    /// The probability in question.
    pub at_most: Option<f64>,
    /// Whether the probability is at most that.
    pub is_at_most: Option<Decision>,
    /// Number of flights.
    pub flights: usize,
    /// Number of draws that were not valid scenarios; they cost no flight, and are not among the possible ones.
    pub rejected: usize,
    /// Number of flights without a plan. They are no failures.
    pub no_plan: usize,
    /// Number of flights in which the check was skipped. They are no failures.
    pub unanswered: usize,
    /// Number of particles of each run.
    pub particles: usize,
    /// Metropolis steps of every copied particle.
    pub moves: usize,
    /// The runs; empty for plain Monte Carlo.
    pub runs: Vec<RunSummary>,
    /// Variance of the runs as a multiple of that with perfect moves; near 1 if the moves suffice.
    pub scatter: Option<f64>,
    /// The failure that is nearest to the median of every input.
    pub likeliest: Option<Likeliest>,
}

/// One run of splitting.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct RunSummary {
    /// Its estimate; if it did not end among failures, the probability that it reached.
    pub reached: f64,
    /// Number of its flights.
    pub flights: usize,
    /// Its end.
    pub end: RunEnd,
}

/// The likeliest failure that was met.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Likeliest {
    /// Values of the fields, in their order.
    pub values: Vec<f64>,
    /// Seed of the flight; `None` for that of the scenario.
    pub seed: Option<u64>,
    /// Distance from the median of the inputs, in standard deviations (Hasofer and Lind's reliability index).
    pub distance: f64,
    /// The check that fails.
    #[serde(flatten)]
    pub finding: Option<Finding>,
}

/// Progress: flights so far, and the probability that has been reached.
pub type Progress<'a> = dyn Fn(usize, f64) + Sync + 'a;

/// Estimates the probability that a trial in a random space fails.
pub fn estimate(
    space: &RandomSpace<'_>,
    system: &TestSystem<'_>,
    options: &Options,
    progress: &Progress<'_>,
) -> FailureProbability {
    let [no_plan, unanswered, rejected] = [const { AtomicUsize::new(0) }; 3];
    let score = |point: &Point| {
        let trial = system.try_out_with(&space.document(point), point.seed.unwrap_or(system.seed));
        let counter = match &trial {
            Trial::Rejected => &rejected,
            Trial::NoPlan => &no_plan,
            Trial::Unanswered => &unanswered,
            Trial::Judged(finding) => return Some(score_of(finding)),
        };
        counter.fetch_add(1, Ordering::Relaxed);
        (trial != Trial::Rejected).then_some(f64::INFINITY)
    };
    let found = estimate_with(space.dimension(), space.any_seed(), &score, options, progress);
    let likeliest = found.likeliest.as_ref().map(|point| {
        let seed = point.seed.unwrap_or(system.seed);
        let finding = match system.try_out_with(&space.document(point), seed) {
            Trial::Judged(finding) => Some(finding),
            _ => None,
        };
        let distance = point.normals.iter().map(|normal| normal * normal).sum::<f64>().sqrt();
        Likeliest { values: space.values(point), seed: point.seed, distance, finding }
    });
    FailureProbability {
        schema: SCHEMA,
        scenario: space.scenario_name().to_owned(),
        planner: system.source.name().to_owned(),
        check: system.check.map(str::to_owned),
        method: options.method,
        seed: options.seed,
        fields: space.fields().to_vec(),
        any_seed: space.any_seed(),
        interval: found.interval,
        confidence: options.confidence,
        at_most: options.at_most,
        is_at_most: options.at_most.map(|at_most| decide(found.interval, at_most)),
        flights: found.flights,
        rejected: rejected.into_inner(),
        no_plan: no_plan.into_inner(),
        unanswered: unanswered.into_inner(),
        particles: options.particles,
        moves: options.moves,
        runs: found.runs.iter().map(RunSummary::of).collect(),
        scatter: found.scatter,
        likeliest,
    }
}

/// Whether the true probability is at most `at_most`, as far as its interval says.
pub fn decide(interval: Interval, at_most: f64) -> Decision {
    if interval.upper <= at_most {
        Decision::Yes
    } else if interval.lower > at_most {
        Decision::No
    } else {
        Decision::Undecided
    }
}

/// The score of a judged flight: the relative margin, <= 0 if and only if the check fails.
fn score_of(finding: &Finding) -> f64 {
    if finding.fails { finding.relative.min(0.0) } else { finding.relative.max(f64::MIN_POSITIVE) }
}

/// What an estimate needs to know of the draws.
struct Estimate {
    interval: Interval,
    runs: Vec<Run>,
    scatter: Option<f64>,
    flights: usize,
    likeliest: Option<Point>,
}

fn estimate_with(
    dimension: usize,
    varies_seed: bool,
    score: &Score<'_>,
    options: &Options,
    progress: &Progress<'_>,
) -> Estimate {
    let settings = RunSettings {
        dimension,
        varies_seed,
        particles: options.particles,
        moves: options.moves,
        max_flights: options.flights / options.runs.max(1),
        max_hazard: -options.at_most.map_or(SMALLEST, |p| p * NEGLIGIBLE).max(SMALLEST).ln(),
    };
    match options.method {
        Method::Splitting => by_splitting(&settings, score, options, progress),
        Method::MonteCarlo => by_draws(&settings, score, options, progress),
    }
}

fn by_splitting(settings: &RunSettings, score: &Score<'_>, options: &Options, progress: &Progress<'_>) -> Estimate {
    let flights = AtomicUsize::new(0);
    let flown = |hazard: f64| progress(flights.fetch_add(1, Ordering::Relaxed) + 1, (-hazard).exp());
    let one = |number: usize| {
        let random = scenarios::stream(options.seed, &format!("probability/run/{number}"));
        splitting::run(settings, random, score, &flown)
    };
    let runs: Vec<Run> = (0..options.runs).into_par_iter().map(one).collect();
    let likeliest = runs.iter().filter_map(|run| run.likeliest.clone()).min_by(|a, b| length(a).total_cmp(&length(b)));
    Estimate {
        interval: interval::of_runs(&runs, options.particles, options.confidence),
        scatter: interval::scatter(&runs, options.particles),
        flights: runs.iter().map(|run| run.flights).sum(),
        likeliest,
        runs,
    }
}

/// Every draw has a stream of its own, so that its result does not depend on the threads.
fn by_draws(settings: &RunSettings, score: &Score<'_>, options: &Options, progress: &Progress<'_>) -> Estimate {
    let flights = AtomicUsize::new(0);
    let one = |number: usize| {
        let mut random = scenarios::stream(options.seed, &format!("probability/draw/{number}"));
        let draw = |_| {
            let point = splitting::draw(settings.dimension, settings.varies_seed, &mut random);
            score(&point).map(|score| (score, point))
        };
        let drawn = (0..splitting::REJECTED_PER_PARTICLE).find_map(draw)?;
        progress(flights.fetch_add(1, Ordering::Relaxed) + 1, 1.0);
        Some(drawn)
    };
    let of = |numbers: Range<usize>| numbers.into_par_iter().filter_map(one).collect::<Vec<(f64, Point)>>();
    let first = FIRST_DRAWS.min(options.flights);
    let mut drawn = of(0..first);
    if !drawn.is_empty() {
        drawn.extend(of(first..options.flights));
    }
    let failures = drawn.iter().filter(|(score, _)| *score <= 0.0).map(|(_, point)| point);
    Estimate {
        interval: interval::of_counts(failures.clone().count(), drawn.len(), options.confidence),
        scatter: None,
        flights: drawn.len(),
        likeliest: failures.min_by(|a, b| length(a).total_cmp(&length(b))).cloned(),
        runs: Vec::new(),
    }
}

/// Plain draws after which a search gives up if none was a valid scenario.
const FIRST_DRAWS: usize = 20;

fn length(point: &Point) -> f64 {
    point.normals.iter().map(|normal| normal * normal).sum()
}

impl RunSummary {
    fn of(run: &Run) -> Self {
        Self { reached: (-run.hazard).exp(), flights: run.flights, end: run.end }
    }
}

#[cfg(test)]
mod tests;
