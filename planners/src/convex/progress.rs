//! How far an iterate is from optimal, and whether to go on.

use super::solution::{Settings, Status};

/// Iterations without a tenth of progress after which a solve counts as stalled.
const STALL_LIMIT: usize = 12;

/// Measures of one iterate. Every iterate is feasible, so that the gap is all there is.
#[derive(Clone, Copy, Debug)]
pub struct Progress {
    /// The duality gap relative to the objective, or to 1 where that is larger.
    pub gap: f64,
    /// Sum of all complementarity products: the duality gap.
    products: f64,
    /// Number of iterations so far.
    iteration: usize,
}

impl Progress {
    /// After `iteration` iterations.
    pub fn new(products: f64, objective: f64, iteration: usize) -> Self {
        Self { gap: products / objective.abs().max(1.0), products, iteration }
    }
}

/// Keeps the best iterate's measures and notices when there is nothing more to gain.
#[derive(Clone, Debug)]
pub struct Watch {
    tolerance: f64,
    best: Progress,
    last: Progress,
    stalled_for: usize,
}

impl Watch {
    /// Nothing seen yet.
    pub fn new(settings: &Settings) -> Self {
        let nothing = Progress { gap: f64::INFINITY, products: f64::INFINITY, iteration: 0 };
        Self { tolerance: settings.tolerance, best: nothing, last: nothing, stalled_for: 0 }
    }

    /// Takes note of an iterate; true if it is the best so far.
    pub fn is_best(&mut self, now: Progress) -> bool {
        self.last = now;
        self.stalled_for = if now.products < 0.9 * self.best.products { 0 } else { self.stalled_for + 1 };
        let better = now.gap < self.best.gap;
        if better {
            self.best = now;
        }
        better
    }

    /// How it stands: [`Status::IterationLimit`] as long as there is reason to go on.
    pub fn status(&self) -> Status {
        if self.best.gap <= self.tolerance {
            Status::Solved
        } else if self.stalled_for > STALL_LIMIT || !self.last.gap.is_finite() {
            Status::Stalled
        } else {
            Status::IterationLimit
        }
    }

    /// Iterations to the last iterate that was seen.
    pub fn iterations(&self) -> usize {
        self.last.iteration
    }
}
