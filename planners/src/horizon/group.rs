//! Four particles side by side.

use std::cmp::Ordering;

use super::outlook::Hints;
use super::question::Grid;
use crate::free_space::vector::Point;
use crate::lanes::WIDTH;

/// One number of four particles.
pub type Quad = [f64; WIDTH];

/// How good a particle is: a feasible one beats an infeasible one, among feasible ones the lower cost wins, among
/// infeasible ones the lower violation (eq. 11, with BigM without bound).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fitness {
    /// Violation of eq. 12; zero is feasible.
    pub violation: f64,
    /// Cost of eq. 10, 16 or 17; infinite where it was not computed.
    pub cost: f64,
}

impl Fitness {
    /// Worse than everything.
    pub const WORST: Self = Self { violation: f64::INFINITY, cost: f64::INFINITY };

    /// Is nothing violated? Not where the violation is no number.
    pub fn is_feasible(self) -> bool {
        self.violation <= 0.0
    }

    /// Is it better than the other?
    pub fn beats(self, other: Self) -> bool {
        self.order(other).is_lt()
    }

    /// Better ones first.
    pub fn order(self, other: Self) -> Ordering {
        let key = |fitness: Self| {
            let cost = if fitness.is_feasible() { fitness.cost } else { 0.0 };
            (fitness.violation, cost)
        };
        let ((violation, cost), (other_violation, other_cost)) = (key(self), key(other));
        violation.total_cmp(&other_violation).then(cost.total_cmp(&other_cost))
    }
}

/// Controls of four particles, and what became of them. Vectors are made once.
#[derive(Clone, Debug)]
pub struct Group {
    /// Accelerations a_0, ..., a_{H-1}, m/s²: coordinate by coordinate, step by step.
    pub controls: Vec<Quad>,
    /// Positions at the samples 0 ..= H, m.
    pub path: Vec<[Quad; 3]>,
    /// Velocity at the horizon's end, m/s.
    pub end_velocity: [Quad; 3],
    /// Where braking from the horizon's end leads, m.
    pub stop: [Quad; 3],
    /// Violation of eq. 12.
    pub violation: Quad,
    /// Sum of the squared changes of acceleration, (m/s²)².
    pub roughness: Quad,
    /// Sum of the repulsion over the steps (eq. 3).
    pub repulsion: Quad,
    /// How good they are.
    pub fitness: [Fitness; WIDTH],
    /// What hid the nodes of the cost map.
    pub hints: Hints,
}

impl Group {
    /// All controls zero.
    pub fn new(grid: Grid) -> Self {
        let zero = [0.0; WIDTH];
        Self {
            controls: vec![zero; grid.unknowns()],
            path: vec![[zero; 3]; grid.steps + 1],
            end_velocity: [zero; 3],
            stop: [zero; 3],
            violation: zero,
            roughness: zero,
            repulsion: zero,
            fitness: [Fitness::WORST; WIDTH],
            hints: Hints::new(),
        }
    }

    /// Controls of one particle.
    pub fn particle(&self, lane: usize) -> Vec<f64> {
        self.controls.iter().map(|quad| quad[lane]).collect()
    }

    /// Sets the controls of one particle.
    pub fn set_particle(&mut self, lane: usize, controls: &[f64]) {
        for (quad, &control) in self.controls.iter_mut().zip(controls) {
            quad[lane] = control;
        }
    }

    /// Position of one particle at a sample.
    pub fn position(&self, sample: usize, lane: usize) -> Point {
        self.path[sample].map(|quad| quad[lane])
    }
}
