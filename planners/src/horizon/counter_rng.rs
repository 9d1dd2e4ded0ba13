//! Counter-based random numbers: each number is a hash of a key and a counter, not the next of a sequence.
//!
//! Every replan takes a key from the planner's stream. The number of particle i, iteration k and coordinate d is a hash of
//! the key and (k, i, d), so the same seed gives the same numbers on any number of threads, without shared state.

/// Random numbers of one replan.
#[derive(Clone, Copy, Debug)]
pub struct CounterRng {
    key: u64,
}

/// Increment of the Weyl sequence of SplitMix64: 2^64 over the golden ratio.
const WEYL_INCREMENT: u64 = 0x9e37_79b9_7f4a_7c15;

/// 2^-16, which maps 16 bits to [0, 1).
const UNIT_PER_U16: f64 = 1.0 / 65536.0;

/// 2^-32, which maps 32 bits to [0, 1).
const UNIT_PER_U32: f64 = 1.0 / 4_294_967_296.0;

/// √3 = 1/√(4/12): four uniform numbers have the variance 4/12.
const SQRT_3: f64 = 1.732_050_807_568_877_2;

impl CounterRng {
    /// With a key.
    pub fn new(key: u64) -> Self {
        Self { key }
    }

    /// 64 random bits: SplitMix64 (Steele, Lea, Flood 2014) at position `counter` of its sequence.
    #[inline]
    pub fn bits(self, counter: u64) -> u64 {
        let mut bits = self.key.wrapping_add(counter.wrapping_add(1).wrapping_mul(WEYL_INCREMENT));
        bits = (bits ^ (bits >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        bits = (bits ^ (bits >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        bits ^ (bits >> 31)
    }

    /// Two uniform numbers in [0, 1) with 32 bits each.
    #[inline]
    pub fn uniform_pair(self, counter: u64) -> [f64; 2] {
        let bits = self.bits(counter);
        [(bits >> 32) as f64 * UNIT_PER_U32, (bits & 0xffff_ffff) as f64 * UNIT_PER_U32]
    }

    /// An approximately normal number of mean 0 and variance 1: the scaled sum of four uniform numbers, within ±3.46. It
    /// is equal to the bit on every machine, unlike transforms that use logarithms and cosines.
    #[inline]
    pub fn normal(self, counter: u64) -> f64 {
        let bits = self.bits(counter);
        let sum = (bits & 0xffff) + ((bits >> 16) & 0xffff) + ((bits >> 32) & 0xffff) + (bits >> 48);
        // each of the four is rounded down by half a unit on average: + 2
        ((sum as f64 + 2.0) * UNIT_PER_U16 - 2.0) * SQRT_3
    }
}

#[cfg(test)]
mod tests {
    use super::CounterRng;

    #[test]
    fn moments_are_those_of_the_distributions() {
        let rng = CounterRng::new(7);
        let n = 200_000;
        let mean = |of: &dyn Fn(u64) -> f64| (0..n).map(of).sum::<f64>() / n as f64;
        assert!(mean(&|i| rng.normal(i)).abs() < 0.01);
        assert!((mean(&|i| rng.normal(i).powi(2)) - 1.0).abs() < 0.01);
        // kurtosis: 3 for a normal variable, 2.7 for the sum of four uniform ones
        assert!((mean(&|i| rng.normal(i).powi(4)) - 2.7).abs() < 0.05);
        let product = mean(&|i| {
            let [a, b] = rng.uniform_pair(i);
            (a - 0.5) * (b - 0.5)
        });
        assert!(product.abs() < 0.001, "{product}");
        let neighbours = mean(&|i| rng.normal(i) * rng.normal(i + 1));
        assert!(neighbours.abs() < 0.01, "{neighbours}");
    }
}
