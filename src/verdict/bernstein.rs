//! Polynomials in Bernstein form, and their smallest value by branch and bound.
//!
//! On [0, 1] a polynomial lies inside the convex hull of its Bernstein coefficients, so its smallest coefficient bounds
//! it from below, while its end coefficients are values that it takes. Halving the interval (de Casteljau) brings the
//! two together quadratically. No sampling: a dip between two samples cannot hide.
//!
//! Farin (2002), Curves and Surfaces for CAGD, chapters 4 and 6.

/// Most halvings of an interval, and most intervals looked at for one polynomial. Beyond them the bounds stay apart,
/// and the check becomes undecided rather than wrong.
const MAX_DEPTH: u32 = 52;
const MAX_INTERVALS: u32 = 4000;

/// Bounds of the smallest value that a polynomial takes on [0, 1].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Minimum {
    /// No value is below this one, or below the value that had to be beaten.
    pub lower: f64,
    /// A value that is taken at `at`; the value that had to be beaten if none is smaller.
    pub upper: f64,
    /// Where `upper` is taken, in [0, 1]; `None` if the value that had to be beaten was not.
    pub at: Option<f64>,
}

/// Smallest value on [0, 1] of the polynomial with the `N` Bernstein coefficients `c`, as far as it is below `beat`.
///
/// - `beat`: best value known so far; an interval that cannot be below it is given up at once
/// - `tolerance`: of the best value, the distance between the bounds that is close enough, > 0, both in the unit of `c`
///
/// A coefficient that is not finite makes the lower bound -∞.
pub fn minimise<const N: usize>(c: &[f64; N], beat: f64, tolerance: impl Fn(f64) -> f64) -> Minimum {
    let mut search = Search { lower: beat, upper: beat, at: None, intervals: 0, tolerance };
    if c.iter().all(|coefficient| coefficient.is_finite()) {
        search.descend(c, [0.0, 1.0], 0);
    } else {
        search.lower = f64::NEG_INFINITY;
    }
    Minimum { lower: search.lower.min(search.upper), upper: search.upper, at: search.at }
}

struct Search<F> {
    lower: f64,
    upper: f64,
    at: Option<f64>,
    intervals: u32,
    tolerance: F,
}

impl<F: Fn(f64) -> f64> Search<F> {
    fn descend<const N: usize>(&mut self, c: &[f64; N], span: [f64; 2], depth: u32) {
        self.intervals += 1;
        self.try_value(c[0], span[0]);
        self.try_value(c[N - 1], span[1]);
        let bound = smallest(c);
        let close_enough = bound >= self.upper - (self.tolerance)(self.upper);
        if close_enough || depth == MAX_DEPTH || self.intervals >= MAX_INTERVALS {
            self.lower = self.lower.min(bound);
            return;
        }
        let middle = 0.5 * (span[0] + span[1]);
        let (left, right) = split(c, 0.5);
        let (left_span, right_span) = ([span[0], middle], [middle, span[1]]);
        if smallest(&left) <= smallest(&right) {
            self.descend(&left, left_span, depth + 1);
            self.descend(&right, right_span, depth + 1);
        } else {
            self.descend(&right, right_span, depth + 1);
            self.descend(&left, left_span, depth + 1);
        }
    }

    fn try_value(&mut self, value: f64, at: f64) {
        if value < self.upper {
            self.upper = value;
            self.at = Some(at);
        }
    }
}

/// Coefficients on [0, u] and on [u, 1], each again over [0, 1] (de Casteljau).
pub fn split<const N: usize>(c: &[f64; N], u: f64) -> ([f64; N], [f64; N]) {
    let (mut left, mut right) = (*c, *c);
    for (round, first) in left.iter_mut().enumerate() {
        *first = right[0];
        for i in 0..N - 1 - round {
            right[i] += u * (right[i + 1] - right[i]);
        }
    }
    (left, right)
}

