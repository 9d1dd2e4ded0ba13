//! Model predictive path integral control, iterated: the mean moves to the particles' mean, weighted by exp(-J/λ).

use super::{Frame, Sampler, ranking};
use crate::horizon::draw::Draws;
use crate::horizon::group::Group;
use crate::lanes::WIDTH;

/// First and last deviation of the samples over the bound.
const DEVIATION: [f64; 2] = [0.5, 0.02];

/// The temperature λ is this share of the cost between the best and the median of the feasible particles.
const TEMPERATURE: f64 = 0.3;

/// Samples of given width about a mean.
#[derive(Clone, Debug)]
pub struct PathIntegral {
    frame: Frame,
    mean: Vec<f64>,
}

impl PathIntegral {
    /// Around `center`.
    pub fn new(frame: Frame, center: Vec<f64>) -> Self {
        Self { frame, mean: center }
    }

    fn deviation(&self, iteration: usize) -> f64 {
        let [first, last] = DEVIATION;
        let progress = iteration as f64 / self.frame.iterations as f64;
        (first + (last - first) * progress) * self.frame.bound_mps2
    }
}

impl Sampler for PathIntegral {
    fn propose(&mut self, iteration: usize, draws: Draws, groups: &mut [Group]) {
        let deviation = self.deviation(iteration);
        for (g, group) in groups.iter_mut().enumerate() {
            for (unknown, quad) in group.controls.iter_mut().enumerate() {
                for (lane, control) in quad.iter_mut().enumerate() {
                    let normal = draws.normal(self.frame.place(iteration, g * WIDTH + lane, unknown));
                    *control = self.mean[unknown] + deviation * normal;
                }
            }
        }
    }

    fn learn(&mut self, groups: &[Group]) {
        let ranking = ranking(groups);
        let fitness = |&(group, lane): &(usize, usize)| groups[group].fitness[lane];
        let feasible = ranking.iter().take_while(|at| fitness(at).is_feasible()).count();
        // where none is feasible the violation takes the cost's place
        let count = if feasible > 0 { feasible } else { ranking.len() };
        let worth = |at: &(usize, usize)| if feasible > 0 { fitness(at).cost } else { fitness(at).violation };
        let best = worth(&ranking[0]);
        let λ = (TEMPERATURE * (worth(&ranking[count / 2]) - best)).max(f64::MIN_POSITIVE);
        let weights: Vec<f64> = ranking[..count].iter().map(|at| falling((worth(at) - best) / λ)).collect();
        let total: f64 = weights.iter().sum();
        for (unknown, mean) in self.mean.iter_mut().enumerate() {
            let parts = ranking.iter().zip(&weights);
            *mean = parts.map(|(&(group, lane), weight)| weight / total * groups[group].controls[unknown][lane]).sum();
        }
    }
}

/// exp(-x) for x >= 0 as (1 - x/64)^64, zero from 64 on: products alone have the same digits on every machine.
fn falling(x: f64) -> f64 {
    (1.0 - x / 64.0).max(0.0).powi(64)
}
