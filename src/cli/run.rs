use std::path::{Path, PathBuf};

use clap::Args;

use super::selection::Selection;
use super::session::Session;
use crate::error::{Error, Exit};
use crate::jobs;
use crate::plan_source::PlanSource;
use crate::plan_source::external::ExternalPlanner;

/// Plan, fly, judge and record scenarios.
///
/// Each scenario is planned, the plan is flown in simulation by a tracking controller in the scenario's wind, and the
/// judge measures what the planner saw at its nodes, what the plan is between them, and what was flown. A scenario passes
/// if every deciding check does.
#[derive(Args, Debug)]
#[command(after_help = EXAMPLES)]
pub struct Run {
    #[command(flatten)]
    selection: Selection,
    #[command(flatten)]
    plan_source: AuthorArgs,
    /// Seed of everything random, instead of the scenario's own
    #[arg(long, value_name = "N")]
    seed: Option<u64>,
    #[command(flatten)]
    session: Session,
}

/// Who plans instead of the planner that a scenario names.
#[derive(Args, Debug)]
pub struct AuthorArgs {
    /// Planner to use instead of the one that the scenario names; repeat it to run several
    #[arg(short, long = "planner", value_name = "NAME")]
    planners: Vec<String>,
    /// Planner of your own: a program with its arguments, which reads a JSON request and writes a JSON reply
    #[arg(long, value_name = "COMMAND", conflicts_with = "planners")]
    planner_command: Option<String>,
    /// Your planner flies multirotors while it plans: one JSON request per line and turn, one reply per line
    #[arg(long, requires = "planner_command")]
    in_loop: bool,
    /// Time that your planner has, s [default: 60; with --in-loop 10 for each answer]
    #[arg(long, value_name = "S", requires = "planner_command", value_parser = seconds)]
    time_limit: Option<f64>,
}

const EXAMPLES: &str = "\
Examples:
  harness run scenarios/fixed-wing/rendezvous-7.toml    one scenario
  harness run -p parallel-scp --seed 3 -o out/seed-3    another planner, another seed, another folder
  harness run --tag ci --record none -q                 verdicts only, as in continuous integration
  harness run --name 'rendezvous-*' --baseline baseline.json
  harness run --name rendezvous-1 --planner-command 'python3 my_planner.py'

Results:
  out/<scenario>/<planner>/report.json                every check with value, limit and margin
  out/<scenario>/<planner>/flight.rrd, flight.mcap    the recording
  out/<scenario>/<planner>/plan.json, plan.csv        the plan
  out/summary.json, out/summary.md, out/junit.xml     the whole run

docs/outside-planners.md tells what a planner of your own reads and writes, docs/ci.md how to run this in CI.";

impl Run {
    /// Runs everything that can be run, and names what cannot.
    pub fn execute(&self) -> Result<Exit, Error> {
        let plan_sources = self.plan_source.plan_sources()?;
        let files = self.selection.files()?;
        let jobs = jobs::load(&files, &plan_sources, self.seed, |scenario| self.selection.is_wanted(scenario));
        if jobs.runnable.is_empty() && jobs.rejected.is_empty() {
            return Err(self.selection.nothing());
        }
        self.session.run(jobs)
    }
}

impl AuthorArgs {
    /// The planners that were named; none if the scenario is to name it.
    pub fn plan_sources(&self) -> Result<Vec<PlanSource>, Error> {
        let Some(text) = &self.planner_command else { return jobs::planners_named(&self.planners) };
        let command = shlex::split(text).filter(|words| !words.is_empty());
        let command = command.ok_or_else(|| Error::PlannerCommand { command: text.clone() })?;
        let (name, folder) = (name_of(&command), PathBuf::from("."));
        Ok(vec![PlanSource::External(ExternalPlanner {
            name,
            command,
            folder,
            time_limit_s: self.time_limit,
            in_loop: self.in_loop,
        })])
    }
}

/// A name for the results of a command: that of its script if there is one, else that of the program.
fn name_of(command: &[String]) -> String {
    let script = command.iter().skip(1).find(|word| !word.starts_with('-') && Path::new(word).extension().is_some());
    let stem = Path::new(script.unwrap_or(&command[0])).file_stem().unwrap_or_default().to_string_lossy().into_owned();
    plain_name(&stem)
}

/// `text` as a name that can be a folder: letters, digits, `-` and `_`. Never that of a planner of ours.
pub fn plain_name(text: &str) -> String {
    let plain = text.chars().map(|c| if c.is_ascii_alphanumeric() || c == '-' || c == '_' { c } else { '-' });
    let plain: String = plain.collect::<String>().trim_matches('-').to_owned();
    let plain = if plain.is_empty() { "outside".to_owned() } else { plain };
    if planners::find(&plain).is_some() { format!("outside-{plain}") } else { plain }
}

fn seconds(text: &str) -> Result<f64, String> {
    let value = text.parse::<f64>().map_err(|_| "a number of seconds is expected".to_owned())?;
    if value > 0.0 && value.is_finite() { Ok(value) } else { Err("a positive number of seconds is expected".into()) }
}
