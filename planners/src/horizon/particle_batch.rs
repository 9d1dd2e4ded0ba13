//! Four particles side by side, one per vector lane.

use std::cmp::Ordering;

use super::problem::ControlGrid;
use crate::free_space::Point;
use crate::roadmap::OccluderHints;
use crate::simd::WIDTH;

/// One number per particle.
pub type PerParticle = [f64; WIDTH];

/// Fitness of a particle. A feasible one beats an infeasible one; among feasible ones the lower cost wins, among
/// infeasible ones the lower violation (eq. 11 in the limit of an infinite BigM).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fitness {
    /// Violation (eq. 12); zero if feasible.
    pub violation: f64,
    /// Cost (eq. 10, 16 or 17); infinite if not computed.
    pub cost: f64,
}

impl Fitness {
    /// Worse than any other but NaN.
    pub const WORST: Self = Self { violation: f64::INFINITY, cost: f64::INFINITY };

    /// Is nothing violated? False for NaN.
    pub fn is_feasible(self) -> bool {
        self.violation <= 0.0
    }

    /// Is it strictly better?
    pub fn beats(self, other: Self) -> bool {
        self.order(other).is_lt()
    }

    /// The order from best to worst.
    pub fn order(self, other: Self) -> Ordering {
        let key = |fitness: Self| {
            let cost = if fitness.is_feasible() { fitness.cost } else { 0.0 };
            (fitness.violation, cost)
        };
        let ((violation, cost), (other_violation, other_cost)) = (key(self), key(other));
        violation.total_cmp(&other_violation).then(cost.total_cmp(&other_cost))
    }
}

/// Controls of four particles and the results of their evaluation. All vectors are allocated once.
#[derive(Clone, Debug)]
pub struct ParticleBatch {
    /// Accelerations a_0, ..., a_{H_p - 1}, m/s²; length steps · axes, the coordinates of a step adjacent.
    pub controls: Vec<PerParticle>,
    /// Positions at the samples 0 ..= H_p, m.
    pub path: Vec<[PerParticle; 3]>,
    /// Velocity at the horizon's end, m/s.
    pub final_velocity: [PerParticle; 3],
    /// Position after braking from the horizon's end, m.
    pub stop_position: [PerParticle; 3],
    /// Violation (eq. 12).
    pub violation: PerParticle,
    /// Sum of the squared changes of acceleration, (m/s²)².
    pub roughness: PerParticle,
    /// Sum of the repulsion over the steps (eq. 3).
    pub repulsion: PerParticle,
    /// Fitness.
    pub fitness: [Fitness; WIDTH],
    /// Hints for the cost-to-go query.
    pub hints: OccluderHints,
}

impl ParticleBatch {
    /// All controls zero.
    pub fn new(grid: ControlGrid) -> Self {
        let zero = [0.0; WIDTH];
        Self {
            controls: vec![zero; grid.unknowns()],
            path: vec![[zero; 3]; grid.steps + 1],
            final_velocity: [zero; 3],
            stop_position: [zero; 3],
            violation: zero,
            roughness: zero,
            repulsion: zero,
            fitness: [Fitness::WORST; WIDTH],
            hints: OccluderHints::new(),
        }
    }

    /// Controls of one particle.
    pub fn particle(&self, lane: usize) -> Vec<f64> {
        self.controls.iter().map(|control| control[lane]).collect()
    }

    /// Sets the controls of one particle.
    pub fn set_particle(&mut self, lane: usize, controls: &[f64]) {
        for (own, &control) in self.controls.iter_mut().zip(controls) {
            own[lane] = control;
        }
    }

    /// Position of one particle at a sample, m.
    pub fn position(&self, sample: usize, lane: usize) -> Point {
        self.path[sample].map(|coordinate| coordinate[lane]).into()
    }
}

/// Indices (batch, lane) of all particles from best to worst; equal ones in their original order.
pub fn ranking(batches: &[ParticleBatch]) -> Vec<(usize, usize)> {
    let mut ranking: Vec<_> = (0..batches.len()).flat_map(|batch| (0..WIDTH).map(move |lane| (batch, lane))).collect();
    ranking.sort_by(|&(b, l), &(c, m)| batches[b].fitness[l].order(batches[c].fitness[m]));
    ranking
}
