//! Optimisation along one route: solve on the first mesh, refine the mesh, and solve again from a warm start.

use std::time::Instant;

use super::guess::Guess;
use super::initial_iterate::initial_iterate;
use super::problem::Problem;
use super::route::Route;
use super::system::SlungLoadSystem;
use crate::nlp::{InteriorPoint, Settings, Solution, Start, Status, WarmStart};
use crate::pseudospectral::{Mesh, Quality, Tolerances, Transcription, refine, segment_qualities};

/// Solver tolerance on meshes that are expected to be refined, relative to the cost of hovering.
const COARSE_TOLERANCE: f64 = 5e-6;

/// Minimum number of segments of a phase.
const MIN_SEGMENTS: usize = 4;

/// Initial barrier parameter of warm starts, relative to the cost of hovering.
const WARM_BARRIER: f64 = 4.5e-7;

/// Bound push under complementarity. With a larger one the cable starts markedly shorter than its full length, and the
/// method finds a local minimum with a slack phase at the start.
const COMPLEMENTARITY_BOUND_PUSH: f64 = 1e-4;

/// Options of the optimisation.
#[derive(Clone, Debug, PartialEq)]
pub struct Options {
    /// Segments of the first mesh, distributed over the phases in proportion to their durations.
    pub segments: usize,
    /// Collocation points per segment of the first mesh.
    pub points: usize,
    /// Whether the segments are shorter near the ends of a phase; otherwise they are equal.
    pub is_graded: bool,
    /// Tolerances of mesh refinement; without them the first mesh is kept.
    pub tolerances: Option<Tolerances>,
    /// Maximum number of meshes.
    pub max_meshes: usize,
    /// Settings of the interior-point method.
    pub solver: Settings,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            segments: 16,
            points: 5,
            is_graded: true,
            tolerances: Some(Tolerances { error: 1e-4, violation: 5e-4, overshoot: 0.1, max_order: 8 }),
            max_meshes: 12,
            solver: Settings { tolerance: 1e-6, ..Settings::default() },
        }
    }
}

/// Result on one mesh.
#[derive(Clone, Debug, PartialEq)]
pub struct MeshIteration {
    /// Number of segments.
    pub segments: usize,
    /// Number of collocation points.
    pub nodes: usize,
    /// Number of variables.
    pub variables: usize,
    /// Status of the interior-point method.
    pub status: Status,
    /// Number of Newton steps.
    pub iterations: usize,
    /// Objective.
    pub objective: f64,
    /// Largest constraint violation at the nodes.
    pub violation: f64,
    /// Largest errors between the nodes, over all segments.
    pub quality: Quality,
    /// Maximum time between two nodes, s.
    pub max_interval_s: f64,
    /// Wall time, s.
    pub wall_s: f64,
}

/// The result of the optimisation along a route.
#[derive(Clone, Debug)]
pub struct Candidate<'a> {
    /// The route.
    pub route: &'a Route,
    /// Results by mesh.
    pub mesh_iterations: Vec<MeshIteration>,
    /// The last mesh.
    pub mesh: Mesh,
    /// Variables on the last mesh.
    pub x: Vec<f64>,
    /// Whether the last mesh meets the tolerances; true if there are none.
    pub is_refined: bool,
}

impl Candidate<'_> {
    /// The result on the last mesh.
    pub fn last(&self) -> &MeshIteration {
        &self.mesh_iterations[self.mesh_iterations.len() - 1]
    }

    /// Whether the last program was solved.
    pub fn is_solved(&self) -> bool {
        self.last().status == Status::Solved
    }
}