/// |p|² of the cubic with the control points `p`, as the 7 Bernstein coefficients of its degree 6:
/// c_k = Σ_{i+j=k} C(3,i) C(3,j) / C(6,k) p_i·p_j.
pub fn squared_norm(p: &[[f64; 3]; 4]) -> [f64; 7] {
    let dot = |i: usize, j: usize| p[i][0] * p[j][0] + p[i][1] * p[j][1] + p[i][2] * p[j][2];
    [
        dot(0, 0),
        dot(0, 1),
        0.4 * dot(0, 2) + 0.6 * dot(1, 1),
        0.1 * dot(0, 3) + 0.9 * dot(1, 2),
        0.4 * dot(1, 3) + 0.6 * dot(2, 2),
        dot(2, 3),
        dot(3, 3),
    ]
}

fn smallest<const N: usize>(c: &[f64; N]) -> f64 {
    c.iter().copied().fold(f64::INFINITY, f64::min)
}

#[cfg(test)]
mod tests {
    use super::{minimise, split, squared_norm};
    use crate::verdict::random::Uniform;

    fn value<const N: usize>(c: &[f64; N], u: f64) -> f64 {
        split(c, u).0[N - 1]
    }

    /// (u - r)² has the Bernstein coefficients r², r² - r, (1 - r)².
    #[test]
    fn a_parabola_is_minimised_where_calculus_says() {
        for root in [0.0, 0.1, 1.0 / 3.0, 0.5, 0.987, 1.0] {
            let c = [root * root + 2.0, root * root - root + 2.0, (1.0 - root) * (1.0 - root) + 2.0];
            let minimum = minimise(&c, f64::INFINITY, |_| 1e-12);
            assert!(minimum.lower <= 2.0 && 2.0 <= minimum.upper + 1e-15, "{minimum:?}");
            assert!(minimum.upper - minimum.lower <= 1e-12);
            assert!((minimum.at.unwrap() - root).abs() < 2e-6);
        }
    }

    #[test]
    fn random_polynomials_never_dip_below_the_lower_bound_and_reach_the_upper() {
        let mut uniform = Uniform::seeded(1);
        for _ in 0..2000 {
            let p: [[f64; 3]; 4] = std::array::from_fn(|_| std::array::from_fn(|_| uniform.between(-50.0, 50.0)));
            let c = squared_norm(&p);
            let minimum = minimise(&c, f64::INFINITY, |_| 1e-9);
            let sampled = (0..=1000).map(|i| value(&c, f64::from(i) / 1000.0)).fold(f64::INFINITY, f64::min);
            assert!(minimum.upper - minimum.lower <= 1e-9, "{minimum:?}");
            assert!(sampled >= minimum.lower - 1e-9, "{sampled} below {minimum:?}");
            assert!(sampled - minimum.upper <= 1.0, "{sampled} far above {minimum:?}");
            assert!((value(&c, minimum.at.unwrap()) - minimum.upper).abs() < 1e-9);
        }
    }

    #[test]
    fn squared_norm_is_the_square_of_the_cubic() {
        let mut uniform = Uniform::seeded(2);
        let p: [[f64; 3]; 4] = std::array::from_fn(|_| std::array::from_fn(|_| uniform.between(-3.0, 3.0)));
        let c = squared_norm(&p);
        for u in [0.0, 0.2, 0.5, 0.9, 1.0] {
            let squares: f64 =
                (0..3).map(|axis| value(&[p[0][axis], p[1][axis], p[2][axis], p[3][axis]], u).powi(2)).sum();
            assert!((value(&c, u) - squares).abs() < 1e-12);
        }
    }

    #[test]
    fn a_value_to_beat_that_is_not_beaten_stays() {
        let minimum = minimise(&[5.0, 4.0, 5.0], 3.0, |_| 1e-9);
        assert_eq!((minimum.lower, minimum.upper, minimum.at), (3.0, 3.0, None));
    }

    #[test]
    fn coefficients_that_are_not_finite_leave_no_lower_bound() {
        for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            assert_eq!(minimise(&[1.0, bad, 1.0], f64::INFINITY, |_| 1e-9).lower, f64::NEG_INFINITY);
        }
    }

    #[test]
    fn a_tolerance_below_rounding_ends_all_the_same() {
        let minimum = minimise(&[1e18, 1e18 + 1024.0, 1e18 - 512.0, 1e18], f64::INFINITY, |_| 1e-9);
        assert!(minimum.lower <= minimum.upper);
    }
}
