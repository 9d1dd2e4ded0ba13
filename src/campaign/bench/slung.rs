//! `harness bench slung`: the nonlinear programs of the slung-load planner by mesh and formulation, solved from a cold start
//! on every route round the obstacles.

mod show;

use std::time::Instant;

use planners::slung::{self, Avoidance, CableMode, Candidate, Options, Problem, Route, TorqueModel};
use rayon::prelude::*;
use scenarios::Scenario;
use serde::Serialize;

pub use show::{markdown, text};

/// Time after which a solve is not repeated, s.
pub const REPEATING_S: f64 = 0.5;

/// What to measure.
#[derive(Clone, Debug)]
pub struct Plan {
    /// Fixed meshes: numbers of segments and of collocation points per segment.
    pub meshes: Vec<(usize, usize)>,
    /// Repetitions of a solve, as many as [`REPEATING_S`] admits; the fastest counts.
    pub repetitions: usize,
}

impl Plan {
    /// The whole table.
    pub fn full() -> Self {
        Self { meshes: vec![(10, 3), (20, 3), (20, 4), (40, 4)], repetitions: 9 }
    }

    /// The smallest mesh and the refined one, as a smoke test.
    pub fn quick() -> Self {
        Self { meshes: vec![(10, 3)], repetitions: 1 }
    }
}

/// The results.
#[derive(Clone, Debug, Serialize)]
pub struct Results {
    /// Version of this format.
    pub schema: u32,
    /// Scenario that poses the problem.
    pub scenario: String,
    /// Most repetitions of a solve; the fastest counts.
    pub repetitions: usize,
    /// Number of worker threads.
    pub threads: usize,
    /// One row per mesh and formulation.
    pub rows: Vec<Row>,
}

/// A mesh and a formulation.
#[derive(Clone, Debug, Serialize)]
pub struct Row {
    /// `20 x 3`, or `refined`.
    pub mesh: String,
    /// `taut`, with the tension in closed form, `complementarity`, or `taut` with one change: `r-function`, `parts`,
    /// `generalised torques`.
    pub formulation: &'static str,
    /// Time to solve all routes in parallel, ms.
    pub all_ways_ms: f64,
    /// The routes, solved one by one.
    pub ways: Vec<RouteResult>,
}

/// One route round the obstacles.
#[derive(Clone, Debug, Serialize)]
pub struct RouteResult {
    /// Name of the route.
    pub name: String,
    /// Whether the optimality conditions hold and the mesh meets its tolerances.
    pub is_solved: bool,
    /// Segments of the last mesh.
    pub segments: usize,
    /// Variables of the nonlinear program on the last mesh.
    pub variables: usize,
    /// Newton steps on all meshes.
    pub iterations: usize,
    /// Meshes.
    pub meshes: usize,
    /// Shortest time on one thread, ms.
    pub time_ms: f64,
    /// Objective J.
    pub objective: f64,
    /// Largest relative error of the states between the nodes, with respect to an integration of the controls by a
    /// higher-order rule; relative to 1 + the magnitude of the state on the segment.
    pub error_between_nodes: f64,
    /// Smallest distance between the envelope circle and the obstacles, between the nodes as well, m.
    pub clearance_m: f64,
    /// Instants at which the radius of the envelope circle switches, s (Kang, Huang, Wen 2020, eq. 14).
    pub switches_s: Vec<f64>,
    /// Instants at which its bound by R-functions switches, s (eq. 19).
    pub r_function_switches_s: Vec<f64>,
}

/// Runs the benchmark.
///
/// - `progress`: receives a description of each entry
pub fn run(scenario: &Scenario, plan: &Plan, progress: &mut dyn FnMut(&str)) -> Results {
    let problem = slung::problem(scenario);
    let usual = Options { solver: slung::options(scenario).solver, ..Options::default() };
    let fixed = plan.meshes.iter().map(|&(segments, points)| {
        let options = Options { segments, points, is_graded: false, tolerances: None, ..usual.clone() };
        (format!("{segments} x {points}"), options)
    });
    let meshes: Vec<(String, Options)> = fixed.chain([("refined".to_owned(), usual.clone())]).collect();
    let mut rows = Vec::new();
    for (formulation, problem) in formulations(&problem) {
        for (mesh, options) in &meshes {
            progress(&format!("measuring {mesh}, {formulation}"));
            rows.push(row(&problem, options, (mesh, formulation), plan.repetitions));
        }
    }
    let (scenario, repetitions) = (scenario.name.clone(), plan.repetitions);
    Results { schema: 1, scenario, repetitions, threads: rayon::current_num_threads(), rows }
}

/// The problem in every formulation.
fn formulations(problem: &Problem) -> [(&'static str, Problem); 5] {
    let avoiding = |avoidance| Problem { avoidance, ..problem.clone() };
    [
        ("taut", problem.clone()),
        ("complementarity", free_tension(problem)),
        ("r-function", avoiding(Avoidance::RFunction)),
        ("parts", avoiding(Avoidance::Parts)),
        ("generalised torques", Problem { torques: TorqueModel::Generalised, ..problem.clone() }),
    ]
}

/// The same problem with the tension as a control in all phases.
fn free_tension(problem: &Problem) -> Problem {
    let mut problem = problem.clone();
    for phase in &mut problem.phases {
        phase.mode = CableMode::COMPLEMENTARITY;
    }
    problem
}

fn row(problem: &Problem, options: &Options, (mesh, formulation): (&str, &'static str), repetitions: usize) -> Row {
    let routes = slung::candidate_routes(problem);
    let ways = routes.iter().map(|route| route_result(problem, route, options, repetitions)).collect();
    let all = || {
        let candidates: Vec<Candidate> =
            routes.par_iter().map(|route| slung::optimise(problem, route, options)).collect();
        candidates
    };
    let (_, all_ways_ms) = fastest(repetitions, all);
    Row { mesh: mesh.to_owned(), formulation, all_ways_ms, ways }
}

fn route_result(problem: &Problem, route: &Route, options: &Options, repetitions: usize) -> RouteResult {
    let (candidate, time_ms) = fastest(repetitions, || slung::optimise(problem, route, options));
    let last = candidate.last();
    let envelope = slung::envelope(problem, &candidate);
    let instants = |switches: &[(f64, bool)]| switches.iter().map(|(at_s, _)| *at_s).collect();
    RouteResult {
        name: slung::route_name(route, problem),
        is_solved: candidate.is_solved() && candidate.is_refined,
        segments: last.segments,
        variables: last.variables,
        iterations: candidate.mesh_iterations.iter().map(|round| round.iterations).sum(),
        meshes: candidate.mesh_iterations.len(),
        time_ms,
        objective: last.objective,
        error_between_nodes: last.quality.error,
        clearance_m: envelope.clearance_m,
        switches_s: instants(&envelope.switches),
        r_function_switches_s: instants(&envelope.r_function_switches),
    }
}

/// The result of `solve` and its shortest time, ms: of the first solve and of as many more as [`REPEATING_S`] admits.
fn fastest<T>(repetitions: usize, mut solve: impl FnMut() -> T) -> (T, f64) {
    let started = Instant::now();
    let mut timed = || {
        let started = Instant::now();
        let answer = solve();
        (answer, 1e3 * started.elapsed().as_secs_f64())
    };
    let (mut answer, mut shortest_ms) = timed();
    for _ in 0..repetitions {
        if started.elapsed().as_secs_f64() > REPEATING_S {
            break;
        }
        let (repeated, time_ms) = timed();
        (answer, shortest_ms) = (repeated, shortest_ms.min(time_ms));
    }
    (answer, shortest_ms)
}
