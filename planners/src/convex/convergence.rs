//! The convergence test of the interior-point loop.

use super::solution::{Settings, Status};

/// Iterations in which the duality gap falls by less than a tenth, after which a solve counts as stalled.
///
/// The start is feasible but badly centred where many halfspaces are violated by much (vehicles that meet at one
/// point). Steps are then short, and the gap hardly falls over the first iterations, up to six of them in the shipped
/// scenarios, before it converges as usual. The limit leaves a factor of two.
const STALL_LIMIT: usize = 12;

/// Measures of one iterate. Every iterate is feasible, so the duality gap is the only one.
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

/// Keeps the measures of the best iterate and detects convergence and stalls.
#[derive(Clone, Debug)]
pub struct ConvergenceMonitor {
    tolerance: f64,
    best: Progress,
    last: Progress,
    stalled_for: usize,
}

impl ConvergenceMonitor {
    /// A monitor that has seen no iterate.
    pub fn new(settings: &Settings) -> Self {
        let nothing = Progress { gap: f64::INFINITY, products: f64::INFINITY, iteration: 0 };
        Self { tolerance: settings.tolerance, best: nothing, last: nothing, stalled_for: 0 }
    }

    /// Records an iterate; true if it is the best so far.
    pub fn record(&mut self, now: Progress) -> bool {
        self.last = now;
        self.stalled_for = if now.products < 0.9 * self.best.products { 0 } else { self.stalled_for + 1 };
        let is_best = now.gap < self.best.gap;
        if is_best {
            self.best = now;
        }
        is_best
    }

    /// The status so far: [`Status::IterationLimit`] while the solve should continue.
    pub fn status(&self) -> Status {
        if self.best.gap <= self.tolerance {
            Status::Solved
        } else if self.stalled_for > STALL_LIMIT || !self.last.gap.is_finite() {
            Status::Stalled
        } else {
            Status::IterationLimit
        }
    }

    /// Number of iterations up to the last recorded iterate.
    pub fn iterations(&self) -> usize {
        self.last.iteration
    }
}
