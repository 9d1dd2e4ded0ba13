//! `harness bench suite`: planners on random scenarios that are known to be feasible.

mod lower_bound;
mod run;
mod show;

use std::path::PathBuf;

use scenarios::Family;
use serde::{Serialize, Serializer};

use super::entry;
use crate::campaign::generate::{Kind, Request};
use crate::error::Error;
pub use show::{markdown, text};

/// What to measure.
#[derive(Clone, Debug)]
pub struct Plan {
    /// The scenarios, apart from their seeds.
    pub cases: Vec<Request>,
    /// Planners; each runs on the families that it supports. Empty: those that the scenarios name.
    pub planners: Vec<String>,
    /// Seeds of every case: this one and its successors.
    pub first_seed: u64,
    /// Number of seeds.
    pub seeds: u64,
    /// Time limit of one run, s.
    pub limit_s: f64,
    /// Runs at a time.
    pub jobs: usize,
    /// Folder for the scenarios that were not passed.
    pub folder: PathBuf,
}

/// The results.
#[derive(Clone, Debug, Serialize)]
pub struct Results {
    /// Version of this format.
    pub schema: u32,
    /// Version of the harness.
    pub harness: &'static str,
    /// Seeds of every row.
    pub seeds: [u64; 2],
    /// Time limit of one run, s.
    pub limit_s: f64,
    /// Number of worker threads, and of runs at a time.
    pub threads: usize,
    /// Number of runs at a time.
    pub jobs: usize,
    /// One row per case and planner.
    pub rows: Vec<Row>,
    /// The runs that did not pass.
    pub failures: Vec<Failure>,
    /// The commands for which no feasible scenario was found; they are not counted.
    pub infeasible: Vec<String>,
}

/// What became of a run.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum RunOutcome {
    /// Every check passed.
    Pass,
    /// The planner says that it has found no plan.
    NoPlan,
    /// A check failed.
    Fail,
    /// The planner calls the plan solved, and a check of the plan failed.
    Overclaimed,
    /// The time limit was reached.
    TimedOut,
}

impl RunOutcome {
    /// All, in the order of the table.
    pub const ALL: [Self; 5] = [Self::Pass, Self::NoPlan, Self::Fail, Self::Overclaimed, Self::TimedOut];

    /// Its name in a table.
    pub fn name(self) -> &'static str {
        match self {
            Self::Pass => "pass",
            Self::NoPlan => "no plan",
            Self::Fail => "fail",
            Self::Overclaimed => "overclaimed",
            Self::TimedOut => "timed out",
        }
    }
}

/// One case with one planner.
#[derive(Clone, Debug, Serialize)]
pub struct Row {
    /// Family of the vehicles.
    #[serde(serialize_with = "family_key")]
    pub family: Family,
    /// Kind of the scenarios.
    pub kind: &'static str,
    /// Variant of the kind.
    pub variant: Option<&'static str>,
    /// Their size.
    pub size: usize,
    /// Their density.
    pub density: f64,
    /// The planner.
    pub planner: String,
    /// Number of runs.
    pub runs: usize,
    /// Runs that passed.
    pub pass: usize,
    /// Runs without a plan.
    pub no_plan: usize,
    /// Runs in which a check failed.
    pub fail: usize,
    /// Runs in which the planner calls the plan solved, and a check of the plan failed.
    pub overclaimed: usize,
    /// Runs that reached the time limit.
    pub timed_out: usize,
    /// Planning time, all replans of a flight together: median, 90 % quantile, largest, s.
    pub planning_s: Option<[f64; 3]>,
    /// Flight time of the runs that passed, over its lower bound: median, largest.
    pub over_lower_bound: Option<[f64; 2]>,
}

impl Row {
    /// Number of runs with this outcome.
    pub fn count(&self, outcome: RunOutcome) -> usize {
        match outcome {
            RunOutcome::Pass => self.pass,
            RunOutcome::NoPlan => self.no_plan,
            RunOutcome::Fail => self.fail,
            RunOutcome::Overclaimed => self.overclaimed,
            RunOutcome::TimedOut => self.timed_out,
        }
    }
}

/// A run that did not pass.
#[derive(Clone, Debug, Serialize)]
pub struct Failure {
    /// Scenario.
    pub scenario: String,
    /// Planner.
    pub planner: String,
    /// What became of it.
    pub outcome: RunOutcome,
    /// The failed checks, or why there is no plan.
    pub reason: String,
    /// The command that generates the scenario.
    pub generate: String,
    /// The scenario file, which is kept.
    pub file: PathBuf,
}

impl Failure {
    /// The command that runs it again.
    pub fn command(&self) -> String {
        format!("harness run {} -p {}", self.file.display(), self.planner)
    }
}

/// The cases of the full suite: every kind, with and without its variant, in its three sizes, and at the largest density in
/// the middle one.
pub fn cases(kinds: &[&'static Kind]) -> Vec<Request> {
    kinds.iter().flat_map(|kind| variants(kind).iter().flat_map(|&is_variant| cases_of(kind, is_variant))).collect()
}

fn variants(kind: &Kind) -> &'static [bool] {
    if kind.variant.is_some() { &[false, true] } else { &[false] }
}

fn cases_of(kind: &'static Kind, is_variant: bool) -> impl Iterator<Item = Request> {
    let request = Request { is_variant, ..Request::new(kind, 0) };
    let dense = Request { size: kind.size.suite[1], density: kind.density.max, ..request };
    let is_denser = kind.density.max > kind.density.default;
    kind.size.suite.into_iter().map(move |size| Request { size, ..request }).chain(is_denser.then_some(dense))
}

/// Runs the suite.
///
/// - `progress`: receives a line at the beginning, and one for each run that has ended
///
/// # Errors
///
/// If a scenario cannot be generated, or a file cannot be written.
pub fn run(plan: &Plan, progress: &mut (dyn FnMut(&str) + Send)) -> Result<Results, Error> {
    progress(&format!("generating {} scenarios", plan.cases.len() as u64 * plan.seeds));
    let (runs, infeasible) = run::list(plan)?;
    let measured = run::all(plan, &runs, progress)?;
    let mut rows: Vec<Row> = Vec::new();
    let mut rest = measured.as_slice();
    for runs in runs.chunk_by(run::same_row) {
        let (of_row, others) = rest.split_at(runs.len());
        rows.push(run::row(runs, of_row));
        rest = others;
    }
    let failures = runs.iter().zip(&measured).filter_map(|(run, measured)| run::failure(plan, run, measured)).collect();
    Ok(Results {
        schema: 1,
        harness: env!("CARGO_PKG_VERSION"),
        seeds: [plan.first_seed, plan.first_seed + plan.seeds.saturating_sub(1)],
        limit_s: plan.limit_s,
        threads: rayon::current_num_threads(),
        jobs: plan.jobs,
        rows,
        failures,
        infeasible,
    })
}

fn family_key<S: Serializer>(family: &Family, serializer: S) -> Result<S::Ok, S::Error> {
    serializer.serialize_str(family.key())
}
