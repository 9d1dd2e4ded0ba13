use std::path::{Path, PathBuf};

use clap::Args;
use scenarios::{Plan, PlanStatus};

use super::run::PlannerArgs;
use crate::console;
use crate::error::{Error, Exit};
use crate::jobs;
use crate::output;
use crate::pipeline;
use crate::plan_source::plan_import::CompletedPlan;
use crate::plan_source::{PlanSource, PlannerOutput};
use crate::progress::Progress;

/// Plan a scenario without flying it
#[derive(Args, Debug)]
#[command(after_help = EXAMPLES)]
pub struct PlanCommand {
    /// The scenario file
    #[arg(value_name = "SCENARIO")]
    scenario: PathBuf,
    #[command(flatten)]
    planners: PlannerArgs,
    /// File for the plan, .json or .csv; `-` prints JSON to standard output
    #[arg(short, long, value_name = "FILE", default_value = "plan.json")]
    output: PathBuf,
    /// Seed of all random numbers of the planner, in place of the scenario's
    #[arg(long, value_name = "N")]
    seed: Option<u64>,
    /// Print nothing but errors
    #[arg(short, long)]
    quiet: bool,
}

const EXAMPLES: &str = "\
Examples:
  harness plan scenarios/fixed-wing/rendezvous-7.toml -o plan.csv
  harness plan scenarios/fixed-wing/rendezvous-7.toml -o - | jq .status

`harness check SCENARIO --plan FILE` flies and judges the plan. In-loop planners have no plan before
the flight.";

/// Whether the source is a plan that is none; the reason is printed.
pub fn has_no_plan(source: &PlanSource) -> bool {
    matches!(source, PlanSource::Imported(answer) if print_no_plan(answer))
}

/// Prints the reason if an answer holds no plan.
fn print_no_plan(answer: &CompletedPlan) -> bool {
    let is_none = answer.plan.status == PlanStatus::NoPlan;
    if is_none {
        let reason = answer.plan.reason.as_deref().unwrap_or("the planner gives no reason");
        console::eprint(&format!("no plan: {reason}"));
    }
    is_none
}

impl PlanCommand {
    /// Plans, and writes the plan.
    pub fn execute(&self) -> Result<Exit, Error> {
        self.check_output_format()?;
        let plan_sources = self.planners.sources()?;
        let job = &jobs::load_one(&self.scenario, &plan_sources, self.seed)?;
        let in_loop = || Error::PlansInTheLoop { planner: job.plan_source.name().to_owned() };
        let mut progress = Progress::new(job, 1, 1, self.quiet);
        let PlannerOutput { guidance, log } = pipeline::prepare(job, &mut progress);
        progress.finish();
        let answer = guidance.into_plan().ok_or_else(in_loop)?;
        if print_no_plan(&answer) {
            if let Some(log) = log.map(|log| log()).filter(|log| !log.is_empty()) {
                console::eprint(log.trim_end());
            }
            return Ok(Exit::Failed);
        }
        self.write(&answer.plan)?;
        Ok(Exit::Passed)
    }

    fn check_output_format(&self) -> Result<(), Error> {
        let known = ["json", "csv"].iter().any(|known| self.output.extension().is_some_and(|own| own == *known));
        if known || self.is_standard_output() { Ok(()) } else { Err(Error::PlanForm { path: self.output.clone() }) }
    }

    fn is_standard_output(&self) -> bool {
        self.output == Path::new("-")
    }

    fn write(&self, plan: &Plan) -> Result<(), Error> {
        if self.is_standard_output() {
            return plan.write_json(std::io::stdout().lock()).or_else(|error| match error.kind() {
                std::io::ErrorKind::BrokenPipe => Ok(()),
                _ => Err(error.into()),
            });
        }
        let is_csv = self.output.extension().is_some_and(|extension| extension == "csv");
        output::write_file(
            &self.output,
            |writer| if is_csv { plan.write_csv(writer) } else { plan.write_json(writer) },
        )?;
        if self.quiet {
            return Ok(());
        }
        let reason = plan.reason.as_ref().map(|reason| format!(" ({reason})")).unwrap_or_default();
        console::print(&format!("plan: {}{reason}; written to {}", plan.status, self.output.display()))
    }
}
