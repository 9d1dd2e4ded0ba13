//! A quadrotor with a load on a cable that can go slack (Kang, Huang, Wen 2020; dynamics after Foehn et al. 2017).

mod answer;
mod attitude;
mod cable;
mod cost;
mod ends;
mod envelope;
mod gate;
mod guess;
mod jet;
mod model;
mod opening;
mod optimise;
mod planner;
mod polygon;
mod problem;
mod pull;
mod question;
mod rotation;
mod route;
mod rows;
mod translation;

pub use envelope::{Envelope, envelope};
pub use guess::Guess;
pub use model::Model;
pub use optimise::{Candidate, Options, Round, optimise};
pub use planner::{PLANNER, candidate_routes, name_of};
pub use polygon::Polygon;
pub use problem::{Body, Gate, Limits, Mode, Problem, Rest, Stage, Weights};
pub use question::{options, problem};
pub use route::{Route, routes};

#[cfg(test)]
mod programme_tests;
#[cfg(test)]
mod tests;
