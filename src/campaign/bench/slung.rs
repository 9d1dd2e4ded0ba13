//! `harness bench slung`: the slung-load planner's nonlinear programmes by mesh and formulation, to their optima from a cold
//! start, on either side of the obstacles.

mod show;

use std::time::Instant;

use planners::slung::{self, CableMode, Candidate, Options, Problem, Route};
use rayon::prelude::*;
use scenarios::Scenario;
use serde::Serialize;

pub use show::{markdown, text};

/// What is measured.
#[derive(Clone, Debug)]
pub struct Plan {
    /// Fixed meshes: segments and points of each.
    pub meshes: Vec<(usize, usize)>,
    /// Repetitions of a solve, after one to warm up; the best counts.
    pub repetitions: usize,
}

impl Plan {
    /// The whole table.
    pub fn full() -> Self {
        Self { meshes: vec![(10, 3), (20, 3), (20, 4), (40, 4)], repetitions: 9 }
    }

    /// The smallest mesh and the refined one, to see that everything runs.
    pub fn quick() -> Self {
        Self { meshes: vec![(10, 3)], repetitions: 1 }
    }
}

/// Everything that was measured.
#[derive(Clone, Debug, Serialize)]
pub struct Results {
    /// Version of this form.
    pub schema: u32,
    /// Scenario that poses the problem.
    pub scenario: String,
    /// Repetitions of a solve; the best counts.
    pub repetitions: usize,
    /// Threads that solve the ways of a row.
    pub threads: usize,
    /// One row per mesh and formulation.
    pub rows: Vec<Row>,
}

/// A mesh and a formulation.
#[derive(Clone, Debug, Serialize)]
pub struct Row {
    /// `20 x 3`, or `refined`.
    pub mesh: String,
    /// `taut`, with the tension in closed form, or `complementarity`.
    pub formulation: &'static str,
    /// Time until all ways are solved, side by side, ms.
    pub all_ways_ms: f64,
    /// One by one.
    pub ways: Vec<Way>,
}

/// One way round the obstacles.
#[derive(Clone, Debug, Serialize)]
pub struct Way {
    /// Which one.
    pub name: String,
    /// Whether the optimality conditions hold, and the mesh is as fine as was asked for.
    pub is_solved: bool,
    /// Segments of the last mesh.
    pub segments: usize,
    /// Variables of the nonlinear programme on it.
    pub variables: usize,
    /// Newton steps on all meshes.
    pub iterations: usize,
    /// Meshes.
    pub meshes: usize,
    /// Best time, alone on one thread, ms.
    pub time_ms: f64,
    /// J.
    pub objective: f64,
    /// Largest error of the states between the nodes, relative to 1 + their size on the segment: the planned controls
    /// through the equations, by a rule of higher order.
    pub error_between_nodes: f64,
    /// Smallest distance of the envelope's circle from the obstacles, between the nodes too, m.
    pub clearance_m: f64,
}

/// Measures everything in `plan`; `progress` is told what comes next.
pub fn run(scenario: &Scenario, plan: &Plan, progress: &mut dyn FnMut(&str)) -> Results {
    let problem = slung::problem(scenario);
    let usual = Options { solver: slung::options(scenario).solver, ..Options::default() };
    let fixed = plan.meshes.iter().map(|&(segments, points)| {
        let options = Options { segments, points, is_graded: false, tolerances: None, ..usual.clone() };
        (format!("{segments} x {points}"), options)
    });
    let meshes: Vec<(String, Options)> = fixed.chain([("refined".to_owned(), usual.clone())]).collect();
    let mut rows = Vec::new();
    for (formulation, problem) in [("taut", problem.clone()), ("complementarity", free_tension(&problem))] {
        for (mesh, options) in &meshes {
            progress(&format!("measuring {mesh}, {formulation}"));
            rows.push(row(&problem, options, (mesh, formulation), plan.repetitions));
        }
    }
    let (scenario, repetitions) = (scenario.name.clone(), plan.repetitions);
    Results { schema: 1, scenario, repetitions, threads: rayon::current_num_threads(), rows }
}

/// The same problem with the tension as a control in all phases.
fn free_tension(problem: &Problem) -> Problem {
    let mut problem = problem.clone();
    for stage in &mut problem.phases {
        stage.mode = CableMode::COMPLEMENTARITY;
    }
    problem
}

fn row(problem: &Problem, options: &Options, (mesh, formulation): (&str, &'static str), repetitions: usize) -> Row {
    let routes = slung::candidate_routes(problem);
    let ways = routes.iter().map(|route| way(problem, route, options, repetitions)).collect();
    let all = || {
        let candidates: Vec<Candidate> =
            routes.par_iter().map(|route| slung::optimise(problem, route, options)).collect();
        candidates
    };
    let (_, all_ways_ms) = best(repetitions, all);
    Row { mesh: mesh.to_owned(), formulation, all_ways_ms, ways }
}

fn way(problem: &Problem, route: &Route, options: &Options, repetitions: usize) -> Way {
    let (candidate, time_ms) = best(repetitions, || slung::optimise(problem, route, options));
    let last = candidate.last();
    Way {
        name: slung::route_name(route, problem),
        is_solved: candidate.is_solved() && candidate.is_refined,
        segments: last.segments,
        variables: last.variables,
        iterations: candidate.mesh_iterations.iter().map(|round| round.iterations).sum(),
        meshes: candidate.mesh_iterations.len(),
        time_ms,
        objective: last.objective,
        error_between_nodes: last.quality.error,
        clearance_m: slung::envelope(problem, &candidate).clearance_m,
    }
}

/// What `solve` answers, and its best time after one run to warm up, ms.
fn best<T>(repetitions: usize, mut solve: impl FnMut() -> T) -> (T, f64) {
    let mut answer = solve();
    let mut best_ms = f64::INFINITY;
    for _ in 0..repetitions {
        let started = Instant::now();
        answer = solve();
        best_ms = best_ms.min(1e3 * started.elapsed().as_secs_f64());
    }
    (answer, best_ms)
}
