//! The nonlinear program of one aircraft: solved from several guesses, sampled.

use rayon::prelude::*;

use super::guess::Guess;
use super::neighbour::Neighbour;
use super::node_vector::{STATES, VELOCITY, WIDTH};
use super::problem::Problem;
use super::rollout;
use super::system::AircraftSystem;
use crate::nlp::{InteriorPoint, Settings, Start, Status, WarmStart};
use crate::pseudospectral::{Mesh, MeshPoint, Tolerances, Transcription, refine};

/// Initial barrier parameter on a refined mesh.
const WARM_BARRIER: f64 = 1e-4;

/// How an aircraft's program is discretised and solved.
#[derive(Clone, Copy, Debug)]
pub struct Options {
    /// Segments of equal length of the first mesh, and collocation points of each.
    pub mesh: (usize, usize),
    /// Tolerances of mesh refinement; without them the first mesh is kept.
    pub tolerances: Option<Tolerances>,
    /// Maximum number of meshes.
    pub max_meshes: usize,
    /// Settings of the interior-point method.
    pub solver: Settings,
    /// Largest time between two samples.
    pub step: f64,
    /// Time between the last sample of a segment and the first one of the next.
    pub jump: f64,
}

/// A node vector at a time.
pub type Sample = (f64, [f64; WIDTH]);

/// A solution, sampled.
#[derive(Clone, Debug)]
pub struct Solved {
    /// Whether the optimality conditions hold on the last mesh, and the mesh meets its tolerances.
    pub is_solved: bool,
    /// Objective.
    pub objective: f64,
    /// Largest constraint violation at the nodes.
    pub violation: f64,
    /// Newton steps on all meshes, of all guesses together.
    pub iterations: usize,
    /// The motion, from time 0 to its end.
    pub samples: Vec<Sample>,
    /// How far the load factors alone lead away from it.
    pub rollout_error: f64,
}

impl Solved {
    /// Flight time.
    pub fn duration(&self) -> f64 {
        self.samples.last().map_or(f64::NAN, |(time, _)| *time)
    }

    /// What the others avoid.
    pub fn as_neighbour(&self) -> Neighbour {
        let pair = |node: &[f64; WIDTH], at: usize| [node[at], node[at + 1]];
        Neighbour {
            times: self.samples.iter().map(|(time, _)| *time).collect(),
            positions: self.samples.iter().map(|(_, node)| pair(node, 0)).collect(),
            velocities: self.samples.iter().map(|(_, node)| pair(node, VELOCITY)).collect(),
        }
    }
}

/// The best solution over all guesses: the lowest objective of those solved, else the smallest violation.
pub fn solve(problem: &Problem, guesses: &[Guess<'_>], options: Options) -> Option<Solved> {
    let all: Vec<Solved> = guesses.par_iter().map(|guess| from_guess(problem, guess, options)).collect();
    let iterations = all.iter().map(|solved| solved.iterations).sum();
    let rank = |solved: &Solved| if solved.is_solved { (0, solved.objective) } else { (1, solved.violation) };
    let best = all.into_iter().min_by(|a, b| {
        let ((class_a, a), (class_b, b)) = (rank(a), rank(b));
        class_a.cmp(&class_b).then(a.total_cmp(&b))
    });
    best.map(|best| Solved { iterations, ..best })
}

/// Solves on the first mesh and, from its solution, on finer ones until the tolerances are met.
fn from_guess(problem: &Problem, guess: &Guess<'_>, options: Options) -> Solved {
    let system = AircraftSystem::new(problem);
    let mut mesh = Mesh::uniform(&[options.mesh]);
    let mut coarse: Option<(Transcription, WarmStart)> = None;
    let (mut iterations, mut meshes) = (0, 0);
    loop {
        let mut program = Transcription::new(&system, mesh);
        let (start, solver) = match &coarse {
            None => (Start::Cold(initial_variables(guess, &program)), options.solver),
            Some((coarse, solution)) => {
                let solver = Settings { initial_barrier: WARM_BARRIER, ..options.solver };
                (Start::Warm(coarse.transfer(solution, &program)), solver)
            }
        };
        let mut method = InteriorPoint::new(&program, solver);
        let solution = method.solve(&mut program, &start);
        iterations += solution.iterations;
        meshes += 1;
        let is_optimal = solution.status == Status::Solved;
        let tolerances = options.tolerances.filter(|_| is_optimal);
        match tolerances.and_then(|tolerances| refine(&program, method.x(), &tolerances)) {
            Some(finer) if meshes < options.max_meshes => {
                let warm_start = method.warm_start();
                (mesh, coarse) = (finer, Some((program, warm_start)));
            }
            unmet => {
                let samples = samples(problem, &program, method.x(), options);
                return Solved {
                    is_solved: is_optimal && unmet.is_none(),
                    objective: solution.objective,
                    violation: solution.violation,
                    iterations,
                    rollout_error: rollout::error(problem, &samples),
                    samples,
                };
            }
        }
    }
}

fn initial_variables(guess: &Guess<'_>, program: &Transcription) -> Vec<f64> {
    program.variables_from(&|_, fraction, node: &mut [f64]| {
        let mut whole = [0.0; WIDTH];
        guess.write(fraction, &mut whole);
        let count = node.len();
        node.copy_from_slice(&whole[..count]);
    })
}

/// The polynomials at the nodes and in between, with load factors within their bounds. Controls may jump from segment to segment:
/// the last value before a jump is a sample too, or the line to the next one would begin to turn a whole step early.
fn samples(problem: &Problem, program: &Transcription, x: &[f64], options: Options) -> Vec<Sample> {
    let nodes = program.node_times_s(x);
    let mut samples = Vec::new();
    let mut sample = |time: f64, point: MeshPoint| {
        let mut node = [0.0; WIDTH];
        program.node(x, point, &mut node);
        for (n, [min, max]) in node[STATES..].iter_mut().zip(problem.load_factors) {
            *n = n.clamp(min, max);
        }
        samples.push((time, node));
    };
    for (k, &(time, point)) in nodes.iter().enumerate() {
        sample(time, point);
        let Some(&(next_time, next)) = nodes.get(k + 1) else { continue };
        let count = ((next_time - time) / options.step).ceil().max(1.0) as usize;
        let τ_next = if next.segment == point.segment { next.τ } else { 1.0 };
        for piece in 1..count {
            let fraction = piece as f64 / count as f64;
            sample(
                time + fraction * (next_time - time),
                MeshPoint { τ: point.τ + fraction * (τ_next - point.τ), ..point },
            );
        }
        let gap = (next_time - time) / count as f64;
        if next.segment != point.segment && gap > 2.0 * options.jump {
            let τ = τ_next - options.jump / (next_time - time) * (τ_next - point.τ);
            sample(next_time - options.jump, MeshPoint { τ, ..point });
        }
    }
    samples
}
