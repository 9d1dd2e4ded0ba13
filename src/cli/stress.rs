use std::path::PathBuf;

use clap::Args;

use super::plan::has_no_plan;
use super::run::AuthorArgs;
use crate::campaign::failure_threshold::{self, Disturbance, FailureThreshold};
use crate::console;
use crate::error::{Error, Exit};
use crate::jobs;
use crate::number_format::quantity;
use crate::output;
use crate::pipeline;
use crate::progress::Progress;

/// Find the smallest disturbance that makes the plan fail
///
/// The scenario is planned once (in-loop planners plan anew in every flight) and flown with a growing disturbance until a
/// flight fails. Levels beyond the first failure are flown too, so that a response that is not monotone is reported. The
/// exit code is 1 if the plan fails without the disturbance.
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
    plan_source: AuthorArgs,
    /// Seed of everything random, instead of the scenario's own
    #[arg(long, value_name = "N")]
    seed: Option<u64>,
    /// Folder for the results
    #[arg(short, long, value_name = "DIR", default_value = "out")]
    out: PathBuf,
    /// Print nothing but errors; the files tell the rest
    #[arg(short, long)]
    quiet: bool,
}

const EXAMPLES: &str = "\
Examples:
  harness stress scenarios/fixed-wing/rendezvous-7-wind.toml --over wind
  harness stress scenarios/slung/rectangle.toml --over wind,mass,delay,noise

Results:
  out/<scenario>/<planner>/stress-<what>.json    every level that was flown, and the bracket of the first failure";

impl StressCommand {
    /// Plans, searches, prints and writes.
    pub fn execute(&self) -> Result<Exit, Error> {
        let plan_sources = self.plan_source.plan_sources()?;
        let job = &jobs::load_one(&self.scenario, &plan_sources, self.seed)?;
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
        Ok(exit)
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
    match (&stress.bracket, stress.trials.first(), stress.trials.last()) {
        (Some(bracket), ..) => {
            let failed = bracket.failed_checks.join(", ");
            format!(
                "{what} {}: passes at {}, fails by {failed}; {asked}{odd}",
                level(bracket.fails),
                level(bracket.passes)
            )
        }
        (None, Some(first), _) if !first.passed => {
            format!("{what}: fails without it, by {}{odd}", first.failed_checks.join(", "))
        }
        (None, _, Some(last)) => {
            format!("{what}: passes up to {}, the largest level tried; {asked}", level(last.level))
        }
        (None, _, None) => format!("{what}: no level was flown"),
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
