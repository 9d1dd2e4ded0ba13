use std::path::{Path, PathBuf};

use clap::{Args, ValueEnum};
use scenarios::PlanningClock;

use super::selection::Selection;
use super::session::Session;
use crate::error::{Error, Exit};
use crate::jobs::{self, Job};
use crate::plan_source::PlanSource;
use crate::plan_source::external::ExternalPlanner;

/// Plan, fly, judge and record scenarios
///
/// Each scenario is planned, and a tracking controller flies the plan in simulation, with the wind, the sensor noise and the
/// model errors of the scenario. The judge checks the plan at the planner's nodes, the plan between the nodes, and the
/// flight. A scenario passes if all of its checks pass, except those that it declares advisory.
#[derive(Args, Debug)]
#[command(after_help = EXAMPLES)]
pub struct Run {
    #[command(flatten)]
    selection: Selection,
    #[command(flatten)]
    planners: PlannerArgs,
    #[command(flatten)]
    clock: ClockArgs,
    /// Seed of all random numbers, in place of the scenario's
    #[arg(long, value_name = "N")]
    seed: Option<u64>,
    #[command(flatten)]
    session: Session,
}

/// Planners to use in place of the one that a scenario names.
#[derive(Args, Debug)]
pub struct PlannerArgs {
    /// Planner to use in place of the one that the scenario names; `run` takes several
    #[arg(short, long = "planner", value_name = "NAME")]
    planners: Vec<String>,
    /// External planner: a program with its arguments, which reads a JSON request and writes a JSON reply
    #[arg(long, value_name = "COMMAND", conflicts_with = "planners")]
    planner_command: Option<String>,
    /// The external planner plans in the loop, for multirotors: one request and one reply per line
    #[arg(long, requires = "planner_command")]
    in_loop: bool,
    /// Time limit of the external planner, s [default: 60; with --in-loop 10 per reply]
    #[arg(long, value_name = "S", requires = "planner_command", value_parser = seconds)]
    time_limit: Option<f64>,
}

/// The clock of in-loop planners.
#[derive(Args, Debug)]
pub struct ClockArgs {
    /// Planning times of in-loop planners during the flight, in place of the scenario's `simulation.planning.time`
    /// [default there: modelled]
    #[arg(long, value_enum, value_name = "CLOCK")]
    planner_clock: Option<PlannerClock>,
}

/// Clocks that need no recorded times.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum PlannerClock {
    /// The scenario's model of planning times: the same flight on every machine
    Modelled,
    /// The wall clock: a slow replan is flown late, and the flight depends on the machine
    Measured,
}

impl ClockArgs {
    /// The job with this clock.
    pub fn applied_to(&self, mut job: Job) -> Job {
        if let Some(clock) = self.planner_clock {
            job.scenario.simulation.planning.time = match clock {
                PlannerClock::Modelled => PlanningClock::Modelled,
                PlannerClock::Measured => PlanningClock::Measured,
            };
        }
        job
    }
}

const EXAMPLES: &str = "\
Examples:
  harness run scenarios/fixed-wing/rendezvous-7.toml    one scenario
  harness run -p parallel-scp --seed 3 -o out/seed-3    with another planner, seed and folder
  harness run --tag ci --record none -q                 verdicts only, for continuous integration
  harness run --name 'rendezvous-*' --baseline baseline.json
  harness run --name rendezvous-1 --planner-command 'python3 my_planner.py'

Results:
  out/<scenario>/<planner>/report.json                every check with its value, limit and margin
  out/<scenario>/<planner>/flight.rrd, flight.mcap    the recording
  out/<scenario>/<planner>/plan.json, plan.csv        the plan
  out/summary.json, out/summary.md, out/junit.xml     the summary of all results

docs/external-planners.md describes the protocol of external planners, docs/ci.md continuous
integration.";

impl Run {
    /// Runs all valid jobs, and reports the others.
    pub fn execute(&self) -> Result<Exit, Error> {
        let plan_sources = self.planners.sources()?;
        let files = self.selection.files()?;
        let mut jobs = jobs::load(&files, &plan_sources, self.seed, |scenario| self.selection.is_wanted(scenario));
        if jobs.runnable.is_empty() && jobs.rejected.is_empty() {
            return Err(self.selection.nothing());
        }
        jobs.runnable = jobs.runnable.into_iter().map(|job| self.clock.applied_to(job)).collect();
        self.session.run(jobs)
    }
}

impl PlannerArgs {
    /// The planners of the command line; empty if there are none.
    pub fn sources(&self) -> Result<Vec<PlanSource>, Error> {
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

/// A name for the results of a command: that of its script if there is one, otherwise that of the program.
fn name_of(command: &[String]) -> String {
    let script = command.iter().skip(1).find(|word| !word.starts_with('-') && Path::new(word).extension().is_some());
    let stem = Path::new(script.unwrap_or(&command[0])).file_stem().unwrap_or_default().to_string_lossy().into_owned();
    plain_name(&stem)
}

/// `text` as the name of a folder: letters, digits, `-` and `_`. It is never the name of a registered planner.
pub fn plain_name(text: &str) -> String {
    let plain = text.chars().map(|c| if c.is_ascii_alphanumeric() || c == '-' || c == '_' { c } else { '-' });
    let plain: String = plain.collect::<String>().trim_matches('-').to_owned();
    let plain = if plain.is_empty() { "outside".to_owned() } else { plain };
    if planners::find(&plain).is_some() { format!("outside-{plain}") } else { plain }
}

fn seconds(text: &str) -> Result<f64, String> {
    let value = text.parse::<f64>().map_err(|_| "expected a number of seconds".to_owned())?;
    if value > 0.0 && value.is_finite() { Ok(value) } else { Err("expected a positive number of seconds".into()) }
}
