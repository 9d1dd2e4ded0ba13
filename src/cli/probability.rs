use std::path::{Path, PathBuf};
use std::sync::Mutex;

use clap::Args;

use super::campaign_args::{CampaignArgs, OutOfRange, number_if};
use super::run::PlannerArgs;
use super::shrink;
use crate::campaign::distribution::RandomField;
use crate::campaign::probability::{self, Decision, FailureProbability, Likeliest, Method, Options, RandomSpace};
use crate::campaign::scenario_document::ScenarioDocument;
use crate::campaign::trial::{FirstPlan, TestSystem};
use crate::console;
use crate::error::{Error, Exit};
use crate::jobs::{self, Job};
use crate::output;
use crate::progress::Progress;

mod show;

/// Estimate how likely a failure is, however rare
///
/// Fields of the scenario are random, each with its distribution. Every trial is planned, flown and judged. Adaptive multilevel
/// splitting goes from the usual scenarios to the failing ones through ever smaller margins, so that a probability of one in a
/// million needs about ten thousand flights instead of a hundred million. Independent runs of it give a confidence interval.
/// With --at-most, the exit code is 0 if the probability is at most P at that confidence, and 1 if it is larger or undecided.
#[derive(Args, Debug)]
#[command(after_help = EXAMPLES)]
pub struct ProbabilityCommand {
    /// The scenario file
    #[arg(value_name = "SCENARIO")]
    scenario: PathBuf,
    /// A field and its distribution; repeatable. Elements of lists are addressed by index or by name
    #[arg(long = "vary", value_name = "FIELD=DISTRIBUTION", required_unless_present = "any_seed")]
    fields: Vec<RandomField>,
    /// Draw a seed for every flight: gusts, noise and starts are random too, and what a planner draws
    #[arg(long)]
    any_seed: bool,
    /// The check that fails, as `flight.clearance` [default: any]
    #[arg(long, value_name = "CHECK", value_parser = shrink::check_name)]
    check: Option<String>,
    /// Ask whether the probability is at most P
    #[arg(long, value_name = "P", value_parser = chance)]
    at_most: Option<f64>,
    /// Confidence of the two-sided interval, %
    #[arg(long, value_name = "%", default_value = "95", value_parser = confidence)]
    confidence: f64,
    /// How the probability is estimated
    #[arg(long, value_enum, default_value_t = Method::Splitting)]
    method: Method,
    /// Largest number of flights
    #[arg(short = 'n', long, value_name = "N", default_value_t = 20_000, value_parser = clap::value_parser!(u32).range(1..))]
    flights: u32,
    /// Number of independent runs of splitting
    #[arg(long, value_name = "N", default_value_t = 10, value_parser = clap::value_parser!(u16).range(2..))]
    runs: u16,
    /// Number of particles of every run: four times as many halve the interval
    #[arg(long, value_name = "N", default_value_t = 16, value_parser = clap::value_parser!(u16).range(2..))]
    particles: u16,
    /// Random steps of a particle that was copied; more of them if the runs scatter
    #[arg(long, value_name = "N", default_value_t = 4, value_parser = clap::value_parser!(u16).range(1..))]
    moves: u16,
    /// Seed of the draws; that of the flights is the scenario's, without --any-seed
    #[arg(long, value_name = "N", default_value_t = 0)]
    seed: u64,
    #[command(flatten)]
    planners: PlannerArgs,
    #[command(flatten)]
    campaign: CampaignArgs,
}

const EXAMPLES: &str = "\
Distributions, in the unit of the field:
  LOW..HIGH                          uniform
  normal(MEAN, DEVIATION)            normal; normal(MEAN, DEVIATION, LOW..HIGH) is truncated
  lognormal(MEDIAN, SPREAD)          SPREAD: standard deviation of the natural logarithm
  weibull(SHAPE, SCALE)              P(x > t) = exp(-(t/SCALE)^SHAPE), as wind speeds