/// Solves `problem` along `route`.
///
/// # Examples
///
/// ```
/// use planners::slung::{Options, Problem, candidate_routes, optimise};
///
/// let problem = Problem::paper();
/// let routes = candidate_routes(&problem);
/// let candidate = optimise(&problem, &routes[0], &Options::default());
/// assert!(candidate.is_solved() && candidate.is_refined);
/// assert!((candidate.last().objective - 2433.8).abs() < 0.15);
/// ```
pub fn optimise<'a>(problem: &Problem, route: &'a Route, options: &Options) -> Candidate<'a> {
    let system = SlungLoadSystem::new(problem);
    let guess = Guess::new(problem, route, system.coordinates);
    let cost = problem.hover_cost(guess.durations_s().iter().sum());
    let mut mesh = first_mesh(&guess, options);
    let mut start: Option<(Transcription, WarmStart)> = None;
    let mut mesh_iterations: Vec<MeshIteration> = Vec::new();
    let has_complementarity = problem.has_complementarity();
    // a mesh that meets the tolerances with a rough solution is solved once more
    let mut is_rough = options.tolerances.is_some() && !has_complementarity;
    loop {
        let begin = Instant::now();
        let mut program = Transcription::new(&system, mesh.clone());
        let settings = settings(problem, options, cost, (start.is_none(), is_rough));
        let from = match &start {
            None => Start::Cold(initial_iterate(problem, &guess, &program, settings)),
            Some((coarse, solution)) => {
                let transferred = coarse.transfer(solution, &program);
                // slacks of order ε and multipliers of order 1/ε do not transfer between meshes
                if has_complementarity { Start::Cold(transferred.x) } else { Start::Warm(transferred) }
            }
        };
        let mut method = InteriorPoint::new(&program, settings);
        let solution = method.solve(&mut program, &from);
        mesh_iterations.push(mesh_iteration(&program, &method, &solution, begin));
        let solved = options.tolerances.filter(|_| solution.status == Status::Solved);
        let finer = solved.and_then(|tolerances| refine(&program, method.x(), &tolerances));
        let is_last = mesh_iterations.len() == options.max_meshes || solution.status != Status::Solved;
        if is_last || (finer.is_none() && !is_rough) {
            let is_refined = finer.is_none() && !is_rough && solution.status == Status::Solved;
            return Candidate { route, mesh_iterations, mesh, x: method.x().to_vec(), is_refined };
        }
        is_rough = false;
        mesh = finer.unwrap_or(mesh);
        start = Some((program, method.warm_start()));
    }
}

/// Solver settings on a mesh: a coarse tolerance if another mesh will follow, a small initial barrier parameter if it
/// is not the first.
fn settings(problem: &Problem, options: &Options, cost: f64, (is_first, is_rough): (bool, bool)) -> Settings {
    let mut settings = options.solver;
    if is_rough {
        settings.tolerance = settings.tolerance.max(COARSE_TOLERANCE * cost);
    }
    if !is_first {
        settings.initial_barrier = WARM_BARRIER * cost;
    }
    if problem.has_complementarity() {
        settings.bound_push = COMPLEMENTARITY_BOUND_PUSH;
    }
    settings
}

/// The first mesh: segments distributed over the phases in proportion to their durations.
fn first_mesh(guess: &Guess, options: &Options) -> Mesh {
    let total_s: f64 = guess.durations_s().iter().sum();
    let count = |duration_s: &f64| {
        let count = (options.segments as f64 * duration_s / total_s).round() as usize;
        (count.max(MIN_SEGMENTS), options.points)
    };
    let phases: Vec<(usize, usize)> = match guess.durations_s() {
        [_] => vec![(options.segments, options.points)],
        durations_s => durations_s.iter().map(count).collect(),
    };
    if options.is_graded { Mesh::graded(&phases) } else { Mesh::uniform(&phases) }
}

fn mesh_iteration(
    program: &Transcription,
    method: &InteriorPoint,
    solution: &Solution,
    begin: Instant,
) -> MeshIteration {
    let times = program.node_times_s(method.x());
    let max_interval_s = times.windows(2).map(|pair| pair[1].0 - pair[0].0).fold(0.0, f64::max);
    let worst = segment_qualities(program, method.x()).into_iter().flatten().reduce(Quality::worst);
    MeshIteration {
        segments: program.mesh().segments(),
        nodes: program.mesh().nodes(),
        variables: method.x().len(),
        status: solution.status,
        iterations: solution.iterations,
        objective: solution.objective,
        violation: solution.violation,
        quality: worst.unwrap_or_default(),
        max_interval_s,
        wall_s: begin.elapsed().as_secs_f64(),
    }
}
