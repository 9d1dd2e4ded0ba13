//! The command line.

mod ab_test;
mod bench;
mod bench_suite;
mod campaign_args;
mod check;
mod compare;
mod completions;
#[cfg(feature = "parquet")]
mod diverge;
mod falsify;
mod figures;
mod generate;
mod job_queue;
mod judge;
mod list;
mod log_options;
#[cfg(feature = "parquet")]
mod merge;
mod new;
mod plan;
mod probability;
mod report;
mod request;
mod run;
mod schema;
mod selection;
mod selftest;
mod session;
mod shrink;
mod stress;
#[cfg(feature = "parquet")]
mod sweep;
mod version;

use clap::{Parser, Subcommand};

use crate::error::{Error, Exit};

/// Tests UAV trajectory planners: plans are flown in simulation and judged, with a margin for every limit.
#[derive(Debug, Parser)]
#[command(name = "harness", version, long_version = version::long(), arg_required_else_help = true, after_help = EXAMPLES)]
pub struct Cli {
    #[command(subcommand)]
    command: Command,
}

const EXAMPLES: &str = "\
Examples:
  harness new multirotor             write a commented scenario to start from
  harness list                       list the scenarios and the planners
  harness run                        run every scenario with the planner that it names
  harness run --name 'rendezvous-*'  run the scenarios whose names match
  harness check SCENARIO --plan my-plan.csv
                                     fly and judge an existing plan
  harness judge SCENARIO --flight log.csv
                                     judge a flight that was flown elsewhere
  harness compare out/old out/new    show what got worse between two runs
  harness report out                 write a page to look at in a browser
  harness generate forest            write a random scenario that is known to be feasible

Exit codes:
  0    every verdict is a pass
  1    a verdict is a fail, no plan was found, or a result is worse than the one it is compared with
  2    bad usage, invalid input, or a file that cannot be read or written; valid scenarios are
       still run
  101  a bug in the harness
  130  interrupted by Ctrl-C";

#[derive(Debug, Subcommand)]
enum Command {
    Run(run::Run),
    Check(check::Check),
    #[command(name = "judge")]
    Judge(judge::JudgeCommand),
    Plan(plan::PlanCommand),
    New(new::New),
    Request(request::Request),
    List(list::List),
    Compare(compare::Compare),
    Baseline(compare::BaselineCommand),
    #[command(name = "report")]
    Report(report::ReportCommand),
    Bench(bench::Bench),
    #[command(name = "figures")]
    Figures(figures::FiguresCommand),
    Generate(generate::Generate),
    #[cfg(feature = "parquet")]
    Diverge(diverge::Diverge),
    #[cfg(feature = "parquet")]
    #[command(name = "sweep")]
    Sweep(sweep::SweepCommand),
    #[cfg(feature = "parquet")]
    Merge(merge::Merge),
    #[command(name = "stress")]
    Stress(stress::StressCommand),
    #[command(name = "falsify")]
    Falsify(falsify::FalsifyCommand),
    #[command(name = "ab-test")]
    AbTest(ab_test::AbTestCommand),
    #[command(name = "probability")]
    Probability(probability::ProbabilityCommand),
    #[command(name = "shrink")]
    Shrink(shrink::ShrinkCommand),
    #[command(name = "selftest")]
    Selftest(selftest::SelftestCommand),
    Schema(schema::Schema),
    Completions(completions::Completions),
    Man(completions::Man),
}

impl Cli {
    /// Parses a command line, the name of the program first. Help, version and bad usage end the process.
    pub fn from_arguments(arguments: Vec<String>) -> Self {
        Self::parse_from(arguments)
    }

    /// Executes the command.
    ///
    /// # Errors
    ///
    /// Invalid input, and trouble with the environment. Findings about plans are part of the returned [`Exit`].
    pub fn execute(&self) -> Result<Exit, Error> {
        match &self.command {
            Command::Run(run) => run.execute(),
            Command::Check(check) => check.execute(),
            Command::Judge(judge) => judge.execute(),
            Command::Plan(plan) => plan.execute(),
            Command::New(new) => new.execute(),
            Command::Request(request) => request.execute(),
            Command::List(list) => list.execute(),
            Command::Compare(compare) => compare.execute(),
            Command::Baseline(baseline) => baseline.execute(),
            Command::Report(report) => report.execute(),
            Command::Bench(bench) => bench.execute(),
            Command::Figures(figures) => figures.execute(),
            Command::Generate(generate) => generate.execute(),
            #[cfg(feature = "parquet")]
            Command::Diverge(diverge) => diverge.execute(),
            #[cfg(feature = "parquet")]
            Command::Sweep(sweep) => sweep.execute(),
            #[cfg(feature = "parquet")]
            Command::Merge(merge) => merge.execute(),
            Command::Stress(stress) => stress.execute(),
            Command::Falsify(falsify) => falsify.execute(),
            Command::AbTest(ab_test) => ab_test.execute(),
            Command::Probability(probability) => probability.execute(),
            Command::Shrink(shrink) => shrink.execute(),
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

    /// Help is wrapped at this width, so that longer lines of a table would lose their columns.
    #[test]
    fn examples_and_tables_in_the_help_are_not_wrapped() {
        let cli = super::Cli::command();
        for command in cli.get_subcommands().chain([&cli]) {
            let text = command.get_after_help().map(ToString::to_string).unwrap_or_default();
            for line in text.lines() {
                assert!(line.chars().count() <= 100, "{}: {line}", command.get_name());
            }
        }
    }
}
