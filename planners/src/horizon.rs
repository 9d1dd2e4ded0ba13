//! Receding-horizon planning in the loop: at every instant a finite-horizon optimal control problem for a point mass
//! (eq. 7 to 10, 18 to 21 of the paper on RHC-FPSO), solved by sampling.
//!
//! - [`problem`]: the optimal control problem at one instant;
//! - `batch_rollout` simulates four particles at once, [`evaluate`] computes their fitness;
//! - [`sampler`]: particle swarm, cross-entropy, path integral, CMA-ES; [`optimiser`] is their common loop;
//! - [`controller`]: successive replans: warm start, acceptance, fallback; `deadlock_recovery` where they lead nowhere;
//! - `settings` and `obstacle_prediction` translate scenarios and observations.
//!
//! The paper: receding-horizon control of a multirotor with a feasibility-driven particle swarm. Equation numbers in this
//! module and in [`roadmap`](crate::roadmap) are the paper's. Additions to it: clearances that hold between the samples,
//! warm starts, projection of the controls, a stop in free space at the end of every horizon, and the samplers other than
//! the swarm.

#[expect(
    clippy::needless_range_loop,
    reason = "coordinates are read by index; closures would lose the vector instructions"
)]
mod batch_rollout;

pub mod controller;
pub mod counter_rng;
mod deadlock_recovery;
pub mod evaluate;
mod obstacle_prediction;
pub mod optimiser;
pub mod particle_batch;
mod planner;
pub mod problem;
pub mod sampler;
mod settings;

pub use planner::RHC;

use crate::planner::Planner;

/// The planners of this family.
pub(crate) const PLANNERS: &[Planner] =
    &[RHC, planner::RHC_PSO, planner::RHC_FPSO, planner::RHC_FPSO_PLAIN, planner::RHC_APF];
