//! The command line.

mod bench;
mod list;
mod run;
mod schema;

use clap::{Parser, Subcommand};

use crate::error::{Error, Exit};

/// Flies UAV trajectory plans in simulation and judges them, margin in metres, before anything leaves the ground.
#[derive(Debug, Parser)]
#[command(name = "harness", version, arg_required_else_help = true, after_help = EXAMPLES)]
pub struct Cli {
    #[command(subcommand)]
    command: Command,
}

const EXAMPLES: &str = "\
Examples:
  harness list                      what there is: scenarios and planners
  harness run                       every scenario, each with the planner that it names
  harness run scenarios/fixed-wing  those of one folder
  harness schema scenario           the form of a scenario file, for an editor that completes and checks

Exit codes:
  0    every verdict passed
  1    some verdict failed, or no plan was found
  2    bad usage, bad input, or trouble with files; good scenarios beside bad ones are still run
  101  a bug in the harness
  130  stopped by ctrl-C";

#[derive(Debug, Subcommand)]
enum Command {
    Run(run::Run),
    List(list::List),
    Schema(schema::Schema),
    Bench(bench::Bench),
}

impl Cli {
    /// Does what the command line asks for.
    pub fn execute(&self) -> Result<Exit, Error> {
        match &self.command {
            Command::Run(run) => run.execute(),
            Command::List(list) => list.execute(),
            Command::Schema(schema) => schema.execute(),
            Command::Bench(bench) => bench.execute(),
        }
    }
}

#[cfg(test)]
mod tests {
    use clap::CommandFactory;

    #[test]
    fn the_command_line_is_consistent() {
        super::Cli::command().debug_assert();
    }
}
