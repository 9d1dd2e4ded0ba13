//! The command line.

mod bench;
mod check;
mod compare;
mod completions;
#[cfg(feature = "parquet")]
mod diverge;
mod list;
#[cfg(feature = "parquet")]
mod merge;
mod plan;
mod run;
mod schema;
mod selection;
mod selftest;
mod session;
mod stress;
#[cfg(feature = "parquet")]
mod sweep;

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
  harness run --name 'rendezvous-*' those whose names match
  harness check SCENARIO --plan my-plan.csv
                                    fly and judge a plan that was made elsewhere
  harness compare out/old out/new   what got worse

Exit codes:
  0    every verdict passed
  1    some verdict failed, no plan was found, or a comparison shows a loss
  2    bad usage, bad input, or trouble with files; good scenarios beside bad ones are still run
  101  a bug in the harness
  130  stopped by ctrl-C";

#[derive(Debug, Subcommand)]
enum Command {
    Run(run::Run),
    Check(check::Check),
    Plan(plan::PlanCommand),
    List(list::List),
    Compare(compare::Compare),
    Baseline(compare::BaselineCommand),
    Bench(bench::Bench),
    #[cfg(feature = "parquet")]
    Diverge(diverge::Diverge),
    #[cfg(feature = "parquet")]
    #[command(name = "sweep")]
    Sweep(sweep::SweepCommand),
    #[cfg(feature = "parquet")]
    Merge(merge::Merge),
    #[command(name = "stress")]
    Stress(stress::StressCommand),
    #[command(name = "selftest")]
    Selftest(selftest::SelftestCommand),
    Schema(schema::Schema),
    Completions(completions::Completions),
    Man(completions::Man),
}

impl Cli {
    /// Does what the command line asks for.
    pub fn execute(&self) -> Result<Exit, Error> {
        match &self.command {
            Command::Run(run) => run.execute(),
            Command::Check(check) => check.execute(),
            Command::Plan(plan) => plan.execute(),
            Command::List(list) => list.execute(),
            Command::Compare(compare) => compare.execute(),
            Command::Baseline(baseline) => baseline.execute(),
            Command::Bench(bench) => bench.execute(),
            #[cfg(feature = "parquet")]
            Command::Diverge(diverge) => diverge.execute(),
            #[cfg(feature = "parquet")]
            Command::Sweep(sweep) => sweep.execute(),
            #[cfg(feature = "parquet")]
            Command::Merge(merge) => merge.execute(),
            Command::Stress(stress) => stress.execute(),
            Command::Selftest(selftest) => selftest.execute(),
            Command::Schema(schema) => schema.execute(),
            Command::Completions(completions) => completions.execute(),
            Command::Man(man) => man.execute(),
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
