//! The decoupled pseudospectral planner of fixed-wing fleets: the baseline that Wang, Xu, Long (2020) compare with, after
//! Wang, Liu, Long (2017).
//!
//! Every aircraft has an optimal control problem of its own, transcribed by Legendre-Gauss-Radau collocation
//! ([`pseudospectral`](crate::pseudospectral)) and solved by the nonlinear interior-point method ([`nlp`](crate::nlp)). First
//! all fly as fast as they can, each alone. The slowest determines the common flight time; then one aircraft after the other,
//! the slowest first, is planned for that time with the least effort, and avoids those planned before at its nodes. If one
//! finds no way, the common time grows.

mod guess;
mod neighbour;
mod node_vector;
mod planner;
mod problem;
#[cfg(test)]
mod reference_tests;
mod rollout;
mod rows;
mod solve;
mod system;
#[cfg(test)]
mod tests;
mod units;

use crate::planner::Planner;

/// The planners of this family.
pub(crate) const PLANNERS: &[Planner] = &[planner::PLANNER];
