use std::path::{Path, PathBuf};

use clap::Args;
use scenarios::{Scenario, check_spec, closest_name};

use super::run::PlannerArgs;
use crate::campaign::scenario_document::ScenarioDocument;
use crate::campaign::shrinking::{self, Shrunk};
use crate::campaign::trial::{Finding, FirstPlan, TestSystem, Trial};
use crate::console;
use crate::error::{Error, Exit};
use crate::jobs;
use crate::output;
use crate::progress::Progress;

/// Find the smallest scenario in which a planner still fails
///
/// Vehicles, obstacles and settings of the simulation are removed and numbers simplified, as long as the same check fails. Every
/// change is planned, flown and judged. Models, limits, planner settings and the seed stay as they are. The exit code is 1
/// if the scenario does not fail.
#[derive(Args, Debug)]
#[command(after_help = EXAMPLES)]
pub struct ShrinkCommand {
    /// The scenario file
    #[arg(value_name = "SCENARIO")]
    scenario: PathBuf,
    /// The check that has to fail [default: the one that fails by most]
    #[arg(long, value_name = "CHECK", value_parser = check_name)]
    check: Option<String>,
    /// Largest number of flights
    #[arg(short = 'n', long, value_name = "N", default_value_t = 300, value_parser = clap::value_parser!(u32).range(1..))]
    flights: u32,
    #[command(flatten)]
    planners: PlannerArgs,
    /// Folder for the results
    #[arg(short, long, value_name = "DIR", default_value = "out")]
    out: PathBuf,
    /// Print errors only
    #[arg(short, long)]
    quiet: bool,
}

const EXAMPLES: &str = "\
Examples:
  harness shrink scenarios/fixed-wing/rendezvous-7.toml -p parallel-scp --check plan.separation
  harness shrink my-scenario.toml --planner-command 'python3 planner.py'

Results, in out/<scenario>/<planner>/:
  <scenario>-small.toml    the smallest scenario that fails; `harness run` repeats it";

impl ShrinkCommand {
    /// Shrinks, writes and prints.
    pub fn execute(&self) -> Result<Exit, Error> {
        let job = &jobs::load_one(&self.scenario, &self.planners.sources()?, None)?;
        let document = ScenarioDocument::of(&job.source).planned_by(&job.plan_source);
        require_check(&job.scenario, &self.scenario, self.check.as_deref())?;
        let first_plan = FirstPlan::of(&document, &job.plan_source, job.seed);
        let system = TestSystem::new(job, first_plan.as_ref(), self.check.as_deref());
        let mut progress = Progress::new(job, 1, 1, self.quiet);
        let finding = match system.try_out(&document) {
            Trial::Judged(finding) if finding.fails => finding,
            other => {
                progress.finish();
                let why = self.why_not(&other);
                console::eprint(&format!("{}: {why}: there is nothing to shrink", job.scenario.name));
                return Ok(Exit::Failed);
            }
        };
        let shrunk = shrunk(&document, &finding, &system, self.flights, &mut progress);
        progress.finish();
        let folder = self.out.join(&job.scenario.name).join(job.plan_source.name());
        let name = format!("{}-small", job.scenario.name);
        let path = write(&shrunk.document.renamed(&name), &name, &headline(&shrunk), &folder)?;
        if !self.quiet {
            console::print(&headline(&shrunk))?;
            console::print(&format!("the scenario is {}", path.display()))?;
        }
        Ok(Exit::Passed)
    }

    /// Why a trial is no failure.
    fn why_not(&self, trial: &Trial) -> String {
        match (trial, &self.check) {
            (Trial::NoPlan, _) => "the planner finds no plan".to_owned(),
            (Trial::Unanswered, Some(check)) => format!("{check} was skipped"),
            (_, Some(check)) => format!("{check} does not fail"),
            (_, None) => "no check fails".to_owned(),
        }
    }
}

/// Refuses a check that no verdict of the scenario has.
pub fn require_check(scenario: &Scenario, file: &Path, check: Option<&str>) -> Result<(), Error> {
    let Some(check) = check else { return Ok(()) };
    let requirements = scenario.all_requirements();
    let of_requirements =
        requirements.iter().flat_map(|it| ["plan", "flight"].map(|group| format!("{group}.requirement.{}", it.name)));
    let known: Vec<String> =
        scenarios::check_names(scenario.family()).map(str::to_owned).chain(of_requirements).collect();
    if known.iter().any(|name| name == check) {
        return Ok(());
    }
    let closest = closest_name(check, known.iter().map(String::as_str)).map(str::to_owned);
    Err(Error::NoSuchCheck { file: file.to_owned(), check: check.to_owned(), closest })
}

/// Shrinks with progress.
pub fn shrunk(
    document: &ScenarioDocument,
    finding: &Finding,
    system: &TestSystem<'_>,
    flights: u32,
    progress: &mut Progress,
) -> Shrunk {
    let flights = flights as usize;
    shrinking::shrink(document, finding, system, flights, &mut |flown| progress.swept(flown, flights))
}

/// What was shrunk, in one line.
pub fn headline(shrunk: &Shrunk) -> String {
    let shrinking::Counts { flights, elements, settings, numbers, is_cut_short } = shrunk.counts;
    let end = if is_cut_short { "; more flights may remove more" } else { "; nothing more can be removed" };
    let Finding { check, between, .. } = &shrunk.finding;
    let who = if between.is_empty() { String::new() } else { format!(" of {}", between.join(" and ")) };
    let done =
        [(elements, "vehicles and obstacles removed"), (settings, "settings removed"), (numbers, "numbers simplified")];
    let done: Vec<String> = done.iter().filter(|(n, _)| *n > 0).map(|(n, what)| format!("{n} {what}")).collect();
    let done = if done.is_empty() { "as it is".to_owned() } else { format!("with {}", done.join(", ")) };
    format!("{check}{who} still fails {done} ({flights} flights){end}")
}

/// Writes a scenario under its name, with a comment above it. Returns the path.
pub fn write(document: &ScenarioDocument, name: &str, comment: &str, folder: &Path) -> Result<PathBuf, Error> {
    output::create_folder(folder)?;
    let path = folder.join(format!("{name}.toml"));
    let text = format!("# {comment}\n{}", document.text());
    output::write_file(&path, |writer| writer.write_all(text.as_bytes()))?;
    Ok(path)
}

/// The name of a check.
pub fn check_name(text: &str) -> Result<String, String> {
    if check_spec(text).is_some() {
        return Ok(text.to_owned());
    }
    let known = scenarios::CHECKS.iter().map(|check| check.name);
    let hint = closest_name(text, known).map_or_else(String::new, |name| format!("; did you mean `{name}`?"));
    Err(format!("expected the name of a check, as `flight.clearance`{hint}"))
}
