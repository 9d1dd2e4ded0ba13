use std::path::PathBuf;

use clap::{Args, ValueEnum};
use planners::Planner;
use scenarios::Scenario;
use serde::Serialize;

use crate::bench::{ipm, slung};
use crate::error::{Error, Exit};
use crate::output;

/// Measure what a paper's table says, side by side with the baselines.
///
/// `ipm`: the interior-point method by our block sweep, by the paper's three ways to the Newton direction, and a general
/// solver (Clarabel), on subproblems of a run of the planner parallel-scp.
///
/// `slung`: the nonlinear programmes of the planner slung-lgr, by mesh and formulation.
#[derive(Args, Debug)]
#[command(after_help = EXAMPLES)]
pub struct Bench {
    /// What to measure
    #[arg(value_enum)]
    name: Name,
    /// Scenario that poses the problem; by default the one of the paper
    #[arg(value_name = "SCENARIO")]
    scenario: Option<PathBuf>,
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
  harness bench slung          takes about ten seconds

Results:
  out/bench/ipm.json           one row per subproblem and backend
  out/bench/ipm.md             the same as a page
  out/bench/slung.json, .md    one row per mesh and formulation";

/// What can be measured.
#[derive(Clone, Copy, Debug, ValueEnum)]
enum Name {
    /// The interior-point method and its backends
    Ipm,
    /// Collocation of the slung load
    Slung,
}

impl Name {
    fn paper_scenario(self) -> &'static str {
        match self {
            Self::Ipm => "scenarios/fixed-wing/rendezvous-7.toml",
            Self::Slung => "scenarios/slung/rectangle.toml",
        }
    }

    fn planner(self) -> &'static Planner {
        match self {
            Self::Ipm => &planners::scp::parallel::PLANNER,
            Self::Slung => &planners::slung::PLANNER,
        }
    }
}

impl Bench {
    /// Measures, prints and writes the table.
    pub fn execute(&self) -> Result<Exit, Error> {
        let scenario = self.load()?;
        let mut progress = |stage: &str| {
            if !self.quiet {
                output::tell(&format!("{}: {stage}", scenario.name));
            }
        };
        match self.name {
            Name::Ipm => {
                let plan = if self.quick { ipm::Plan::quick() } else { ipm::Plan::full() };
                let results = ipm::run(&scenario, &plan, &mut progress);
                self.publish("ipm", &results, &ipm::markdown(&results), &ipm::text(&results))
            }
            Name::Slung => {
                let plan = if self.quick { slung::Plan::quick() } else { slung::Plan::full() };
                let results = slung::run(&scenario, &plan, &mut progress);
                self.publish("slung", &results, &slung::markdown(&results), &slung::text(&results))
            }
        }
    }

    fn publish(&self, name: &str, results: &impl Serialize, page: &str, text: &str) -> Result<Exit, Error> {
        let folder = self.out.join("bench");
        output::create_folder(&folder)?;
        output::write_json(&folder.join(format!("{name}.json")), results)?;
        output::write_file(&folder.join(format!("{name}.md")), |writer| write!(writer, "{page}"))?;
        if self.quiet { Ok(()) } else { output::print(text) }.map(|()| Exit::Passed)
    }

    fn load(&self) -> Result<Scenario, Error> {
        let path = self.scenario.clone().unwrap_or_else(|| self.name.paper_scenario().into());
        let scenario = scenarios::load(&path)?;
        let planner = self.name.planner();
        match (planner.refuses)(&scenario) {
            None => Ok(scenario),
            Some(reason) => Err(Error::Unfit { file: path.display().to_string(), planner: planner.name, reason }),
        }
    }
}
