//! A quadrotor with a load on a cable that can go slack (Kang, Huang, Wen 2020; dynamics after Foehn et al. 2017).

mod attitude;
mod cable;
mod guess;
mod jet;
mod model;
mod polygon;
mod problem;
mod route;

pub use guess::Guess;
pub use model::Model;
pub use polygon::Polygon;
pub use problem::{Body, Limits, Mode, Problem, Rest, Stage, Weights};
pub use route::{Route, routes};

#[cfg(test)]
mod tests;
