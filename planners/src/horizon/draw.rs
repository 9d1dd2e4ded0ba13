//! Random numbers by counting: a number belongs to its place, not to the order in which numbers are drawn.
//!
//! Every replan takes a key from the planner's stream; the number of particle i, iteration k, coordinate d is a hash of
//! the key and (k, i, d). So the same seed gives the same swarm on any number of threads, with no state to hand around.

/// Numbers of one replan.
#[derive(Clone, Copy, Debug)]
pub struct Draws {
    key: u64,
}

/// Increment of the Weyl sequence under SplitMix64: 2^64 over the golden ratio.
const GOLDEN: u64 = 0x9e37_79b9_7f4a_7c15;

/// Below this, a number of 16 bits is a share of one.
const SHARE_16: f64 = 1.0 / 65536.0;

/// The same for 32 bits.
const SHARE_32: f64 = 1.0 / 4_294_967_296.0;

impl Draws {
    /// With that key.
    pub fn new(key: u64) -> Self {
        Self { key }
    }

    /// 64 random bits for a place: SplitMix64 (Steele, Lea, Flood 2014) at position `place` of its sequence.
    #[inline]
    pub fn bits(self, place: u64) -> u64 {
        let mut bits = self.key.wrapping_add(place.wrapping_add(1).wrapping_mul(GOLDEN));
        bits = (bits ^ (bits >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        bits = (bits ^ (bits >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        bits ^ (bits >> 31)
    }

    /// Two uniform numbers in [0, 1) for a place, with 32 bits each.
    #[inline]
    pub fn uniform_pair(self, place: u64) -> [f64; 2] {
        let bits = self.bits(place);
        [(bits >> 32) as f64 * SHARE_32, (bits & 0xffff_ffff) as f64 * SHARE_32]
    }

    /// A number of mean 0 and variance 1 for a place, close to normal: the sum of four uniform ones (within ±3.46). Made of
    /// additions alone, it has the same digits on every machine, which logarithms and cosines have not.
    #[inline]
    pub fn normal(self, place: u64) -> f64 {
        let bits = self.bits(place);
        let sum = (bits & 0xffff) + ((bits >> 16) & 0xffff) + ((bits >> 32) & 0xffff) + (bits >> 48);
        // each has variance 1/12, and half a step is missing on average
        ((sum as f64 + 2.0) * SHARE_16 - 2.0) * SQRT_3
    }
}

/// √(12/4).
const SQRT_3: f64 = 1.732_050_807_568_877_2;

#[cfg(test)]
mod tests {
    use super::Draws;

    #[test]
    fn moments_are_those_of_the_distributions() {
        let draws = Draws::new(7);
        let n = 200_000;
        let mean = |of: &dyn Fn(u64) -> f64| (0..n).map(of).sum::<f64>() / n as f64;
        assert!(mean(&|i| draws.normal(i)).abs() < 0.01);
        assert!((mean(&|i| draws.normal(i).powi(2)) - 1.0).abs() < 0.01);
        // a normal variable has 3, the sum of four uniform ones 2.7
        assert!((mean(&|i| draws.normal(i).powi(4)) - 2.7).abs() < 0.05);
        let product = mean(&|i| {
            let [a, b] = draws.uniform_pair(i);
            (a - 0.5) * (b - 0.5)
        });
        assert!(product.abs() < 0.001, "{product}");
        let neighbours = mean(&|i| draws.normal(i) * draws.normal(i + 1));
        assert!(neighbours.abs() < 0.01, "{neighbours}");
    }
}
