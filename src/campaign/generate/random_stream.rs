//! Random numbers.

use rand::RngExt;
use rand_chacha::ChaCha8Rng;

/// A named stream of random numbers.
pub struct RandomStream(ChaCha8Rng);

impl RandomStream {
    /// The stream `name` of a seed.
    pub fn new(seed: u64, name: &str) -> Self {
        Self(scenarios::stream(seed, name))
    }

    /// Uniform in [low, high).
    pub fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.0.random::<f64>()
    }

    /// The same, rounded to `step`: numbers in a file that people read.
    pub fn rounded(&mut self, low: f64, high: f64, step: f64) -> f64 {
        round_to(self.between(low, high), step)
    }

    /// -1 or 1.
    pub fn sign(&mut self) -> f64 {
        if self.0.random::<bool>() { 1.0 } else { -1.0 }
    }

    /// An index below `count`.
    pub fn index(&mut self, count: usize) -> usize {
        self.0.random_range(0..count)
    }
}

/// The multiple of `step` next to `value`, without binary noise in its decimals.
pub fn round_to(value: f64, step: f64) -> f64 {
    if step >= 1.0 {
        return (value / step).round() * step + 0.0;
    }
    let per_unit = (1.0 / step).round();
    (value * per_unit).round() / per_unit + 0.0
}

#[cfg(test)]
mod tests {
    use super::round_to;

    #[test]
    fn rounded_numbers_are_short() {
        for (value, step, text) in [
            (1234.0, 10.0, "1230"),
            (-0.001, 0.01, "0"),
            (0.1 + 0.2, 0.1, "0.3"),
            (2.68, 0.05, "2.7"),
            (7.4, 1.0, "7"),
            (-61.23456789, 1e-6, "-61.234568"),
        ] {
            assert_eq!(round_to(value, step).to_string(), text);
        }
    }
}
