use std::path::PathBuf;

use clap::Args;

use crate::console;
use crate::error::{Error, Exit};
use crate::jobs;
use crate::plan_source::external::{DEFAULT_TIME_LIMIT_S, protocol};

/// Print the request that an external planner gets
///
/// The request is what `harness run --planner-command` writes to the planner's standard input before the flight; it is indented here.
/// docs/external-planners.md describes it and the reply.
#[derive(Args, Debug)]
#[command(after_help = EXAMPLES)]
pub struct Request {
    /// The scenario file
    #[arg(value_name = "SCENARIO")]
    scenario: PathBuf,
    /// Seed of the request, in place of the scenario's
    #[arg(long, value_name = "N")]
    seed: Option<u64>,
}

const EXAMPLES: &str = "\
Examples:
  harness request scenarios/multirotor/trap.toml
  harness request scenarios/fixed-wing/rendezvous-1.toml | my-planner > plan.json";

impl Request {
    /// Prints the request.
    pub fn execute(&self) -> Result<Exit, Error> {
        let (_, scenario) = jobs::load_file(&self.scenario, self.seed)?;
        let request = protocol::plan_request(&scenario, scenario.simulation.seed, DEFAULT_TIME_LIMIT_S);
        console::print(&format!("{request:#}"))?;
        Ok(Exit::Passed)
    }
}
