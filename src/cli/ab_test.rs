use std::path::{Path, PathBuf};

use clap::Args;

use super::campaign_args::{CampaignArgs, OutOfRange, number_if};
use super::run::PlannerArgs;
use super::shrink;
use crate::campaign::ab_test::{self, AbTest, Contender, Options, Outcome};
use crate::campaign::distribution::RandomField;
use crate::campaign::probability::RandomSpace;
use crate::campaign::scenario_document::ScenarioDocument;
use crate::campaign::trial::{FirstPlan, TestSystem};
use crate::console;
use crate::error::{Error, Exit};
use crate::jobs::{self, Job};
use crate::number_format::{quantity, signed_quantity};
use crate::output;
use crate::plan_source::PlanSource;
use crate::progress::Progress;

/// Decide whether one planner is better than another, with a bound on the errors
///
/// A and B fly the same randomly drawn scenarios with the same seeds, pair by pair, and the margins of a check are compared.
/// The test may look after every pair and stops as soon as the answer is certain: the probability of a wrong decision, however
/// long it goes on, is at most ALPHA. It reports the median difference with a confidence interval. A is the first planner and B
/// the second one, or the scenario's own planner and the one that is given, or the planners of two scenario files. The exit
/// code is 0 if B is better or equivalent, and 1 if it is worse or nothing was decided.
#[derive(Args, Debug)]
#[command(after_help = EXAMPLES)]
pub struct AbTestCommand {
    /// The scenario file, or two of them: that of A and that of B
    #[arg(value_name = "SCENARIO", required = true, num_args = 1..=2)]
    scenarios: Vec<PathBuf>,
    /// A field and its distribution, as for `harness probability`; repeatable. The seed of gusts, noise and starts is always
    /// random
    #[arg(long = "vary", value_name = "FIELD=DISTRIBUTION")]
    fields: Vec<RandomField>,
    /// The check whose margins are compared, as `flight.clearance` [default: the one that is nearest to failing]
    #[arg(long, value_name = "CHECK", value_parser = shrink::check_name)]
    check: Option<String>,
    /// Probability of deciding for a difference that is not there
    #[arg(long, value_name = "ALPHA", default_value = "0.05", value_parser = alpha)]
    alpha: f64,
    /// Median differences up to this are of no interest, in the unit of the margin: B may be equivalent
    #[arg(long, value_name = "MARGIN", default_value = "0", value_parser = tolerance)]
    tolerance: f64,
    /// Largest number of pairs
    #[arg(short = 'n', long, value_name = "N", default_value_t = 500, value_parser = clap::value_parser!(u32).range(1..))]
    pairs: u32,
    /// Seed of the draws
    #[arg(long, value_name = "N", default_value_t = 0)]
    seed: u64,
    #[command(flatten)]
    planners: PlannerArgs,
    #[command(flatten)]
    campaign: CampaignArgs,
}

const EXAMPLES: &str = "\
Examples:
  harness ab-test scenarios/fixed-wing/rendezvous-7-wind.toml -p fleet-scp -p parallel-scp \\
      --check flight.clearance
  harness ab-test tuned-before.toml tuned-after.toml --check flight.tracking_max --tolerance 0.01 \\
      --vary 'simulation.wind.mean_mps[0]=normal(0, 3)'

Results, in out/<scenario of B>/<planner of B>/:
  ab-test.json    the answer, the median difference, its interval, failures of both

Example of a result:
  B is worse: flight.clearance -0.120 m [-0.160, -0.080] m, decided after 37 pairs, alpha 0.05";

impl AbTestCommand {
    /// Flies, writes and prints.
    pub fn execute(&self) -> Result<Exit, Error> {
        self.campaign.start_threads()?;
        let [job_a, job_b] = self.jobs()?;
        let found = self.test(&job_a, &job_b)?;
        if found.without_margin == [found.pairs; 2] {
            return Err(Error::NothingJudged { file: self.file_of_b().to_owned(), why: counts(&found) });
        }
        let folder = self.campaign.folder_of(&job_b);
        output::create_folder(&folder)?;
        output::write_json(&folder.join("ab-test.json"), &found)?;
        if !self.campaign.quiet {
            console::print(&text(&found))?;
            console::print(&format!("results in {}", folder.display()))?;
        }
        Ok(match found.outcome {
            Outcome::Better | Outcome::Equivalent => Exit::Passed,
            Outcome::Worse | Outcome::Undecided => Exit::Failed,
        })
    }

    fn file_of_b(&self) -> &Path {
        self.scenarios.last().expect("the command line demands one")
    }

