use std::path::{Path, PathBuf};

use clap::{Args, ValueEnum};
use planners::Planner;
use scenarios::Scenario;
use serde::Serialize;
use serde_json::json;

use super::bench_suite::SuiteArgs;
use crate::campaign::bench::{cooperative, fleets, horizon, ipm, slung, suite};
use crate::console;
use crate::error::{Error, Exit};
use crate::output;

/// Reproduce the tables of the papers, side by side with the baselines
///
/// `ipm`: interior-point methods on subproblems of the planner parallel-scp: the block-structured factorisation of the
/// harness, the paper's three methods for the Newton direction, and a general solver (Clarabel).
///
/// `cooperative`: fleets of one to seven aircraft on two missions, with both solvers and by the planner decoupled-lgr.
///
/// `fleets`: the papers' decoupling methods and fleet-scp, over several fleet sizes, and the growth of the cost of
/// fleet-scp with the size of the fleet.
///
/// `slung`: the nonlinear programs of the planner slung-lgr, by mesh and formulation.
///
/// `horizon`: the experiments of the paper on receding-horizon control with particle swarms, flown and judged, and a
/// comparison of samplers at equal budget.
///
/// `suite`: planners on random scenarios that are known to be feasible (`harness generate`): how many pass, why the others
/// do not, and what planning costs.
#[derive(Args, Debug)]
#[command(after_help = EXAMPLES)]
pub struct Bench {
    /// The benchmark
    #[arg(value_enum)]
    name: Name,
    /// Scenario file; for `cooperative`, `fleets` and `horizon` the folder of their scenarios [default: those of the papers]
    #[arg(value_name = "PATH")]
    path: Option<PathBuf>,
    /// Folder for the results
    #[arg(short, long, value_name = "DIR", default_value = "out")]
    out: PathBuf,
    /// Smallest size and two repetitions only (`suite`: four seeds): a smoke test, not a measurement
    #[arg(long)]
    quick: bool,
    /// Time limit of one entry of `cooperative` and `fleets`, or of one run of `suite`, s
    #[arg(long, value_name = "S", default_value_t = 120.0)]
    limit_s: f64,
    /// Number of geometries of each fleet of `fleets`, each with a seed of its own
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u32).range(1..))]
    geometries: u32,
    /// Experiment of `horizon` [default: all]
    #[arg(long, value_enum, value_name = "NAME")]
    experiment: Option<horizon::Experiment>,
    /// Print errors only
    #[arg(short, long)]
    quiet: bool,
    #[command(flatten)]
    suite: SuiteArgs,
}

const EXAMPLES: &str = "\
Examples:
  harness bench ipm            takes about a minute, on an otherwise idle machine
  harness bench ipm --quick
  harness bench cooperative    takes several minutes, most of them in Clarabel
  harness bench fleets         takes several minutes: some entries reach their time limit
  harness bench fleets --geometries 10
                               the same for ten geometries of each fleet, with means
  harness bench slung          takes about a minute
  harness bench horizon        takes several minutes
  harness bench horizon --experiment dynamic-map
  harness bench suite          takes about half an hour
  harness bench suite --family multirotor --seeds 5
  harness bench suite --kind forest --density 0.25 -p rhc -p sparse-astar

