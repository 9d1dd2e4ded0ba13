//! Planning in the loop by receding horizons: at every instant, a finite-horizon optimal control problem for a point mass
//! (eq. 7 to 10, 18 to 21 of the paper on RHC-FPSO), solved by sampling.
//!
//! - `question`: the problem at one instant; `flight` flies four particles at once, `evaluate` charges them;
//! - `roadmap`, `visibility`, `voronoi`, `cost_map`: what is left from the horizon's end to the goal, by the whole map;
//! - `sampler`: ways to look for the best controls; `optimise` is their loop;
//! - `pilot`: from instant to instant: warm start, acceptance, fallback.
//!
//! The paper: receding-horizon control of a multirotor with a feasibility-driven particle swarm (its equation numbers are
//! quoted throughout). What is ours beyond it: distances that hold between the samples, warm starts, projection, the stop
//! at the end of every horizon, and the samplers other than the swarm.

#[expect(
    clippy::needless_range_loop,
    reason = "coordinates are read by index; closures would lose the vector instructions"
)]
mod flight;

pub(crate) mod brief;
pub mod cost_map;
pub mod draw;
pub mod evaluate;
pub mod group;
pub mod motion;
pub mod optimise;
mod others;
pub mod outlook;
pub mod pilot;
mod planner;
pub mod question;
pub(crate) mod reference;
pub mod roadmap;
pub mod sampler;
mod visibility;
mod voronoi;

pub use planner::{RHC, RHC_APF, RHC_FPSO, RHC_PSO};
