//! One hash for a whole flight: flights that differ in one bit of one number have different hashes.

use crate::flight::{Flight, LoadSample, Sample};

/// Prime and offset of the 64-bit FNV-1a hash, here over words of 64 bits.
const PRIME: u64 = 0x0100_0000_01b3;
const OFFSET: u64 = 0xcbf2_9ce4_8422_2325;

/// A hash that is updated number by number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct StateHash(u64);

impl Default for StateHash {
    fn default() -> Self {
        Self(OFFSET)
    }
}

impl StateHash {
    /// Updates the hash with the bits of a number.
    pub fn add(&mut self, number: f64) {
        // A product moves bits only upwards; the shift moves the upper ones down.
        let mixed = (self.0 ^ number.to_bits()).wrapping_mul(PRIME);
        self.0 = mixed ^ (mixed >> 32);
    }

    /// The hash as 16 hexadecimal digits.
    pub fn digits(&self) -> String {
        format!("{:016x}", self.0)
    }
}

impl Flight {
    /// Hashes of everything that was logged until the end of each period of `every_s`, s, and until the end of the
    /// flight, in the order of time.
    pub fn running_hash(&self, every_s: f64) -> Vec<StateHash> {
        let mut hash = StateHash::default();
        let mut running = Vec::new();
        let steps = self.vehicles.iter().map(|log| log.samples.len()).max().unwrap_or(0);
        let mut next_s = every_s;
        for step in 0..steps {
            let t_s = self.vehicles.iter().find_map(|log| log.samples.get(step)).map_or(f64::NAN, |sample| sample.t_s);
            if t_s >= next_s {
                running.push(hash);
                next_s += every_s;
            }
            for log in &self.vehicles {
                let sample = log.samples.get(step).into_iter().flat_map(Sample::numbers);
                let load = log.loads.get(step).into_iter().flat_map(LoadSample::numbers);
                sample.chain(load).for_each(|number| hash.add(number));
            }
        }
        self.events.iter().for_each(|event| hash.add(event.t_s));
        running.push(hash);
        running
    }
}

#[cfg(test)]
mod tests {
    use super::StateHash;

    fn hash_of(numbers: &[f64]) -> StateHash {
        let mut hash = StateHash::default();
        numbers.iter().for_each(|number| hash.add(*number));
        hash
    }

    #[test]
    fn one_bit_and_the_order_change_the_hash() {
        let number = 0.1_f64;
        assert_eq!(hash_of(&[number, 2.0]), hash_of(&[0.1, 2.0]));
        assert_ne!(hash_of(&[number]), hash_of(&[number.next_up()]));
        assert_ne!(hash_of(&[1.0, 2.0]), hash_of(&[2.0, 1.0]));
        assert_ne!(hash_of(&[0.0]), hash_of(&[-0.0]));
    }

    #[test]
    fn an_early_difference_persists() {
        let long: Vec<f64> = (0..10_000).map(f64::from).collect();
        for bit in [0, 31, 32, 62] {
            let mut other = long.clone();
            other[3] = f64::from_bits(other[3].to_bits() ^ (1 << bit));
            assert_ne!(hash_of(&long), hash_of(&other), "bit {bit}");
        }
    }
}
