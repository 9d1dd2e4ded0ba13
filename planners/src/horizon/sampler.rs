//! Ways to look for the best controls: each proposes particles and learns from what they are worth.

mod cma_es;
mod cross_entropy;
mod path_integral;
mod swarm;

use super::draw::Draws;
use super::group::Group;
use super::question::Grid;
use crate::lanes::WIDTH;

pub use swarm::{Inertia, Swarm};

/// Proposes particles, and learns from what they are worth.
pub trait Sampler {
    /// Sets the controls of all particles.
    fn propose(&mut self, iteration: usize, draws: Draws, groups: &mut [Group]);
    /// Takes in how good they are, and what projection has made of their controls.
    fn learn(&mut self, groups: &[Group]);
}

/// Which sampler.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Method {
    /// Particle swarm (eq. 13, 14), with or without the rule for infeasible particles (eq. 15).
    Swarm(Swarm),
    /// Cross-entropy method: a normal distribution is fitted to the best (Rubinstein 1999).
    CrossEntropy,
    /// Model predictive path integral: a mean weighted by the exponential of the cost (Williams et al. 2017).
    PathIntegral,
    /// Covariance matrix adaptation (Hansen, Ostermeier 2001).
    CmaEs,
}

/// What every sampler has to know.
#[derive(Clone, Copy, Debug)]
pub struct Frame {
    /// The unknowns.
    pub grid: Grid,
    /// Number of particles, a multiple of four.
    pub particles: usize,
    /// Iterations that there will be at most.
    pub iterations: usize,
    /// Bound on each control, m/s².
    pub bound_mps2: f64,
}

impl Frame {
    /// The place of a random number, for [`Draws`].
    #[inline]
    fn place(&self, iteration: usize, particle: usize, unknown: usize) -> u64 {
        ((iteration * self.particles + particle) * self.grid.unknowns() + unknown) as u64
    }
}

impl Method {
    /// A sampler that begins around `guess`, or anywhere if there is none.
    pub fn sampler(self, frame: Frame, guess: Option<&[f64]>) -> Box<dyn Sampler> {
        let center = guess.map_or_else(|| vec![0.0; frame.grid.unknowns()], <[f64]>::to_vec);
        match self {
            Self::Swarm(rules) => Box::new(swarm::Flock::new(frame, rules)),
            Self::CrossEntropy => Box::new(cross_entropy::CrossEntropy::new(frame, center)),
            Self::PathIntegral => Box::new(path_integral::PathIntegral::new(frame, center)),
            Self::CmaEs => Box::new(cma_es::CmaEs::new(frame, center)),
        }
    }
}

/// Indices (group, lane) of all particles, best first; equal ones in their order.
fn ranking(groups: &[Group]) -> Vec<(usize, usize)> {
    let mut ranking: Vec<_> = (0..groups.len()).flat_map(|group| (0..WIDTH).map(move |lane| (group, lane))).collect();
    ranking.sort_by(|&(g, l), &(h, m)| groups[g].fitness[l].order(groups[h].fitness[m]));
    ranking
}
