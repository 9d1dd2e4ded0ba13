//! Dense kernels on small row-major matrices of fixed size, without allocation.
//!
//! Code on lanes uses loops instead of closures: a closure is a function of its own and would be compiled without the
//! vector instructions of the enclosing function.

use crate::simd::{Lanes, Simd4};

/// A matrix of M rows and N columns.
pub type Matrix<S, const M: usize, const N: usize> = [[Lanes<S>; N]; M];

/// Triangular square root R of a positive definite `A = R^T R`, upper, with the reciprocals of its diagonal.
///
/// R is computed from square roots of the terms of A, never from A itself: weights that differ by twenty orders of
/// magnitude differ by ten in R, which double precision resolves.
#[derive(Clone, Debug)]
pub struct SquareRoot<S: Simd4, const N: usize> {
    upper: Matrix<S, N, N>,
    inverse_diagonal: [Lanes<S>; N],
}

impl<S: Simd4, const N: usize> SquareRoot<S, N> {
    /// The root of zero.
    #[inline(always)]
    pub fn zero(simd: S) -> Self {
        let zero = Lanes::splat(simd, 0.0);
        Self { upper: [[zero; N]; N], inverse_diagonal: [zero; N] }
    }

    /// The root of zero, with the vector instructions of `zero`, which must be zero.
    #[inline(always)]
    pub fn zero_like(zero: Lanes<S>) -> Self {
        Self { upper: [[zero; N]; N], inverse_diagonal: [zero; N] }
    }

    /// `A <- diag(diagonal)`, all entries >= 0.
    #[inline(always)]
    pub fn set_diagonal(&mut self, diagonal: &[Lanes<S>; N]) {
        for j in 0..N {
            self.upper[j] = [diagonal[j].like(0.0); N];
            self.upper[j][j] = diagonal[j].sqrt();
        }
    }

    /// Row `i` of R.
    #[inline(always)]
    pub fn row(&self, i: usize) -> &[Lanes<S>; N] {
        &self.upper[i]
    }

    /// `A += rows^T rows` by Householder reflections of R and the rows below it. Overwrites `rows`.
    #[inline(always)]
    pub fn append<const M: usize>(&mut self, rows: &mut Matrix<S, M, N>) {
        self.append_with_tail::<M, 0>(rows, &mut [[]; N], &mut [[]; M]);
    }

    /// The same for the wider matrix [R, T] with [`rows`, `tail`] below it. Afterwards `tail` holds rows in the
    /// variables of T alone.
    #[inline(always)]
    pub fn append_with_tail<const M: usize, const W: usize>(
        &mut self,
        rows: &mut Matrix<S, M, N>,
        t: &mut Matrix<S, N, W>,
        tail: &mut Matrix<S, M, W>,
    ) {
        for j in 0..N {
            let reflection = Reflection::new(self.upper[j][j], rows, j);
            self.upper[j][j] = reflection.norm;
            for k in j + 1..N {
                reflection.apply(&mut self.upper[j][k], rows, k);
            }
            for k in 0..W {
                reflection.apply(&mut t[j][k], tail, k);
            }
        }
    }

    /// Completes the factorisation; to be called after the last term of A has been added.
    #[inline(always)]
    pub fn finish(&mut self) {
        for j in 0..N {
            self.inverse_diagonal[j] = self.upper[j][j].recip();
        }
    }

    /// `b <- R^-T b`, columns of `b` at once.
    #[inline(always)]
    pub fn solve_transposed<const M: usize>(&self, b: &mut Matrix<S, N, M>) {
        for i in 0..N {
            for column in 0..M {
                let mut value = b[i][column];
                for k in 0..i {
                    value = (-self.upper[k][i]).mul_add(b[k][column], value);
                }
                b[i][column] = value * self.inverse_diagonal[i];
            }
        }
    }

    /// `b <- R^-1 b`, columns of `b` at once.
    #[inline(always)]
    pub fn solve<const M: usize>(&self, b: &mut Matrix<S, N, M>) {
        for j in (0..N).rev() {
            for column in 0..M {
                let value = b[j][column] * self.inverse_diagonal[j];
                b[j][column] = value;
                for i in 0..j {
                    b[i][column] = (-self.upper[i][j]).mul_add(value, b[i][column]);
                }
            }
        }
    }
}

/// The Householder reflection that takes (a, x) to (norm, 0).
struct Reflection<S: Simd4, const M: usize> {
    x: [Lanes<S>; M],
    norm: Lanes<S>,
    /// a and 1/norm; both 1 in lanes where x is zero, so that the reflection is exactly the identity there.
    a: Lanes<S>,
    inverse_norm: Lanes<S>,
    /// 1/(w norm), w = norm - a.
    inverse_w_norm: Lanes<S>,
}

impl<S: Simd4, const M: usize> Reflection<S, M> {
    #[inline(always)]
    fn new<const N: usize>(a: Lanes<S>, rows: &Matrix<S, M, N>, j: usize) -> Self {
        let (zero, one) = (a.like(0.0), a.like(1.0));
        let mut x = [zero; M];
        for i in 0..M {
            x[i] = rows[i][j];
        }
        let below = dot(&x, &x);
        let reflects = below.is_above(a.like(f64::MIN_POSITIVE));
        let norm = a.mul_add(a, below).sqrt();
        let inverse_norm = norm.recip();
        Self {
            x,
            norm: reflects.select(norm, a),
            a: reflects.select(a, one),
            inverse_norm: reflects.select(inverse_norm, one),
            // norm - a = below/(a + norm)
            inverse_w_norm: reflects.select((a * inverse_norm + one) * below.recip(), zero),
        }
    }

