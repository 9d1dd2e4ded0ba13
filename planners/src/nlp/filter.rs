//! The filter: pairs (violation θ, barrier objective φ) of which no new iterate may be dominated.
//!
//! Wächter and Biegler, "On the implementation of an interior-point filter line-search algorithm", Mathematical
//! Programming 106 (2006), section 2.3.

/// Share of the violation by which a step must better one of the two measures.
const Γ_VIOLATION: f64 = 1e-5;
const Γ_OBJECTIVE: f64 = 1e-8;

/// Pairs that count as visited.
#[derive(Clone, Debug)]
pub struct Filter {
    pairs: Vec<(f64, f64)>,
    largest_violation: f64,
}

impl Filter {
    /// Empty, with room for some pairs.
    pub fn new() -> Self {
        Self { pairs: Vec::with_capacity(64), largest_violation: f64::INFINITY }
    }

    /// Forgets all pairs; violations above `largest_violation` are refused from now on.
    pub fn reset(&mut self, largest_violation: f64) {
        self.pairs.clear();
        self.largest_violation = largest_violation;
    }

    /// Forgets all pairs, as a new barrier parameter makes φ another function.
    pub fn forget(&mut self) {
        self.pairs.clear();
    }

    /// Whether no pair dominates `(θ, φ)`. False for NaN.
    pub fn accepts(&self, θ: f64, φ: f64) -> bool {
        θ <= self.largest_violation && self.pairs.iter().all(|&(θ_j, φ_j)| θ <= θ_j || φ <= φ_j)
    }

    /// Whether `(θ, φ)` is enough of an improvement on `(θ_0, φ_0)`.
    pub fn improves((θ_0, φ_0): (f64, f64), (θ, φ): (f64, f64)) -> bool {
        θ <= (1.0 - Γ_VIOLATION) * θ_0 || φ <= φ_0 - Γ_OBJECTIVE * θ_0 + 10.0 * f64::EPSILON * φ_0.abs()
    }

    /// Marks the surroundings of `(θ, φ)` as visited.
    pub fn add(&mut self, θ: f64, φ: f64) {
        let pair = ((1.0 - Γ_VIOLATION) * θ, φ - Γ_OBJECTIVE * θ);
        self.pairs.retain(|other| other.0 < pair.0 || other.1 < pair.1);
        self.pairs.push(pair);
    }
}

#[cfg(test)]
mod tests {
    use super::Filter;

    #[test]
    fn dominated_pairs_are_refused_and_nan_never_passes() {
        let mut filter = Filter::new();
        filter.reset(10.0);
        filter.add(1.0, 5.0);
        assert!(filter.accepts(0.5, 9.0) && filter.accepts(2.0, 4.0));
        assert!(!filter.accepts(1.5, 6.0) && !filter.accepts(11.0, 0.0));
        assert!(!filter.accepts(f64::NAN, 0.0) && !filter.accepts(2.0, f64::NAN));
        filter.forget();
        assert!(filter.accepts(1.5, 6.0));
    }
}
