//! Cross-entropy method: mean and deviations follow those of the best particles.

use super::{Frame, Sampler, ranking};
use crate::horizon::draw::Draws;
use crate::horizon::group::Group;
use crate::lanes::WIDTH;

/// Share of the particles that counts.
const ELITE: f64 = 0.2;

/// Share of the old distribution that stays.
const MEMORY: f64 = 0.2;

/// First deviation over the bound.
const FIRST_DEVIATION: f64 = 0.5;

/// Smallest deviation over the bound.
const LAST_DEVIATION: f64 = 0.005;

/// A normal distribution with independent coordinates.
#[derive(Clone, Debug)]
pub struct CrossEntropy {
    frame: Frame,
    mean: Vec<f64>,
    deviation: Vec<f64>,
}

impl CrossEntropy {
    /// Wide, around `center`.
    pub fn new(frame: Frame, center: Vec<f64>) -> Self {
        let deviation = vec![FIRST_DEVIATION * frame.bound_mps2; center.len()];
        Self { frame, mean: center, deviation }
    }
}

impl Sampler for CrossEntropy {
    fn propose(&mut self, iteration: usize, draws: Draws, groups: &mut [Group]) {
        for (g, group) in groups.iter_mut().enumerate() {
            for (unknown, quad) in group.controls.iter_mut().enumerate() {
                for (lane, control) in quad.iter_mut().enumerate() {
                    let normal = draws.normal(self.frame.place(iteration, g * WIDTH + lane, unknown));
                    *control = self.mean[unknown] + self.deviation[unknown] * normal;
                }
            }
        }
    }

    fn learn(&mut self, groups: &[Group]) {
        let count = ((ELITE * self.frame.particles as f64) as usize).max(2);
        let elite = &ranking(groups)[..count];
        for unknown in 0..self.mean.len() {
            let of = |&(group, lane): &(usize, usize)| -> f64 { groups[group].controls[unknown][lane] };
            let mean = elite.iter().map(of).sum::<f64>() / count as f64;
            let variance = elite.iter().map(|at| (of(at) - mean).powi(2)).sum::<f64>() / count as f64;
            let least = LAST_DEVIATION * self.frame.bound_mps2;
            self.mean[unknown] += (1.0 - MEMORY) * (mean - self.mean[unknown]);
            let deviation = MEMORY * self.deviation[unknown] + (1.0 - MEMORY) * variance.sqrt();
            self.deviation[unknown] = deviation.max(least);
        }
    }
}