    /// Reflects another column: `above` in the row of a, and column `k` of `rows` below it.
    #[inline(always)]
    fn apply<const N: usize>(&self, above: &mut Lanes<S>, rows: &mut Matrix<S, M, N>, k: usize) {
        let mut column = self.x;
        for i in 0..M {
            column[i] = rows[i][k];
        }
        let product = dot(&self.x, &column);
        let factor = *above * self.inverse_norm - product * self.inverse_w_norm;
        *above = self.a.mul_add(*above, product) * self.inverse_norm;
        for i in 0..M {
            rows[i][k] = factor.mul_add(self.x[i], column[i]);
        }
    }
}

/// x · y in two independent sums, which shortens the chain of dependent additions.
#[inline(always)]
fn dot<S: Simd4, const M: usize>(x: &[Lanes<S>; M], y: &[Lanes<S>; M]) -> Lanes<S> {
    let (mut even, mut odd) = (x[0].like(0.0), x[0].like(0.0));
    for i in 0..M / 2 {
        even = x[2 * i].mul_add(y[2 * i], even);
        odd = x[2 * i + 1].mul_add(y[2 * i + 1], odd);
    }
    if M % 2 == 1 {
        even = x[M - 1].mul_add(y[M - 1], even);
    }
    even + odd
}

/// `out += A^T v`.
#[inline(always)]
pub fn add_transposed_product<S: Simd4, const M: usize, const N: usize, const C: usize>(
    out: &mut Matrix<S, N, C>,
    a: &Matrix<S, M, N>,
    v: &Matrix<S, M, C>,
) {
    for (row, v) in a.iter().zip(v) {
        for (out, &a) in out.iter_mut().zip(row) {
            for c in 0..C {
                out[c] = a.mul_add(v[c], out[c]);
            }
        }
    }
}

/// `out -= A^T v`.
#[inline(always)]
pub fn subtract_transposed_product<S: Simd4, const M: usize, const N: usize, const C: usize>(
    out: &mut Matrix<S, N, C>,
    a: &Matrix<S, M, N>,
    v: &Matrix<S, M, C>,
) {
    for (row, v) in a.iter().zip(v) {
        for (out, &a) in out.iter_mut().zip(row) {
            for c in 0..C {
                out[c] = (-a).mul_add(v[c], out[c]);
            }
        }
    }
}

/// `out -= A v`, with as many columns of A as `v` has rows.
#[inline(always)]
pub fn subtract_product<S: Simd4, const M: usize, const N: usize, const C: usize>(
    out: &mut Matrix<S, M, C>,
    a: &Matrix<S, M, N>,
    v: &Matrix<S, N, C>,
) {
    for (out, row) in out.iter_mut().zip(a) {
        for (&a, v) in row.iter().zip(v) {
            for c in 0..C {
                out[c] = (-a).mul_add(v[c], out[c]);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::{SMatrix, SVector};
    use pulp::Scalar256b;

    use super::{Lanes, SquareRoot};

    fn lanes(value: f64) -> Lanes<Scalar256b> {
        Lanes::splat(Scalar256b, value)
    }

    #[test]
    fn square_root_solves_with_the_sum_of_its_terms() {
        let rows = SMatrix::<f64, 6, 9>::from_fn(|i, j| ((3 * i + 7 * j) as f64).sin());
        let diagonal = SVector::<f64, 9>::from_fn(|i, _| 10_f64.powi(i as i32 - 4));
        let full = SMatrix::<f64, 9, 9>::from_diagonal(&diagonal) + rows.transpose() * rows;
        let rhs = SVector::<f64, 9>::from_fn(|i, _| (i as f64).cos());

        let mut root = SquareRoot::<_, 9>::zero(Scalar256b);
        root.set_diagonal(&std::array::from_fn(|i| lanes(diagonal[i])));
        root.append::<6>(&mut std::array::from_fn(|i| std::array::from_fn(|j| lanes(rows[(i, j)]))));
        root.finish();
        let mut x: [_; 9] = std::array::from_fn(|i| [lanes(rhs[i])]);
        root.solve_transposed(&mut x);
        root.solve(&mut x);
        for lane in 0..4 {
            let x = SVector::<f64, 9>::from_fn(|i, _| x[i][0].lane(lane));
            assert!((full * x - rhs).amax() < 1e-9);
        }
    }

    /// diag(ε²) + (1, 1)^T (1, 1) has the small eigenvalue ε²; in the matrix itself, ε² = 1e-18 would be rounded away.
    #[test]
    fn square_root_resolves_a_soft_direction_beside_a_stiff_one() {
        let ε = 1e-9;
        let mut root = SquareRoot::<_, 2>::zero(Scalar256b);
        root.set_diagonal(&[lanes(ε * ε); 2]);
        root.append(&mut [[lanes(1.0); 2]]);
        root.finish();
        let mut x = [[lanes(1.0)], [lanes(-1.0)]];
        root.solve_transposed(&mut x);
        root.solve(&mut x);
        assert!((x[0][0].lane(0) * ε * ε - 1.0).abs() < 1e-6, "{x:?}");
    }

    /// Rows that are zero in some or in all columns must not produce NaN.
    #[test]
    fn zero_rows_change_nothing() {
        let mut root = SquareRoot::<_, 3>::zero(Scalar256b);
        root.append(&mut [[lanes(0.0), lanes(2.0), lanes(1.0)], [lanes(0.0); 3]]);
        let before = [0, 1, 2].map(|i| root.row(i).map(|value| value.lane(0)));
        assert_eq!(before, [[0.0; 3], [0.0, 2.0, 1.0], [0.0; 3]]);
        let mut again = root.clone();
        again.append(&mut [[lanes(0.0); 3]; 4]);
        assert_eq!([0, 1, 2].map(|i| again.row(i).map(|value| value.lane(0))), before);
    }
}
