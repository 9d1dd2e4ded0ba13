//! The initial point of the first mesh.

use super::guess::Guess;
use super::problem::Problem;
use super::system::SlungLoadSystem;
use crate::nlp::{InteriorPoint, Settings, Start, Status};
use crate::pseudospectral::Transcription;

/// Variables from the guess.
///
/// Minimum-time problems start from the minimum-effort solution in the guessed time: from there the method converges
/// far more often than from a guess that violates the dynamics.
pub fn initial_iterate(problem: &Problem, guess: &Guess, program: &Transcription, settings: Settings) -> Vec<f64> {
    if problem.weights.time == 0.0 {
        return from_guess(guess, program);
    }
    let problem = problem.min_effort();
    let system = SlungLoadSystem::new(&problem);
    let mut min_effort = Transcription::new(&system, program.mesh().clone());
    let start = Start::Cold(from_guess(guess, &min_effort));
    let mut method = InteriorPoint::new(&min_effort, settings);
    match method.solve(&mut min_effort, &start).status {
        Status::Solved => program.variables_from(&|phase, fraction, node: &mut [f64]| {
            min_effort.node(method.x(), min_effort.mesh_point(phase, fraction), node);
        }),
        _ => from_guess(guess, program),
    }
}

fn from_guess(guess: &Guess, program: &Transcription) -> Vec<f64> {
    program.variables_from(&|phase, fraction, node: &mut [f64]| guess.write(phase, fraction, node))
}
