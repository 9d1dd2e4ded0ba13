//! Dense kernels on small matrices of fixed size, without allocation.

use nalgebra::{SMatrix, SVector};

/// Triangular square root R of a positive definite `A = R^T R`, upper, with the reciprocals of its diagonal.
///
/// It is built from square roots of the terms of A, never from A itself: weights that differ by twenty orders of
/// magnitude differ by ten in R, which double precision still tells apart.
#[derive(Clone, Debug)]
pub struct SquareRoot<const N: usize> {
    upper: SMatrix<f64, N, N>,
    inverse_diagonal: SVector<f64, N>,
}

impl<const N: usize> SquareRoot<N> {
    /// Room for a root.
    pub fn zero() -> Self {
        Self { upper: SMatrix::zeros(), inverse_diagonal: SVector::zeros() }
    }

    /// Starts over with `A = diag(diagonal)`, all > 0.
    pub fn set_diagonal(&mut self, diagonal: &SVector<f64, N>) {
        self.upper.fill(0.0);
        for j in 0..N {
            self.upper[(j, j)] = diagonal[j].sqrt();
        }
    }

    /// `A += rows^T rows` by Householder reflections of R with the rows below it; `rows` is used up.
    pub fn append<const M: usize>(&mut self, rows: &mut SMatrix<f64, M, N>) {
        self.append_with_tail::<M, 0>(rows, &mut SMatrix::zeros(), &mut SMatrix::zeros());
    }

    /// The same for the wider matrix [R, T] with [`rows`, `tail`] below it: what is left of `tail` belongs to the
    /// variables of T alone.
    pub fn append_with_tail<const M: usize, const W: usize>(
        &mut self,
        rows: &mut SMatrix<f64, M, N>,
        t: &mut SMatrix<f64, N, W>,
        tail: &mut SMatrix<f64, M, W>,
    ) {
        for j in 0..N {
            let x: SVector<f64, M> = rows.column(j).into_owned();
            let below = x.norm_squared();
            let a = self.upper[(j, j)];
            if below <= f64::EPSILON * f64::EPSILON * a * a {
                continue;
            }
            let norm = (a * a + below).sqrt();
            let w = below / (a + norm);
            let (inverse_norm, inverse_w) = (1.0 / norm, 1.0 / w);
            self.upper[(j, j)] = norm;
            for k in j + 1..N {
                let mut other = rows.column_mut(k);
                let (above, product) = (self.upper[(j, k)], x.dot(&other));
                self.upper[(j, k)] = (a * above + product) * inverse_norm;
                other.axpy((above - product * inverse_w) * inverse_norm, &x, 1.0);
            }
            for k in 0..W {
                let mut other = tail.column_mut(k);
                let (above, product) = (t[(j, k)], x.dot(&other));
                t[(j, k)] = (a * above + product) * inverse_norm;
                other.axpy((above - product * inverse_w) * inverse_norm, &x, 1.0);
            }
        }
    }

    /// R as far as it has got.
    pub fn upper(&self) -> &SMatrix<f64, N, N> {
        &self.upper
    }

    /// To be called when every term of A has been added.
    pub fn finish(&mut self) {
        self.inverse_diagonal = self.upper.diagonal().map(|pivot| 1.0 / pivot);
    }

    /// `b <- R^-T b`, columns of `b` at once.
    pub fn solve_transposed<const M: usize>(&self, b: &mut SMatrix<f64, N, M>) {
        for column in 0..M {
            for i in 0..N {
                let mut value = b[(i, column)];
                for k in 0..i {
                    value -= self.upper[(k, i)] * b[(k, column)];
                }
                b[(i, column)] = value * self.inverse_diagonal[i];
            }
        }
    }

    /// `b <- R^-1 b`.
    pub fn solve(&self, b: &mut SVector<f64, N>) {
        for j in (0..N).rev() {
            let value = b[j] * self.inverse_diagonal[j];
            b[j] = value;
            for i in 0..j {
                b[i] -= self.upper[(i, j)] * value;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::{SMatrix, SVector};

    use super::SquareRoot;

    #[test]
    fn square_root_solves_with_the_sum_of_its_terms() {
        let rows = SMatrix::<f64, 6, 9>::from_fn(|i, j| ((3 * i + 7 * j) as f64).sin());
        let diagonal = SVector::<f64, 9>::from_fn(|i, _| 10_f64.powi(i as i32 - 4));
        let full = SMatrix::<f64, 9, 9>::from_diagonal(&diagonal) + rows.transpose() * rows;
        let rhs = SVector::<f64, 9>::from_fn(|i, _| (i as f64).cos());

        let mut root = SquareRoot::zero();
        root.set_diagonal(&diagonal);
        root.append(&mut rows.clone());
        root.finish();
        let mut x = rhs;
        root.solve_transposed(&mut x);
        root.solve(&mut x);
        assert!((full * x - rhs).amax() < 1e-9);
    }

    /// diag(ε²) + (1, 1)^T (1, 1) has the small eigenvalue ε²: formed as a matrix, ε = 1e-9 would vanish in it.
    #[test]
    fn soft_direction_beside_a_stiff_one_survives() {
        let ε = 1e-9;
        let mut root = SquareRoot::<2>::zero();
        root.set_diagonal(&SVector::from([ε * ε; 2]));
        root.append(&mut SMatrix::<f64, 1, 2>::from([[1.0], [1.0]]));
        root.finish();
        let mut x = SVector::from([1.0, -1.0]);
        root.solve_transposed(&mut x);
        root.solve(&mut x);
        assert!((x[0] * ε * ε - 1.0).abs() < 1e-6, "{x}");
    }
}
