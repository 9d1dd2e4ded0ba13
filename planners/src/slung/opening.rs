//! Where the first mesh begins.

use super::guess::Guess;
use super::model::Model;
use super::problem::Problem;
use crate::nlp::{InteriorPoint, Settings, Start, Status};
use crate::pseudospectral::Transcription;

/// Variables to begin with: the guess.
///
/// What is to be fast begins as what takes little effort in the time that is guessed: from there the shortest time is found
/// far more often than from a motion that obeys no equations.
pub fn point(problem: &Problem, guess: &Guess, programme: &Transcription, settings: Settings) -> Vec<f64> {
    if problem.weights.time == 0.0 {
        return guessed(guess, programme);
    }
    let easier = problem.at_leisure();
    let model = Model::new(&easier);
    let mut leisurely = Transcription::new(&model, programme.mesh().clone());
    let from = Start::Cold(guessed(guess, &leisurely));
    let mut method = InteriorPoint::new(&leisurely, settings);
    match method.solve(&mut leisurely, &from).status {
        Status::Solved => programme.guess(&|phase, share, node: &mut [f64]| {
            leisurely.node(method.x(), leisurely.place(phase, share), node);
        }),
        _ => guessed(guess, programme),
    }
}

fn guessed(guess: &Guess, programme: &Transcription) -> Vec<f64> {
    programme.guess(&|phase, share, node: &mut [f64]| guess.write(phase, share, node))
}
