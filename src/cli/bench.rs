use std::path::PathBuf;

use clap::{Args, ValueEnum};
use scenarios::Scenario;

use crate::bench::ipm;
use crate::error::{Error, Exit};
use crate::output;

/// Measure what a paper's table says, side by side with the baselines.
///
/// `ipm`: the interior-point method by our block sweep, by the paper's three ways to the Newton direction, and a general
/// solver (Clarabel), on subproblems of a run of the planner parallel-scp.
#[derive(Args, Debug)]
#[command(after_help = EXAMPLES)]
pub struct Bench {
    /// What to measure
    #[arg(value_enum)]
    name: Name,
    /// Scenario that the subproblems are taken from
    #[arg(value_name = "SCENARIO", default_value = "scenarios/fixed-wing/rendezvous-7.toml")]
    scenario: PathBuf,
    /// Folder for the results
    #[arg(short, long, value_name = "DIR", default_value = "out")]
    out: PathBuf,
    /// Smallest size only, two repetitions: to see that everything runs, not to compare
    #[arg(long)]
    quick: bool,
    /// Print nothing but errors; the files tell the rest
    #[arg(short, long)]
    quiet: bool,
}

const EXAMPLES: &str = "\
Examples:
  harness bench ipm            takes about a minute; close everything else before
  harness bench ipm --quick

Results:
  out/bench/ipm.json           one row per subproblem and backend
  out/bench/ipm.md             the same as a page";

/// What can be measured.
#[derive(Clone, Copy, Debug, ValueEnum)]
enum Name {
    /// The interior-point method and its backends
    Ipm,
}

impl Bench {
    /// Measures, prints and writes the table.
    pub fn execute(&self) -> Result<Exit, Error> {
        match self.name {
            Name::Ipm => self.ipm(&self.load()?),
        }
    }

    fn ipm(&self, scenario: &Scenario) -> Result<Exit, Error> {
        let plan = if self.quick { ipm::Plan::quick() } else { ipm::Plan::full() };
        let results = ipm::run(scenario, &plan, &mut |stage| {
            if !self.quiet {
                output::tell(&format!("{}: {stage}", scenario.name));
            }
        });
        let folder = self.out.join("bench");
        output::create_folder(&folder)?;
        output::write_json(&folder.join("ipm.json"), &results)?;
        output::write_file(&folder.join("ipm.md"), |writer| write!(writer, "{}", ipm::markdown(&results)))?;
        if self.quiet { Ok(()) } else { output::print(&ipm::text(&results)) }.map(|()| Exit::Passed)
    }

    fn load(&self) -> Result<Scenario, Error> {
        let scenario = scenarios::load(&self.scenario)?;
        match planners::scp::refuses(&scenario) {
            None => Ok(scenario),
            Some(reason) => {
                let file = self.scenario.display().to_string();
                Err(Error::Unfit { file, planner: planners::scp::parallel::PLANNER.name, reason })
            }
        }
    }
}
