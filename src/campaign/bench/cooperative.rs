//! `harness bench cooperative`: fleets of one to seven on two missions, with the block interior-point method, with a general
//! solver, and by the decoupled pseudospectral planner (Wang, Xu, Long 2020, section 5, figures 11 to 18).

mod show;

use planners::scp::parallel::PLANNER;
use scenarios::{PlannerSettings, Scenario, Solver};
use serde::Serialize;

use super::entry::{self, Entry, Outcome};
use crate::error::Error;
use crate::metrics::PlanMetrics;
use crate::statistics;
pub use show::{markdown, text};

/// A planner with a solver.
#[derive(Clone, Copy)]
struct Method {
    /// Its name in the tables.
    name: &'static str,
    planner: &'static str,
    /// Solver of the subproblems; `None`: the planner's own.
    solver: Option<Solver>,
}

/// Name of the method to whose planning time the others are compared.
const BASELINE: &str = "clarabel";

/// The methods.
const METHODS: [Method; 3] = [
    Method { name: "block", planner: PLANNER.name, solver: Some(Solver::Block) },
    Method { name: BASELINE, planner: PLANNER.name, solver: Some(Solver::Clarabel) },
    Method { name: "decoupled-lgr", planner: "decoupled-lgr", solver: None },
];

/// What to measure.
#[derive(Clone, Debug)]
pub struct Plan {
    /// The missions with their largest fleet; a smaller fleet is its first vehicles.
    pub missions: Vec<Scenario>,
    /// Fleet sizes.
    pub sizes: Vec<usize>,
    /// Time limit of an entry, s.
    pub limit_s: f64,
}

/// The results.
#[derive(Clone, Debug, Serialize)]
pub struct Results {
    /// Version of this format.
    pub schema: u32,
    /// Time limit of an entry, s.
    pub limit_s: f64,
    /// Number of worker threads.
    pub threads: usize,
    /// One row per mission, size and solver.
    pub rows: Vec<Row>,
    /// Means over the sizes, one per mission and solver.
    pub means: Vec<Mean>,
}

/// One fleet with one solver.
#[derive(Clone, Debug, Serialize)]
pub struct Row {
    /// Scenario that the vehicles come from.
    pub mission: String,
    /// Number of its vehicles.
    pub vehicles: usize,
    /// Solver of the subproblems, or the planner that has none.
    pub solver: &'static str,
    /// Its outcome.
    #[serde(rename = "ending")]
    pub outcome: Outcome,
    /// Iterations of the planner.
    pub iterations: Option<usize>,
    /// Planning time, s.
    pub planning_s: Option<f64>,
    /// The paper's figures.
    pub metrics: Option<PlanMetrics>,
}

/// Means over the fleets that have a plan.
#[derive(Clone, Debug, Serialize)]
pub struct Mean {
    /// Mission.
    pub mission: String,
    /// Solver.
    pub solver: &'static str,
    /// Mean flight time, s.
    pub flight_time_s: Option<f64>,
    /// Mean planning time, s.
    pub planning_s: Option<f64>,
    /// Ratio of Clarabel's planning time to this one, mean over the sizes.
    pub speedup: Option<f64>,
}

/// Runs the benchmark.
///
/// - `progress`: receives a description of each entry
///
/// # Errors
///
/// [`Error::Bench`] if a process cannot be started or leaves no report.
pub fn run(plan: &Plan, progress: &mut dyn FnMut(&str)) -> Result<Results, Error> {
    let mut rows = Vec::new();
    for mission in &plan.missions {
        for &vehicles in &plan.sizes {
            for method in METHODS {
                progress(&format!("{vehicles} vehicles of {} with {}", mission.name, method.name));
                rows.push(row(mission, vehicles, method, plan.limit_s)?);
            }
        }
    }
    let means = plan.missions.iter().flat_map(|mission| METHODS.map(|method| mean(&rows, &mission.name, method.name)));
    let means = means.collect();
    Ok(Results { schema: 1, limit_s: plan.limit_s, threads: rayon::current_num_threads(), rows, means })
}

fn row(mission: &Scenario, vehicles: usize, method: Method, limit_s: f64) -> Result<Row, Error> {
    let mut fleet = mission.clone();
    fleet.vehicles.truncate(vehicles);
    // All other settings are defaults, which are the paper's.
    let Method { name, planner, solver } = method;
    fleet.planner = PlannerSettings { name: planner.to_owned(), solver, ..PlannerSettings::default() };
    let Entry { outcome, report } = entry::run(&fleet, planner, limit_s)?;
    Ok(Row {
        mission: mission.name.clone(),
        vehicles,
        solver: name,
        outcome,
        iterations: report.as_ref().map(|report| report.plan.iterations),
        planning_s: report.as_ref().map(|report| report.plan.wall_s),
        metrics: report.and_then(|report| report.metrics.plan),
    })
}

fn mean(rows: &[Row], mission: &str, solver: &'static str) -> Mean {
    let own: Vec<&Row> = rows.iter().filter(|row| row.mission == mission && row.solver == solver).collect();
    let baseline = |own: &Row| {
        let other = rows
            .iter()
            .find(|row| row.mission == own.mission && row.vehicles == own.vehicles && row.solver == BASELINE);
        other.and_then(|other| Some(other.planning_s? / own.planning_s?))
    };
    Mean {
        mission: mission.to_owned(),
        solver,
        flight_time_s: statistics::mean(own.iter().filter_map(|row| row.metrics.as_ref()?.flight_time_s)),
        planning_s: statistics::mean(own.iter().filter_map(|row| row.planning_s)),
        speedup: statistics::mean(own.iter().filter_map(|row| baseline(row))),
    }
}