Results:
  out/bench/ipm.json           one row per subproblem and backend
  out/bench/ipm.md             the same as a page in Markdown
  out/bench/ipm.svg            operation counts (the paper's figure 4) and measured times
  out/bench/cooperative.json, .md  one row per mission, fleet and method
  out/bench/fleets.json, .md   one row per mission, fleet and planner
  out/bench/slung.json, .md    one row per mesh and formulation
  out/bench/horizon.json, .md  one row per case
  out/bench/suite.json, .md    one row per kind, size and planner
  out/bench/suite/*.toml       the scenarios that were not passed";

/// The benchmarks.
#[derive(Clone, Copy, Debug, ValueEnum)]
enum Name {
    /// Interior-point methods
    Ipm,
    /// Fleets of one to seven aircraft
    Cooperative,
    /// Decoupling methods for fleets
    Fleets,
    /// Collocation meshes of the slung load
    Slung,
    /// Receding-horizon control in the loop
    Horizon,
    /// Random scenarios
    Suite,
}

impl Bench {
    /// Measures, prints and writes the results.
    pub fn execute(&self) -> Result<Exit, Error> {
        self.check_options()?;
        match self.name {
            Name::Ipm => self.ipm(),
            Name::Cooperative => self.cooperative(),
            Name::Fleets => self.fleets(),
            Name::Slung => self.slung(),
            Name::Horizon => self.horizon(),
            Name::Suite => self.suite(),
        }
    }

    /// `suite` and the other benchmarks have different options.
    fn check_options(&self) -> Result<(), Error> {
        let misplaced = match (self.name, &self.path) {
            (Name::Suite, Some(path)) => Some(path.display().to_string()),
            (Name::Suite, None) => None,
            _ => self.suite.first_given().map(str::to_owned),
        };
        misplaced.map_or(Ok(()), |found| Err(Error::BenchOption { found }))
    }

    fn ipm(&self) -> Result<Exit, Error> {
        let scenario = self.scenario("shipped:rendezvous-7", &planners::scp::parallel::PLANNER)?;
        let plan = if self.quick { ipm::Plan::quick() } else { ipm::Plan::full() };
        let results = ipm::run(&scenario, &plan, &mut |stage| self.tell(&format!("{}: {stage}", scenario.name)));
        self.publish("ipm", &results, &ipm::markdown(&results), &ipm::text(&results))?;
        output::write_file(&self.out.join("bench/ipm.svg"), |writer| write!(writer, "{}", ipm::svg(&results)))?;
        Ok(Exit::Passed)
    }

    fn slung(&self) -> Result<Exit, Error> {
        let scenario = self.scenario("shipped:rectangle", &planners::slung::PLANNER)?;
        let plan = if self.quick { slung::Plan::quick() } else { slung::Plan::full() };
        let results = slung::run(&scenario, &plan, &mut |stage| self.tell(&format!("{}: {stage}", scenario.name)));
        self.publish("slung", &results, &slung::markdown(&results), &slung::text(&results))
    }

    fn horizon(&self) -> Result<Exit, Error> {
        let plan = horizon::Plan {
            paper_map: self.multirotor("paper-map")?,
            trap: self.multirotor("trap")?,
            pop_up: self.multirotor("pop-up")?,
            seeds: if self.quick { 2 } else { 20 },
            experiment: self.experiment,
        };
        let results = horizon::run(&plan, &mut |case| self.tell(case));
        self.publish("horizon", &results, &horizon::markdown(&results), &horizon::text(&results))
    }

    fn cooperative(&self) -> Result<Exit, Error> {
        let missions = ["rendezvous-7", "reconfiguration-7"].map(|name| self.fleet(name));
        let plan = cooperative::Plan {
            missions: missions.into_iter().collect::<Result<_, _>>()?,
            sizes: if self.quick { vec![1, 2] } else { (1..=7).collect() },
            limit_s: self.limit_s,
        };
        let results = cooperative::run(&plan, &mut |entry| self.tell(entry))?;
        self.publish("cooperative", &results, &cooperative::markdown(&results), &cooperative::text(&results))
    }

    fn fleets(&self) -> Result<Exit, Error> {
        let (rendezvous, limit_s) = (self.fleet("rendezvous-15")?, self.limit_s);
        let geometries = self.geometries as usize;
        let plan = if self.quick {
            fleets::Plan { missions: vec![(rendezvous, vec![2])], geometries, growth: None, limit_s }
        } else {
            let missions = vec![(rendezvous, vec![5, 7, 10, 15]), (self.fleet("exchange-100")?, vec![100])];
            let growth = Some((self.fleet("traffic-1000")?, vec![10, 30, 100, 300, 1000]));
            fleets::Plan { missions, geometries, growth, limit_s }
        };
        let results = fleets::run(&plan, &mut |entry| self.tell(entry))?;
        self.publish("fleets", &results, &fleets::markdown(&results), &fleets::text(&results))
    }

    fn suite(&self) -> Result<Exit, Error> {
        let plan = self.suite.plan(self.quick, self.limit_s, &self.out.join("bench/suite"))?;
        let results = suite::run(&plan, &mut |line| self.tell(line))?;
        let text = if self.suite.json { format!("{:#}", json!(results)) } else { suite::text(&results) };
        self.publish("suite", &results, &suite::markdown(&results), &text)
    }

    /// The scenario of a benchmark of one planner.
    fn scenario(&self, default: &str, planner: &Planner) -> Result<Scenario, Error> {
        load(self.path.as_deref().unwrap_or(Path::new(default)), planner)
    }

    /// A fleet from the folder of scenarios.
    fn fleet(&self, name: &str) -> Result<Scenario, Error> {
        let folder = self.path.as_deref().unwrap_or(Path::new("shipped:fixed-wing"));
        load(&folder.join(format!("{name}.toml")), &planners::scp::parallel::PLANNER)
    }

    /// A multirotor scenario from the folder of scenarios.
    fn multirotor(&self, name: &str) -> Result<Scenario, Error> {
        let folder = self.path.as_deref().unwrap_or(Path::new("shipped:multirotor"));
        load(&folder.join(format!("{name}.toml")), &planners::horizon::RHC)
    }

    fn tell(&self, stage: &str) {
        if !self.quiet {
            console::eprint(stage);
        }
    }

    fn publish(&self, name: &str, results: &impl Serialize, page: &str, text: &str) -> Result<Exit, Error> {
        let folder = self.out.join("bench");
        output::create_folder(&folder)?;
        output::write_json(&folder.join(format!("{name}.json")), results)?;
        output::write_file(&folder.join(format!("{name}.md")), |writer| write!(writer, "{page}"))?;
        if self.quiet { Ok(()) } else { console::print(text) }.map(|()| Exit::Passed)
    }
}

fn load(file: &Path, planner: &Planner) -> Result<Scenario, Error> {
    let scenario = scenarios::load(file)?;
    match (planner.unsupported_reason)(&scenario) {
        None => Ok(scenario),
        Some(reason) => Err(Error::Unfit { file: file.display().to_string(), planner: planner.name, reason }),
    }
}