    /// The jobs of A and B.
    fn jobs(&self) -> Result<[Job; 2], Error> {
        let sources = self.planners.sources()?;
        let [source_a, source_b]: [&[PlanSource]; 2] = match sources.as_slice() {
            [] if self.scenarios.len() == 1 => return Err(Error::OneSystem),
            [] => [&[], &[]],
            [b] if self.scenarios.len() == 1 => [&[], std::slice::from_ref(b)],
            [both] => [std::slice::from_ref(both); 2],
            [a, b] => [a, b].map(std::slice::from_ref),
            _ => return Err(Error::TooManySystems { count: sources.len() }),
        };
        let a = jobs::load_one(&self.scenarios[0], source_a, None)?;
        Ok([a, jobs::load_one(self.file_of_b(), source_b, None)?])
    }

    fn test(&self, job_a: &Job, job_b: &Job) -> Result<AbTest, Error> {
        let files = [&self.scenarios[0], self.file_of_b()];
        let jobs = [job_a, job_b];
        let documents = jobs.map(|job| ScenarioDocument::of(&job.source).planned_by(&job.plan_source));
        let plans = [0, 1].map(|side| FirstPlan::of(&documents[side], &jobs[side].plan_source, jobs[side].seed));
        let contender = |side: usize| -> Result<Contender<'_>, Error> {
            let file: &Path = files[side];
            let space = RandomSpace::new(&documents[side], &self.fields, true)
                .map_err(|field| Error::NoNumber { file: file.to_owned(), field: field.to_string() })?;
            shrink::require_check(&jobs[side].scenario, file, self.check.as_deref())?;
            let system = TestSystem::new(jobs[side], plans[side].as_ref(), self.check.as_deref());
            Ok(Contender { space, system })
        };
        let (a, b) = (contender(0)?, contender(1)?);
        let pairs = self.pairs as usize;
        let options = Options { alpha: self.alpha, tolerance: self.tolerance, pairs, seed: self.seed };
        let mut progress = Progress::new(job_b, 1, 1, self.campaign.quiet);
        let found = ab_test::run(&a, &b, &options, &mut |done| progress.compared(done, pairs));
        progress.finish();
        Ok(found)
    }
}

fn text(found: &AbTest) -> String {
    let [a, b] = [&found.a, &found.b].map(|[scenario, planner]| format!("{scenario} · {planner}"));
    let what = found.check.as_deref().unwrap_or("smallest margin, as a fraction of its limit,");
    let median = found.median.map_or_else(|| "unbounded".to_owned(), |it| signed_quantity(it, &found.unit));
    let end = |end: Option<f64>, infinite: &str| end.map_or(infinite.to_owned(), |it| signed_quantity(it, &found.unit));
    let [low, high] = found.interval;
    let difference = format!("{what} {median} [{}, {}]", end(low, "-inf"), end(high, "+inf"));
    let (pairs, alpha) = (found.pairs, found.alpha);
    let answer = match found.outcome {
        Outcome::Worse => format!("B is worse: {difference}, decided after {pairs} pairs, alpha {alpha}"),
        Outcome::Better => format!("B is better: {difference}, decided after {pairs} pairs, alpha {alpha}"),
        Outcome::Equivalent => {
            let within = quantity(found.tolerance, &found.unit);
            format!("B is equivalent within {within}: {difference}, decided after {pairs} pairs, alpha {alpha}")
        }
        Outcome::Undecided => format!("undecided after {pairs} pairs: {difference}, alpha {alpha}"),
    };
    let mut lines = vec![format!("A: {a}"), format!("B: {b}"), answer, counts(found)];
    if found.is_constant {
        lines.push(
            "note: every pair gives the same difference: nothing random acts on the flights; see --vary".to_owned(),
        );
    }
    if found.is_cut_short {
        lines.push("note: hardly any of the drawn scenarios is valid for both; narrow the distributions".to_owned());
    }
    lines.join("\n")
}

fn counts(found: &AbTest) -> String {
    let AbTest { failed: [a, b], without_margin: [none_a, none_b], pairs, .. } = found;
    let none = match none_a + none_b {
        0 => String::new(),
        _ => format!("; without a margin, which is worse than any: A {none_a}, B {none_b}"),
    };
    format!("failed of {pairs}: A {a}, B {b}{none}")
}

fn alpha(text: &str) -> Result<f64, OutOfRange> {
    number_if(text, |alpha| (1e-9..=0.5).contains(&alpha), "a probability from 1e-9 to 0.5")
}

fn tolerance(text: &str) -> Result<f64, OutOfRange> {
    number_if(text, |margin| margin >= 0.0 && margin.is_finite(), "a difference >= 0, in the unit of the margin")
}
