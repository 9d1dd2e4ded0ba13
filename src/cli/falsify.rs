use std::path::{Path, PathBuf};

use clap::Args;

use super::campaign_args::CampaignArgs;
use super::run::PlannerArgs;
use super::shrink;
use crate::campaign::falsification::{self, Falsification, FoundFailure, Method, SearchOptions, Space, VariedField};
use crate::campaign::scenario_document::ScenarioDocument;
use crate::campaign::trial::{FirstPlan, TestSystem};
use crate::console;
use crate::error::{Error, Exit};
use crate::jobs::{self, Job};
use crate::number_format::signed_quantity;
use crate::output;
use crate::progress::Progress;

/// Search for scenarios in which a planner fails
///
/// Fields of the scenario vary within given ranges: positions and sizes of obstacles, starts, goals, wind, masses, noise,
/// delays, or any other number. Every candidate is planned, flown and judged, and the search moves towards smaller margins
/// of the check (without --check: the smallest margin of separation, clearance and tracking, as fractions of their limits).
/// The worst failure of each kind (a check, and the bodies it names) is written as a scenario file that reproduces it
/// exactly. Candidates that are not valid scenarios cost no flight. The exit code is 1 if a failure was found.
#[derive(Args, Debug)]
#[command(after_help = EXAMPLES)]
pub struct FalsifyCommand {
    /// The scenario file
    #[arg(value_name = "SCENARIO")]
    scenario: PathBuf,
    /// A field and its range; repeatable. Elements of lists are addressed by index or by name
    #[arg(long = "vary", value_name = "FIELD=LOW..HIGH", required = true)]
    fields: Vec<VariedField>,
    /// The check to fail, as `flight.clearance` [default: any]
    #[arg(long, value_name = "CHECK", value_parser = shrink::check_name)]
    check: Option<String>,
    /// Number of flights
    #[arg(short = 'n', long, value_name = "N", default_value_t = 100, value_parser = clap::value_parser!(u32).range(1..))]
    flights: u32,
    /// How candidates are chosen
    #[arg(long, value_enum, default_value_t = Method::CmaEs)]
    method: Method,
    /// Seed of the search; that of the flights is the scenario's
    #[arg(long, value_name = "N", default_value_t = 0)]
    seed: u64,
    /// Shrink every failure, in at most as many flights again; see `harness shrink`
    #[arg(long)]
    shrink: bool,
    #[command(flatten)]
    planners: PlannerArgs,
    #[command(flatten)]
    campaign: CampaignArgs,
}

const EXAMPLES: &str = "\
Examples:
  harness falsify scenarios/multirotor/pop-up.toml -p rhc-fpso \\
      --vary vehicles[0].start.y_m=-3..3 --vary vehicles[0].goal.y_m=-3..3
  harness falsify scenarios/fixed-wing/rendezvous-1.toml -p parallel-scp -n 200 --shrink \\
      --check plan.clearance --vary world.cylinders.threat-1.radius_m=20..120 \\
      --vary vehicles.uav-1.goal.y_m=-500..500

Results, in out/<scenario>/<planner>/:
  falsify.json                              the search, and one failure of each kind
  failures/<scenario>-failure-1.toml        the scenario of the first kind of failure
  failures/<scenario>-failure-1-small.toml  with --shrink: the smallest that still fails

`harness run out/<scenario>/<planner>/failures/*.toml` repeats and records them.";

impl FalsifyCommand {
    /// Searches, writes and prints.
    pub fn execute(&self) -> Result<Exit, Error> {
        self.campaign.start_threads()?;
        let job = &jobs::load_one(&self.scenario, &self.planners.sources()?, None)?;
        let document = ScenarioDocument::of(&job.source).planned_by(&job.plan_source);
        let space = Space::new(&document, &self.fields)
            .map_err(|field| Error::NoNumber { file: self.scenario.clone(), field: field.to_string() })?;
        shrink::require_check(&job.scenario, &self.scenario, self.check.as_deref())?;
        let first_plan = FirstPlan::of(&document, &job.plan_source, job.seed);
        let system = TestSystem::new(job, first_plan.as_ref(), self.check.as_deref());
        let found = self.search(job, &space, &system);
        let folder = self.campaign.folder_of(job);
        output::create_folder(&folder)?;
        output::write_json(&folder.join("falsify.json"), &found)?;
        self.write_failures(job, &space, &system, &found, &folder.join("failures"))?;
        if !self.campaign.quiet {
            console::print(&self.text(&found))?;
            console::print(&format!("results in {}", folder.display()))?;
        }
        if found.worst.is_none() {
            return Err(Error::NothingJudged { file: self.scenario.clone(), why: counts(&found) });
        }
        Ok(if found.failures.is_empty() { Exit::Passed } else { Exit::Failed })
    }

