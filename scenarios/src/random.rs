use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;

/// An independent stream of random numbers for each `name`, reproducible from `seed` on every machine.
///
/// Each consumer uses a name of its own (`"gusts/uav-3"`), so that its numbers do not depend on how many others draw.
/// The stream is selected by the 64-bit FNV-1a hash of the name.
///
/// # Examples
///
/// ```
/// use rand::Rng;
///
/// let draw = |name| scenarios::stream(7, name).next_u64();
/// assert_eq!(draw("gusts/uav-1"), draw("gusts/uav-1"));
/// assert_ne!(draw("gusts/uav-1"), draw("gusts/uav-2"));
/// ```
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
