//! Reproducible numbers for property tests.

/// SplitMix64 (Steele, Lea, Flood 2014).
pub struct Uniform(u64);

impl Uniform {
    /// The same numbers for the same `seed`.
    pub fn seeded(seed: u64) -> Self {
        Self(seed)
    }

    /// The next number, evenly distributed in [low, high).
    pub fn between(&mut self, low: f64, high: f64) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^= z >> 31;
        low + (high - low) * ((z >> 11) as f64 / (1_u64 << 53) as f64)
    }
}
