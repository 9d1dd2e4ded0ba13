//! Sums and maxima over long vectors, in [`LANES`] accumulators: a compiler may not reorder a floating-point sum, so the
//! order that suits vector registers is written down. It is the same on every machine.

/// Number of accumulators.
const LANES: usize = 8;

/// Σ term(a_i, b_i).
pub fn sum(a: &[f64], b: &[f64], term: impl Fn(f64, f64) -> f64) -> f64 {
    let mut lanes = [0.0; LANES];
    let (a_chunks, a_rest) = a.as_chunks::<LANES>();
    let (b_chunks, b_rest) = b.as_chunks::<LANES>();
    for (a, b) in a_chunks.iter().zip(b_chunks) {
        for i in 0..LANES {
            lanes[i] += term(a[i], b[i]);
        }
    }
    let rest: f64 = a_rest.iter().zip(b_rest).map(|(a, b)| term(*a, *b)).sum();
    lanes.iter().sum::<f64>() + rest
}

/// Largest term(a_i, b_i), at least 0. A NaN counts as nothing.
pub fn largest(a: &[f64], b: &[f64], term: impl Fn(f64, f64) -> f64) -> f64 {
    let larger = |value: f64, so_far: f64| if value > so_far { value } else { so_far };
    let mut lanes = [0.0; LANES];
    let (a_chunks, a_rest) = a.as_chunks::<LANES>();
    let (b_chunks, b_rest) = b.as_chunks::<LANES>();
    for (a, b) in a_chunks.iter().zip(b_chunks) {
        for i in 0..LANES {
            lanes[i] = larger(term(a[i], b[i]), lanes[i]);
        }
    }
    let rest = a_rest.iter().zip(b_rest).map(|(a, b)| term(*a, *b));
    rest.chain(lanes).fold(0.0, |so_far, value| larger(value, so_far))
}

#[cfg(test)]
mod tests {
    use super::{largest, sum};

    #[test]
    fn agree_with_plain_loops_at_every_length() {
        for n in 0..30 {
            let a: Vec<f64> = (0..n).map(|i| f64::from(i * 7 % 13) - 5.0).collect();
            let b: Vec<f64> = (0..n).map(|i| f64::from(i * 5 % 11) - 3.0).collect();
            let products = || a.iter().zip(&b).map(|(a, b)| a * b);
            assert_eq!(sum(&a, &b, |a, b| a * b), products().sum::<f64>(), "length {n}");
            assert_eq!(largest(&a, &b, |a, b| a * b), products().fold(0.0, f64::max), "length {n}");
        }
    }
}
