//! `harness bench horizon`: the five experiments of the paper on RHC-FPSO in the simulator, and samplers at equal budget.

mod cases;
mod show;

use planners::free_space::{FreeSpace, Point};
use scenarios::Scenario;
use serde::Serialize;
use sim::{Flight, Replan};

pub use cases::{Case, Experiment};
pub use show::{markdown, text};

use crate::metrics;
use crate::plan_source::{Flown, PlanSource};
use crate::statistics::mean;
use crate::verdict;

/// What to measure.
#[derive(Clone, Debug)]
pub struct Plan {
    /// The paper's map, known from the start.
    pub paper_map: Scenario,
    /// A map with a concave obstacle.
    pub trap: Scenario,
    /// A map on which obstacles appear.
    pub pop_up: Scenario,
    /// Flights of every case, each with a seed of its own.
    pub seeds: u64,
    /// The experiment; `None`: all.
    pub experiment: Option<Experiment>,
}

/// The results.
#[derive(Clone, Debug, Serialize)]
pub struct Results {
    /// Version of this format.
    pub schema: u32,
    /// Flights of every row.
    pub seeds: u64,
    /// Number of worker threads.
    pub threads: usize,
    /// One row per case.
    pub rows: Vec<Row>,
}

/// One case: means over all seeds unless stated otherwise. Figures that could not be measured are absent.
#[derive(Clone, Debug, Serialize)]
pub struct Row {
    /// The experiment.
    pub experiment: Experiment,
    /// Scenario.
    pub scenario: String,
    /// Name of the case.
    pub case: &'static str,
    /// Flights that passed every check.
    pub passed: u64,
    /// Flights in which speed and acceleration kept their limits.
    pub within_limits: u64,
    /// Flight time of those that passed, s.
    pub flight_time_s: Option<f64>,
    /// Length of the flown path of those that passed, m.
    pub path_m: Option<f64>,
    /// Smallest distance between body and obstacles or map bounds, over all flights, m.
    pub clearance_m: Option<f64>,
    /// The same distance, mean over time, m.
    pub mean_clearance_m: Option<f64>,
    /// Figures of planning in the loop.
    pub in_loop: Option<InLoop>,
}

/// How planning in the loop went.
#[derive(Clone, Debug, Serialize)]
pub struct InLoop {
    /// Time per replan: mean over all flights, smallest and largest mean of a flight, s.
    pub replan_s: [f64; 3],
    /// Shortest and longest single replan of all flights, s.
    pub single_replan_s: [f64; 2],
    /// Iterations per replan.
    pub iterations: f64,
    /// First iteration with a feasible particle, from 0.
    pub first_feasible: Option<f64>,
    /// Fraction of feasible particles.
    pub feasible: Option<f64>,
    /// Fraction of replans without a feasible particle.
    pub empty: f64,
    /// Stability by eq. 22, m/s².
    pub stability_mps2: f64,
}

/// Runs the benchmark.
///
/// - `progress`: receives a description of each entry
///
/// All cases fly once per seed in turn, so that a change of the machine's speed affects all of them.
pub fn run(plan: &Plan, progress: &mut dyn FnMut(&str)) -> Results {
    let cases = cases::selected(plan);
    let mut flown: Vec<Vec<CaseFlight>> = cases.iter().map(|_| Vec::new()).collect();
    for seed in 0..plan.seeds {
        for (case, flown) in cases.iter().zip(&mut flown) {
            progress(&format!("{}: {} on {}, seed {seed}", case.experiment.name(), case.name, case.scenario.name));
            flown.push(CaseFlight::by(case, seed));
        }
    }
    let rows = cases.iter().zip(&flown).map(|(case, flown)| row(case, flown)).collect();
    Results { schema: 1, seeds: plan.seeds, threads: rayon::current_num_threads(), rows }
}

fn row(case: &Case, flown: &[CaseFlight]) -> Row {
    let passed = || flown.iter().filter(|flown| flown.has_passed);
    let count = |is_such: fn(&CaseFlight) -> bool| flown.iter().filter(|flown| is_such(flown)).count() as u64;
    Row {
        experiment: case.experiment,
        scenario: case.scenario.name.clone(),
        case: case.name,
        passed: count(|flown| flown.has_passed),
        within_limits: count(|flown| flown.is_within_limits),
        flight_time_s: mean(passed().filter_map(|flown| flown.flight_time_s)),
        path_m: mean(passed().filter_map(|flown| flown.path_m)),
        clearance_m: flown.iter().filter_map(|flown| flown.clearance_m).reduce(f64::min),
        mean_clearance_m: mean(flown.iter().filter_map(|flown| flown.mean_clearance_m)),
        in_loop: in_loop_figures(flown),
    }
}