Examples:
  harness probability scenarios/fixed-wing/rendezvous-7-wind.toml --at-most 1e-6 \\
      --vary 'simulation.wind.mean_mps[0]=normal(0, 3)' \\
      --vary 'simulation.wind.mean_mps[1]=normal(0, 3)' --check flight.clearance
  harness probability scenarios/multirotor/pop-up.toml --any-seed \\
      --vary 'vehicles[0].start.y_m=normal(0, 0.5, -2..2)'

Results, in out/<scenario>/<planner>/:
  probability.json                           estimate, interval, every run
  failures/<scenario>-likeliest-failure.toml the failure nearest to the medians

docs/probability.md says how the interval is made, and when it can be trusted.";

impl ProbabilityCommand {
    /// Estimates, writes and prints.
    pub fn execute(&self) -> Result<Exit, Error> {
        self.campaign.start_threads()?;
        let job = &jobs::load_one(&self.scenario, &self.planners.sources()?, None)?;
        let document = ScenarioDocument::of(&job.source).planned_by(&job.plan_source);
        let space = RandomSpace::new(&document, &self.fields, self.any_seed)
            .map_err(|field| Error::NoNumber { file: self.scenario.clone(), field: field.to_string() })?;
        shrink::require_check(&job.scenario, &self.scenario, self.check.as_deref())?;
        let first_plan = FirstPlan::of(&document, &job.plan_source, job.seed);
        let system = TestSystem::new(job, first_plan.as_ref(), self.check.as_deref());
        let found = self.estimate(job, &space, &system);
        if found.flights == found.no_plan + found.unanswered {
            return Err(Error::NothingJudged { file: self.scenario.clone(), why: show::counts(&found) });
        }
        let folder = self.campaign.folder_of(job);
        output::create_folder(&folder)?;
        output::write_json(&folder.join("probability.json"), &found)?;
        write_likeliest(&space, found.likeliest.as_ref(), &folder.join("failures"))?;
        if !self.campaign.quiet {
            console::print(&show::text(&found))?;
            console::print(&format!("results in {}", folder.display()))?;
        }
        Ok(match found.is_at_most {
            None | Some(Decision::Yes) => Exit::Passed,
            Some(Decision::No | Decision::Undecided) => Exit::Failed,
        })
    }

    fn estimate(&self, job: &Job, space: &RandomSpace<'_>, system: &TestSystem<'_>) -> FailureProbability {
        let options = Options {
            method: self.method,
            at_most: self.at_most,
            confidence: self.confidence / 100.0,
            flights: self.flights as usize,
            runs: self.runs.into(),
            particles: self.particles.into(),
            moves: self.moves.into(),
            seed: self.seed,
        };
        let progress = Mutex::new(Progress::new(job, 1, 1, self.campaign.quiet));
        let found = probability::estimate(space, system, &options, &|flights, reached| {
            if let Ok(mut progress) = progress.lock() {
                progress.reached(flights, options.flights, reached);
            }
        });
        if let Ok(progress) = progress.into_inner() {
            progress.finish();
        }
        found
    }
}

/// Writes the likeliest failure; without one, removes that of an earlier search.
fn write_likeliest(space: &RandomSpace<'_>, found: Option<&Likeliest>, folder: &Path) -> Result<(), Error> {
    let name = format!("{}-likeliest-failure", space.scenario_name());
    let Some(found) = found else { return output::remove_stale(&folder.join(format!("{name}.toml"))) };
    let document = space.document_with(&found.values, found.seed).renamed(&name);
    let comment = format!("The likeliest failure that was met: {}", show::likeliest(found));
    shrink::write(&document, &name, &comment, folder).map(|_| ())
}

fn chance(text: &str) -> Result<f64, OutOfRange> {
    number_if(text, |p| p > 0.0 && p < 1.0, "a probability above 0 and below 1, as 1e-6")
}

fn confidence(text: &str) -> Result<f64, OutOfRange> {
    number_if(text, |percent| (50.0..100.0).contains(&percent), "a percentage from 50 to below 100")
}
