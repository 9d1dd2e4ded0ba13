//! `harness bench fleets`: decoupling methods, over fleets of several sizes, and the growth of the cost of fleet-scp
//! with the size of the fleet (Xu, Wang, Cao, Sun, Long 2022, figures 8 and 9, section 4).

mod comparison;
mod show;

use scenarios::Scenario;
use serde::Serialize;

use super::entry::{self, Entry, Outcome};
use super::geometry;
use crate::error::Error;
pub use comparison::Mean;
pub use show::{markdown, text};

/// The planners: those of the paper in its order, then fleet-scp.
const PLANNERS: [&str; 5] = ["coupled-scp", "serial-scp", "parallel-scp", "dpd-scp", FLEET_SCP];

/// The planner whose growth is measured.
const FLEET_SCP: &str = "fleet-scp";

/// What to measure.
#[derive(Clone, Debug)]
pub struct Plan {
    /// Scenarios and fleet sizes N: the first N vehicles of the scenario.
    pub missions: Vec<(Scenario, Vec<usize>)>,
    /// Number of geometries of each fleet, each with a seed of its own.
    pub geometries: usize,
    /// Scenario whose first n vehicles have the same density for every n, and the numbers n.
    pub growth: Option<(Scenario, Vec<usize>)>,
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
    /// One row per mission, size, geometry and planner.
    pub rows: Vec<Row>,
    /// Means over the geometries, one per mission, size and planner.
    pub means: Vec<Mean>,
    /// Rows of fleet-scp at constant density.
    pub growth: Vec<Row>,
}

/// One entry.
#[derive(Clone, Debug, Serialize)]
pub struct Row {
    /// Scenario that the vehicles come from.
    pub scenario: String,
    /// Number of its vehicles.
    pub vehicles: usize,
    /// Number of the geometry; 0 is that of the scenario.
    pub geometry: usize,
    /// The planner.
    pub planner: &'static str,
    /// Its outcome.
    #[serde(rename = "ending")]
    pub outcome: Outcome,
    /// The figures; `None` after a timeout.
    #[serde(flatten)]
    pub measured: Option<Measured>,
}

/// Figures of an entry. Distances are absent without a plan.
#[derive(Clone, Debug, Serialize)]
pub struct Measured {
    /// Status of the plan by the planner.
    pub status: scenarios::PlanStatus,
    /// Iterations.
    pub iterations: usize,
    /// Planning time, s.
    pub wall_s: f64,
    /// Sum over the iterations of the slowest vehicle's time, s.
    pub distributed_s: f64,
    /// Planning time per vehicle and iteration, s.
    pub per_vehicle_and_iteration_s: f64,
    /// Flight time, s.
    pub flight_time_s: Option<f64>,
    /// Smallest separation at the nodes, of the plan, in flight, m.
    pub separation_m: [Option<f64>; 3],
    /// Largest defect of an interval by the judge's integrator, m.
    pub defect_m: Option<f64>,
    /// End error of the open-loop rollout of the controls, m.
    pub rollout_m: Option<f64>,
    /// Simulation and judging, s.
    pub flight_and_verdict_s: f64,
}

impl Row {
    /// A planner that has reached its time limit in one geometry is not run in the others.
    fn is_timeout_of(&self, planner: &str) -> bool {
        self.planner == planner && self.outcome == Outcome::TimedOut
    }
}

/// Runs the benchmark.
///
/// - `progress`: receives a description of each entry
///
/// # Errors
///
/// [`Error::Bench`] if a process cannot be started or leaves no report.
pub fn run(plan: &Plan, progress: &mut dyn FnMut(&str)) -> Result<Results, Error> {
    let mut results = Results {
        schema: 1,
        limit_s: plan.limit_s,
        threads: rayon::current_num_threads(),
        rows: Vec::new(),
        means: Vec::new(),
        growth: Vec::new(),
    };
    for (scenario, sizes) in &plan.missions {
        for &vehicles in sizes {
            let first = results.rows.len();
            for number in 0..plan.geometries {
                for planner in PLANNERS {
                    let has_timed_out = results.rows[first..].iter().any(|row| row.is_timeout_of(planner));
                    if !has_timed_out {
                        results.rows.push(row(scenario, vehicles, number, planner, plan.limit_s, progress)?);
                    }
                }
            }
            results.means.extend(PLANNERS.map(|planner| Mean::of(planner, &results.rows[first..])));
        }
    }
    if let Some((scenario, sizes)) = &plan.growth {
        for &vehicles in sizes {
            results.growth.push(row(scenario, vehicles, 0, FLEET_SCP, plan.limit_s, progress)?);
        }
    }
    Ok(results)
}

fn row(
    scenario: &Scenario,
    vehicles: usize,
    number: usize,
    planner: &'static str,
    limit_s: f64,
    progress: &mut dyn FnMut(&str),
) -> Result<Row, Error> {
    progress(&format!("{planner} on {vehicles} vehicles of {}, geometry {number}", scenario.name));
    let mut fleet = scenario.clone();
    fleet.vehicles.truncate(vehicles);
    let fleet = geometry::variant(&fleet, number);
    let Entry { outcome, report } = entry::run(&fleet, planner, limit_s)?;
    let measured = report.map(|report| {
        let check = |name: &str| report.checks.iter().find(|check| check.name == name).and_then(|check| check.value);
        let of_plan = report.metrics.plan.as_ref();
        let in_flight = report.metrics.flight.as_ref();
        let rounds = report.plan.iterations.max(1) * vehicles;
        Measured {
            status: report.plan.status,
            iterations: report.plan.iterations,
            wall_s: report.plan.wall_s,
            distributed_s: report.plan.distributed_s,
            per_vehicle_and_iteration_s: report.plan.wall_s / rounds as f64,
            flight_time_s: report.plan.flight_time_s,
            separation_m: [
                of_plan.and_then(|plan| plan.at_nodes.separation_m),
                of_plan.and_then(|plan| plan.between_nodes.separation_m),
                in_flight.and_then(|flight| flight.distances.separation_m),
            ],
            defect_m: check("plan.dynamics"),
            rollout_m: check("plan.rollout"),
            flight_and_verdict_s: report.timings.flying_s + report.timings.judging_s,
        }
    });
    Ok(Row { scenario: scenario.name.clone(), vehicles, geometry: number, planner, outcome, measured })
}
