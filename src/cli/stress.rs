use std::path::PathBuf;

use clap::Args;

use super::plan::has_no_plan;
use super::run::{ClockArgs, PlannerArgs};
use crate::campaign::failure_threshold::{self, Disturbance, FailureBracket, FailureThreshold};
use crate::console;
use crate::error::{Error, Exit};
use crate::jobs::{self, Job};
use crate::number_format::quantity;
use crate::output;
use crate::output::page;
use crate::pipeline;
use crate::progress::Progress;

/// Find the smallest disturbance that makes the plan fail
///
/// The scenario is planned once and flown with a growing disturbance until a flight fails; in-loop planners plan anew in
/// every flight. The threshold is then bracketed to 0.5 %. Levels beyond the first failure are flown as well, so that a
/// response that is not monotone is reported. The exit code is 1 if the plan fails without the disturbance.
#[derive(Args, Debug)]
#[command(after_help = EXAMPLES)]
pub struct StressCommand {
    /// The scenario file
    #[arg(value_name = "SCENARIO")]
    scenario: PathBuf,
    /// Disturbances to vary, separated by commas
    #[arg(long, value_enum, value_name = "WHAT", value_delimiter = ',', required = true)]
    over: Vec<Disturbance>,
    #[command(flatten)]
    planners: PlannerArgs,
    #[command(flatten)]
    clock: ClockArgs,
    /// Seed of all random numbers, in place of the scenario's
    #[arg(long, value_name = "N")]
    seed: Option<u64>,
    /// Folder for the results
    #[arg(short, long, value_name = "DIR", default_value = "out")]
    out: PathBuf,
    /// Write the report page DIR/index.html; `harness report` does so afterwards
    #[arg(long)]
    html: bool,
    /// Print errors only
    #[arg(short, long)]
    quiet: bool,
}

const EXAMPLES: &str = "\
Examples:
  harness stress scenarios/fixed-wing/rendezvous-7-wind.toml --over wind
  harness stress scenarios/slung/rectangle-wind.toml --over wind,mass,delay,noise

Results, in out/<scenario>/<planner>/:
  stress-<what>.json    every level that was flown, and the bracket of the first failure

Example of a result:
  wind 14.225 m/s: passes at 14.150 m/s, fails by flight.tracking_max; the scenario has 5.000 m/s";

impl StressCommand {
    /// Plans, searches, prints and writes.
    pub fn execute(&self) -> Result<Exit, Error> {
        let plan_sources = self.planners.sources()?;
        let job = &self.clock.applied_to(jobs::load_one(&self.scenario, &plan_sources, self.seed)?);
        self.refuse_without_effect(job)?;
        let mut progress = Progress::new(job, 1, 1, self.quiet);
        let system = pipeline::plan_once(job, &mut progress);
        progress.finish();
        if has_no_plan(&system) {
            return Ok(Exit::Failed);
        }
        let folder = self.out.join(&job.scenario.name).join(job.plan_source.name());
        output::create_folder(&folder)?;
        let mut exit = Exit::Passed;
        for &over in &self.over {
            let mut flown = 0;
            let stress = failure_threshold::run(&job.scenario, &system, over, job.seed, &mut |count| flown += count);
            output::write_json(&folder.join(format!("stress-{}.json", name(over))), &stress)?;
            if !self.quiet {
                console::print(&format!("{}  ({flown} flights)", in_words(&stress)))?;
            }
            if stress.trials.first().is_some_and(|trial| !trial.passed) {
                exit = Exit::Failed;
            }
        }
        if self.html {
            page::write(&self.out)?;
        }
        Ok(exit)
    }

    /// A disturbance that cannot act would seem to be harmless at every level.
    fn refuse_without_effect(&self, job: &Job) -> Result<(), Error> {
        let useless = self.over.iter().find_map(|over| over.without_effect(&job.scenario));
        let error =
            |issue| Error::NoEffect { file: self.scenario.clone(), option: "--over wind", issue: Box::new(issue) };
        useless.map_or(Ok(()), |issue| Err(error(issue)))
    }
}

/// The result in one line.
fn in_words(stress: &FailureThreshold) -> String {
    let level = |level: f64| match stress.over {
        Disturbance::Mass => format!("{:+.1} %", 100.0 * level),
        Disturbance::Wind | Disturbance::Delay | Disturbance::Noise => quantity(level, stress.unit),
    };
    let what = name(stress.over);
    let asked = format!("the scenario has {}", level(stress.asked));
    let odd = if stress.is_monotone { "" } else { "; NOT MONOTONE: a stronger one passes again" };
    if let Some(FailureBracket { passes, fails, failed_checks }) = &stress.bracket {
        let failed = failed_checks.join(", ");
        return format!("{what} {}: passes at {}, fails by {failed}; {asked}{odd}", level(*fails), level(*passes));
    }
    match stress.trials.iter().find(|trial| !trial.passed) {
        Some(first) => format!("{what}: fails without it, by {}{odd}", first.failed_checks.join(", ")),
        None => {
            let highest = stress.trials.iter().map(|trial| trial.level).fold(0.0, f64::max);
            format!("{what}: passes up to {}, the largest level tried; {asked}", level(highest))
        }
    }
}

fn name(over: Disturbance) -> &'static str {
    match over {
        Disturbance::Wind => "wind",
        Disturbance::Mass => "mass",
        Disturbance::Delay => "delay",
        Disturbance::Noise => "noise",
    }
}