    fn search(&self, job: &Job, space: &Space<'_>, system: &TestSystem<'_>) -> Falsification {
        let flights = self.flights as usize;
        let mut progress = Progress::new(job, 1, 1, self.campaign.quiet);
        let options = SearchOptions { flights, method: self.method, seed: self.seed };
        let mut flown = 0;
        let found = falsification::search(space, system, options, &mut |done| {
            (flown + 1..=done.min(flights)).for_each(|flight| progress.swept(flight, flights));
            flown = done;
        });
        progress.finish();
        found
    }

    /// Writes the scenarios of the failures; those of an earlier search are removed.
    fn write_failures(
        &self,
        job: &Job,
        space: &Space<'_>,
        system: &TestSystem<'_>,
        found: &Falsification,
        folder: &Path,
    ) -> Result<(), Error> {
        remove_earlier(folder, &job.scenario.name)?;
        for (index, failure) in found.failures.iter().enumerate() {
            let name = format!("{}-failure-{}", job.scenario.name, index + 1);
            let document = space.document(&failure.values);
            shrink::write(&document.renamed(&name), &name, &headline(failure), folder)?;
            if self.shrink {
                let mut progress = Progress::new(job, index + 1, found.failures.len(), self.campaign.quiet);
                let shrunk = shrink::shrunk(&document, &failure.finding, system, self.flights, &mut progress);
                progress.finish();
                let name = format!("{name}-small");
                shrink::write(&shrunk.document.renamed(&name), &name, &shrink::headline(&shrunk), folder)?;
            }
        }
        Ok(())
    }

    fn text(&self, found: &Falsification) -> String {
        let mut lines: Vec<String> = found
            .failures
            .iter()
            .enumerate()
            .map(|(index, failure)| format!("failure {}: {}; {}", index + 1, headline(failure), self.place(failure)))
            .collect();
        if let Some(worst) = found.worst.as_ref().filter(|_| found.failures.is_empty()) {
            lines.push(format!("nearest to a failure: {}; {}", headline(worst), self.place(worst)));
        }
        lines.push(counts(found));
        lines.join("\n")
    }

    fn place(&self, found: &FoundFailure) -> String {
        let fields = self.fields.iter().zip(&found.values);
        fields.map(|(field, value)| format!("{} = {value:.6}", field.path)).collect::<Vec<_>>().join(", ")
    }
}

/// What became of the candidates, in one line.
fn counts(found: &Falsification) -> String {
    let Falsification { flights, rejected, no_plan, unanswered, failed, failures, .. } = found;
    let kinds = match failures.len() {
        0 => String::new(),
        1 => ", all of one kind".to_owned(),
        count => format!(", of {count} kinds"),
    };
    let rest = [(*no_plan, "without a plan"), (*unanswered, "in which the check was skipped")];
    let rest: String = rest.iter().filter(|(n, _)| *n > 0).map(|(n, what)| format!("; {n} {what}")).collect();
    let invalid =
        if *rejected > 0 { format!("; {rejected} candidates were not valid scenarios") } else { String::new() };
    format!("{failed} of {flights} flights failed{kinds}{rest}{invalid}")
}

/// Removes the failures of an earlier search.
fn remove_earlier(folder: &Path, scenario: &str) -> Result<(), Error> {
    let Ok(entries) = std::fs::read_dir(folder) else { return Ok(()) };
    let is_ours = |name: &str| name.starts_with(&format!("{scenario}-failure-")) && name.ends_with(".toml");
    let paths = entries.flatten().filter(|entry| entry.file_name().to_str().is_some_and(is_ours));
    paths.map(|entry| entry.path()).try_for_each(|path| output::remove_stale(&path))
}

/// The check, its margin and whom it names: `flight.clearance -0.12 m at 3.25 s (uav-1, threat-3)`.
fn headline(found: &FoundFailure) -> String {
    let finding = &found.finding;
    let margin =
        finding.margin.map_or_else(String::new, |margin| format!(" {}", signed_quantity(margin, &finding.unit)));
    let when = finding.at_s.map_or_else(String::new, |at_s| format!(" at {at_s:.2} s"));
    let who = if finding.between.is_empty() { String::new() } else { format!(" ({})", finding.between.join(", ")) };
    format!("{}{margin}{when}{who}", finding.check)
}
