//! One route to its optimum: solve on the first mesh, refine, solve again from there.

use std::time::Instant;

use super::guess::Guess;
use super::model::Model;
use super::opening;
use super::problem::Problem;
use super::route::Route;
use crate::nlp::{InteriorPoint, Settings, Solution, Start, Status, Warm};
use crate::pseudospectral::{Mesh, Motion, Quality, Tolerances, Transcription, qualities, refine};

/// Tolerance on meshes that are not expected to be the last, as a share of what a flight costs.
const COARSE_TOLERANCE: f64 = 5e-6;

/// Fewest segments of a phase.
const FEWEST: usize = 4;

/// Barrier parameter from which a solution of a coarser mesh is taken up, as a share of what a flight costs.
const WARM_BARRIER: f64 = 4.5e-7;

/// Distance from the bounds at which complementarity begins, relative to their box: where the cable would start visibly
/// shorter than it is, a slack phase that leads nowhere would be found at the start.
const PUSH_OF_COMPLEMENTARITY: f64 = 1e-4;

/// How a problem is solved.
#[derive(Clone, Debug, PartialEq)]
pub struct Options {
    /// Segments of the first mesh, for the whole flight; phases share them by their durations.
    pub segments: usize,
    /// Collocation points of each of them.
    pub points: usize,
    /// Whether the segments are shorter near the ends of a phase, or all equal.
    pub is_graded: bool,
    /// What the mesh must reach; absent, the first mesh stays.
    pub tolerances: Option<Tolerances>,
    /// Most meshes.
    pub most_meshes: usize,
    /// Of the nonlinear programmes.
    pub solver: Settings,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            segments: 16,
            points: 5,
            is_graded: true,
            tolerances: Some(Tolerances { error: 1e-4, violation: 5e-4, overshoot: 0.1, highest_order: 8 }),
            most_meshes: 12,
            solver: Settings { tolerance: 1e-6, ..Settings::default() },
        }
    }
}

/// What was reached on one mesh.
#[derive(Clone, Debug, PartialEq)]
pub struct Round {
    /// Number of segments, of nodes, of variables.
    pub segments: usize,
    /// Number of collocation points.
    pub nodes: usize,
    /// Number of variables.
    pub variables: usize,
    /// How the nonlinear programme ended.
    pub status: Status,
    /// Newton steps.
    pub iterations: usize,
    /// Objective.
    pub objective: f64,
    /// Largest violation of a row at the nodes.
    pub violation: f64,
    /// Worst of all segments between the nodes.
    pub quality: Quality,
    /// Longest time between two nodes, s.
    pub longest_s: f64,
    /// Wall time, s.
    pub wall_s: f64,
}

/// A route's optimum, or how far it got.
#[derive(Clone, Debug)]
pub struct Candidate<'a> {
    /// The route.
    pub route: &'a Route,
    /// Mesh by mesh.
    pub rounds: Vec<Round>,
    /// The last mesh and the variables on it.
    pub mesh: Mesh,
    /// Variables.
    pub x: Vec<f64>,
    /// Whether the last mesh is as good as was asked for; true where nothing was asked for.
    pub is_refined: bool,
}

impl Candidate<'_> {
    /// The last round.
    pub fn last(&self) -> &Round {
        &self.rounds[self.rounds.len() - 1]
    }

    /// Whether the last programme was solved.
    pub fn is_solved(&self) -> bool {
        self.last().status == Status::Solved
    }
}

/// Solves `problem` along `route`.
pub fn optimise<'a>(problem: &Problem, route: &'a Route, options: &Options) -> Candidate<'a> {
    let model = Model::new(problem);
    let guess = Guess::new(problem, route, model.coordinates());
    let cost = problem.hover_cost(guess.durations_s().iter().sum());
    let mut mesh = first_mesh(&guess, options);
    let mut start: Option<(Transcription, Warm)> = None;
    let mut rounds = Vec::new();
    let is_complementary = problem.is_complementary();
    // a mesh that is good enough for a rough solution is solved on once more
    let mut is_rough = options.tolerances.is_some() && !is_complementary;
    loop {
        let begin = Instant::now();
        let mut programme = Transcription::new(&model, mesh.clone());
        let settings = settings(problem, options, cost, (start.is_none(), is_rough));
        let from = match &start {
            None => Start::Cold(opening::point(problem, &guess, &programme, settings)),
            Some((coarse, solution)) => {
                let carried = coarse.carry_over(solution, &programme);
                // slacks of the size of ε, and multipliers of that of 1/ε, belong to one mesh: the motion goes on without
                if is_complementary { Start::Cold(carried.x) } else { Start::Warm(carried) }
            }
        };
        let mut method = InteriorPoint::new(&programme, settings);
        let solution = method.solve(&mut programme, &from);
        rounds.push(round(&programme, &method, &solution, begin));
        let solved = options.tolerances.filter(|_| solution.status == Status::Solved);
        let finer = solved.and_then(|tolerances| refine(&programme, method.x(), &tolerances));
        let is_last = rounds.len() == options.most_meshes || solution.status != Status::Solved;
        if is_last || (finer.is_none() && !is_rough) {
            let is_refined = finer.is_none() && !is_rough && solution.status == Status::Solved;
            return Candidate { route, rounds, mesh, x: method.x().to_vec(), is_refined };
        }
        is_rough = false;
        mesh = finer.unwrap_or(mesh);
        start = Some((programme, method.warm_start()));
    }
}

/// How the programme of a mesh is solved: roughly if another mesh is to come, from near the end if another came before.
fn settings(problem: &Problem, options: &Options, cost: f64, (is_first, is_rough): (bool, bool)) -> Settings {
    let mut settings = options.solver;
    if is_rough {
        settings.tolerance = settings.tolerance.max(COARSE_TOLERANCE * cost);
    }
    if !is_first {
        settings.start = WARM_BARRIER * cost;
    }
    if problem.is_complementary() {
        settings.push = PUSH_OF_COMPLEMENTARITY;
    }
    settings
}

/// Segments, shared among the phases by their durations.
fn first_mesh(guess: &Guess, options: &Options) -> Mesh {
    let total_s: f64 = guess.durations_s().iter().sum();
    let count = |duration_s: &f64| {
        let share = (options.segments as f64 * duration_s / total_s).round() as usize;
        (share.max(FEWEST), options.points)
    };
    let phases: Vec<(usize, usize)> = match guess.durations_s() {
        [_] => vec![(options.segments, options.points)],
        durations_s => durations_s.iter().map(count).collect(),
    };
    if options.is_graded { Mesh::graded(&phases) } else { Mesh::uniform(&phases) }
}

fn round(programme: &Transcription, method: &InteriorPoint, solution: &Solution, begin: Instant) -> Round {
    let times = programme.times_s(method.x());
    let longest_s = times.windows(2).map(|pair| pair[1].0 - pair[0].0).fold(0.0, f64::max);
    let worst = qualities(programme, method.x()).into_iter().flatten().reduce(Quality::worse);
    Round {
        segments: programme.mesh().segments(),
        nodes: programme.mesh().nodes(),
        variables: method.x().len(),
        status: solution.status,
        iterations: solution.iterations,
        objective: solution.objective,
        violation: solution.violation,
        quality: worst.unwrap_or_default(),
        longest_s,
        wall_s: begin.elapsed().as_secs_f64(),
    }
}
