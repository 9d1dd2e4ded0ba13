use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;

/// A stream of random numbers of its own for every `name`, the same for the same `seed` on every machine.
///
/// Whoever draws takes a stream by a name that nobody else uses (`"gusts/uav-3"`), so that what one part draws never
/// depends on how much another part has drawn. The name enters by the 64-bit FNV-1a hash.
pub fn stream(seed: u64, name: &str) -> ChaCha8Rng {
    let hash = name
        .bytes()
        .fold(0xcbf2_9ce4_8422_2325_u64, |hash, byte| (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3));
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    rng.set_stream(hash);
    rng
}

#[cfg(test)]
mod tests {
    use rand::Rng;

    use super::stream;

    #[test]
    fn streams_are_reproducible_and_independent() {
        let draw = |seed, name| stream(seed, name).next_u64();
        assert_eq!(draw(1, "gusts/uav-1"), draw(1, "gusts/uav-1"));
        assert_ne!(draw(1, "gusts/uav-1"), draw(1, "gusts/uav-2"));
        assert_ne!(draw(1, "gusts/uav-1"), draw(2, "gusts/uav-1"));
    }
}