/// One flight.
struct CaseFlight {
    has_passed: bool,
    is_within_limits: bool,
    flight_time_s: Option<f64>,
    path_m: Option<f64>,
    clearance_m: Option<f64>,
    mean_clearance_m: Option<f64>,
    replans: Vec<Replan>,
}

impl CaseFlight {
    fn by(case: &Case, seed: u64) -> Self {
        let scenario = &case.scenario;
        let flown = PlanSource::Registered(case.planner).fly(scenario, seed);
        let verdict = flown.judge(scenario);
        let Flown { answer, flight } = flown;
        let measured = metrics::measure(scenario, &answer.plan, flight.as_ref()).flight;
        let is_limit =
            |check: &&verdict::Check| check.name.ends_with("state_limits") || check.name.ends_with("control_limits");
        Self {
            has_passed: verdict.outcome == verdict::Outcome::Pass,
            is_within_limits: flight.is_some() && !verdict.checks.iter().filter(is_limit).any(verdict::Check::is_bad),
            flight_time_s: measured.as_ref().and_then(|measured| measured.flight_time_s),
            path_m: flight.as_ref().map(path_m),
            clearance_m: measured.as_ref().and_then(|measured| measured.distances.clearance_m),
            mean_clearance_m: flight.as_ref().and_then(|flight| mean_clearance_m(scenario, flight)),
            replans: flight.and_then(|flight| flight.planning).map_or_else(Vec::new, |planning| planning.replans),
        }
    }
}

fn path_m(flight: &Flight) -> f64 {
    let steps = flight.vehicles.iter().flat_map(|vehicle| vehicle.samples.windows(2));
    steps.map(|ends| (Point::from(ends[0].position_m) - Point::from(ends[1].position_m)).norm()).sum()
}

/// Distance between bodies and static obstacles, mean over the samples, m.
fn mean_clearance_m(scenario: &Scenario, flight: &Flight) -> Option<f64> {
    let space = FreeSpace::from_world(&scenario.world, scenario.is_planar());
    let distances = flight.vehicles.iter().zip(&scenario.vehicles).flat_map(|(log, vehicle)| {
        let radius_m = scenario.multirotor_model(vehicle).body_radius_m;
        let space = &space;
        log.samples.iter().map(move |sample| space.distance_m(sample.position_m.into()) - radius_m)
    });
    mean(distances)
}

fn in_loop_figures(flown: &[CaseFlight]) -> Option<InLoop> {
    let replans = || flown.iter().flat_map(|flown| &flown.replans);
    let of_flights = || flown.iter().filter_map(|flown| mean(flown.replans.iter().map(|replan| replan.wall_s)));
    let is_empty = |replan: &Replan| f64::from(u8::from(replan.diagnostics.cost.is_none()));
    Some(InLoop {
        replan_s: [
            mean(replans().map(|replan| replan.wall_s))?,
            of_flights().fold(f64::INFINITY, f64::min),
            of_flights().fold(0.0, f64::max),
        ],
        single_replan_s: [
            replans().map(|replan| replan.wall_s).fold(f64::INFINITY, f64::min),
            replans().map(|replan| replan.wall_s).fold(0.0, f64::max),
        ],
        iterations: mean(replans().map(|replan| replan.diagnostics.iterations as f64))?,
        first_feasible: mean(
            replans().filter_map(|replan| replan.diagnostics.first_feasible).map(|iteration| iteration as f64),
        ),
        feasible: mean(replans().filter_map(|replan| replan.diagnostics.feasible_fraction)),
        empty: mean(replans().map(is_empty))?,
        stability_mps2: mean(flown.iter().flat_map(|flown| changes_mps2(&flown.replans)))?,
    })
}

/// |u(.|k) - u(.|k+1)| of eq. 22: how much the planned controls differ from one replan to the next, step by step.
fn changes_mps2(replans: &[Replan]) -> Vec<f64> {
    let planned: Vec<Vec<[f64; 3]>> = replans.iter().map(accelerations_mps2).filter(|all| !all.is_empty()).collect();
    let difference = |ends: &[Vec<[f64; 3]>]| {
        let pairs = ends[0].iter().zip(&ends[1]);
        pairs.map(|(a, b)| (0..3).map(|axis| (a[axis] - b[axis]).powi(2)).sum::<f64>()).sum::<f64>().sqrt()
    };
    planned.windows(2).map(difference).collect()
}

fn accelerations_mps2(replan: &Replan) -> Vec<[f64; 3]> {
    let between = |ends: &[scenarios::in_loop::Node]| {
        let time_s = ends[1].t_s - ends[0].t_s;
        std::array::from_fn(|axis| (ends[1].velocity_mps[axis] - ends[0].velocity_mps[axis]) / time_s)
    };
    replan.nodes.windows(2).map(between).collect()
}
