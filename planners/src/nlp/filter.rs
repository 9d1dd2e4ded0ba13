//! The filter: pairs (constraint violation θ, barrier objective φ), none of which may dominate a new iterate (Wächter
//! and Biegler 2006, section 2.3).

/// Sufficient decrease of θ and of φ, relative to θ (Wächter and Biegler 2006, eq. 18).
pub const Γ_THETA: f64 = 1e-5;
pub const Γ_PHI: f64 = 1e-8;

/// Pairs that new iterates must not be dominated by.
#[derive(Clone, Debug)]
pub struct Filter {
    pairs: Vec<(f64, f64)>,
    θ_max: f64,
}

impl Filter {
    /// An empty filter without a limit on θ.
    pub fn new() -> Self {
        Self { pairs: Vec::with_capacity(64), θ_max: f64::INFINITY }
    }

    /// Removes all pairs, and rejects θ > `θ_max` from now on (ibid., eq. 21).
    pub fn reset(&mut self, θ_max: f64) {
        self.pairs.clear();
        self.θ_max = θ_max;
    }

    /// Removes all pairs, as they hold for one barrier parameter only.
    pub fn clear(&mut self) {
        self.pairs.clear();
    }

    /// Whether no pair dominates `(θ, φ)`. False for NaN.
    pub fn accepts(&self, θ: f64, φ: f64) -> bool {
        θ <= self.θ_max && self.pairs.iter().all(|&(θ_j, φ_j)| θ <= θ_j || φ <= φ_j)
    }

    /// Whether `(θ, φ)` sufficiently improves on `(θ_0, φ_0)`, up to rounding:
    ///
    /// ```text
    /// θ <= (1 - γ_θ) θ_0   or   φ <= φ_0 - γ_φ θ_0                            [Wächter and Biegler 2006, eq. 18]
    /// ```
    pub fn improves((θ_0, φ_0): (f64, f64), (θ, φ): (f64, f64)) -> bool {
        θ <= (1.0 - Γ_THETA) * θ_0 || φ <= φ_0 - Γ_PHI * θ_0 + 10.0 * f64::EPSILON * φ_0.abs()
    }

    /// Adds `(θ, φ)` with its margins (ibid., eq. 22).
    pub fn add(&mut self, θ: f64, φ: f64) {
        let pair = ((1.0 - Γ_THETA) * θ, φ - Γ_PHI * θ);
        self.pairs.retain(|other| other.0 < pair.0 || other.1 < pair.1);
        self.pairs.push(pair);
    }
}

#[cfg(test)]
mod tests {
    use super::Filter;

    #[test]
    fn dominated_pairs_and_nan_are_rejected() {
        let mut filter = Filter::new();
        filter.reset(10.0);
        filter.add(1.0, 5.0);
        assert!(filter.accepts(0.5, 9.0) && filter.accepts(2.0, 4.0));
        assert!(!filter.accepts(1.5, 6.0) && !filter.accepts(11.0, 0.0));
        assert!(!filter.accepts(f64::NAN, 0.0) && !filter.accepts(2.0, f64::NAN));
        filter.clear();
        assert!(filter.accepts(1.5, 6.0));
    }
}
