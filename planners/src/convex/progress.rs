//! How far an iterate is from optimal, and whether to go on.

use super::solution::{Settings, Status};

/// Iterations without a tenth of progress after which a solve counts as stalled.
const STALL_LIMIT: usize = 5;

/// Measures of one iterate.
#[derive(Clone, Copy, Debug)]
pub struct Progress {
    /// Sum of all complementarity products: the duality gap.
    pub products: f64,
    /// The gap relative to the objective, or to 1 where that is larger.
    pub gap: f64,
    /// Largest residual of the linear equations.
    pub residual: f64,
    /// Objective.
    pub objective: f64,
}

impl Progress {
    /// The larger of gap and residual; infinite if either is not a number.
    fn error(&self) -> f64 {
        // f64::max alone would drop a NaN
        if self.gap.is_nan() || self.residual.is_nan() { f64::INFINITY } else { self.gap.max(self.residual) }
    }
}

/// Keeps the best iterate's measures and notices when there is nothing more to gain.
#[derive(Clone, Debug)]
pub struct Watch {
    tolerance: f64,
    best: Progress,
    last_error: f64,
    least_products: f64,
    stalled_for: usize,
}

impl Watch {
    /// Nothing seen yet.
    pub fn new(settings: &Settings) -> Self {
        let nothing = f64::INFINITY;
        let best = Progress { products: nothing, gap: nothing, residual: nothing, objective: f64::NAN };
        Self { tolerance: settings.tolerance, best, last_error: nothing, least_products: nothing, stalled_for: 0 }
    }

    /// Takes note of an iterate; true if it is the best so far.
    pub fn is_best(&mut self, now: Progress) -> bool {
        self.last_error = now.error();
        self.stalled_for = if now.products < 0.9 * self.least_products { 0 } else { self.stalled_for + 1 };
        self.least_products = self.least_products.min(now.products);
        let better = now.error() < self.best.error();
        if better {
            self.best = now;
        }
        better
    }

    /// Why to stop, if so.
    pub fn status(&self) -> Option<Status> {
        if self.best.error() <= self.tolerance {
            Some(Status::Solved)
        } else if self.stalled_for > STALL_LIMIT || !self.last_error.is_finite() {
            Some(Status::Stalled)
        } else {
            None
        }
    }

    /// Measures of the best iterate.
    pub fn best(&self) -> Progress {
        self.best
    }
}
