//! Dense kernels on small row-major matrices. Rows are padded to a multiple of [`LANES`] columns, so that whole tiles
//! stay in vector registers. Multiplications and additions are not fused, so results do not depend on the processor.

/// Number of columns to whose multiples rows are padded.
pub const LANES: usize = 8;

/// Number of rows of a tile.
const TILE: usize = 4;

/// `count` rounded up to a multiple of [`LANES`].
pub fn padded(count: usize) -> usize {
    count.next_multiple_of(LANES)
}

/// `to += factor from`.
#[inline(always)]
pub fn add_scaled(to: &mut [f64], factor: f64, from: &[f64]) {
    for (to, from) in to.iter_mut().zip(from) {
        *to += factor * from;
    }
}

/// Inner product, by four partial sums on every processor.
#[inline(always)]
pub fn dot(a: &[f64], b: &[f64]) -> f64 {
    let count = a.len().min(b.len());
    let ((a, a_rest), (b, b_rest)) = (a[..count].as_chunks::<4>(), b[..count].as_chunks::<4>());
    let mut sums = [0.0; 4];
    for (a, b) in a.iter().zip(b) {
        for k in 0..4 {
            sums[k] += a[k] * b[k];
        }
    }
    let rest: f64 = a_rest.iter().zip(b_rest).map(|(a, b)| a * b).sum();
    (sums[0] + sums[1]) + (sums[2] + sums[3]) + rest
}

/// `to += left^T right` on and above the diagonal, `size` x `width`; both factors have `rows` rows of `width` columns.
/// The entries of `to` below the diagonal are invalid afterwards.
#[inline(always)]
pub fn add_transposed_product(to: &mut [f64], size: usize, width: usize, left: &[f64], right: &[f64], rows: usize) {
    for i in (0..size).step_by(TILE) {
        for j in (i / LANES * LANES..width).step_by(LANES) {
            let mut tile = [[0.0; LANES]; TILE];
            for r in 0..rows {
                let l: &[f64; TILE] = left[r * width + i..r * width + i + TILE].try_into().expect("a tile");
                let t: &[f64; LANES] = right[r * width + j..r * width + j + LANES].try_into().expect("a tile");
                for a in 0..TILE {
                    for b in 0..LANES {
                        tile[a][b] += l[a] * t[b];
                    }
                }
            }
            for (a, tile) in tile.iter().enumerate() {
                let row = &mut to[(i + a) * width + j..(i + a) * width + j + LANES];
                for b in 0..LANES {
                    row[b] += tile[b];
                }
            }
        }
    }
}

/// `to = a b` with `a` of `rows` x `inner` (its rows `stride` apart) and `b` of `inner` x `width`.
#[inline(always)]
pub fn product(to: &mut [f64], a: &[f64], stride: usize, b: &[f64], rows: usize, inner: usize, width: usize) {
    for i in (0..rows).step_by(TILE) {
        let tall = TILE.min(rows - i);
        for j in (0..width).step_by(LANES) {
            let mut tile = [[0.0; LANES]; TILE];
            for r in 0..inner {
                let t: &[f64; LANES] = b[r * width + j..r * width + j + LANES].try_into().expect("a tile");
                for (k, tile) in tile.iter_mut().enumerate().take(tall) {
                    let factor = a[(i + k) * stride + r];
                    for lane in 0..LANES {
                        tile[lane] += factor * t[lane];
                    }
                }
            }
            for (k, tile) in tile.iter().enumerate().take(tall) {
                to[(i + k) * width + j..(i + k) * width + j + LANES].copy_from_slice(tile);
            }
        }
    }
}

/// Cholesky factorisation of the first `pivots` rows of a symmetric matrix of order `size`, given on and above its
/// diagonal:
///
/// ```text
/// [ A   B ]      [ R   S          ]
/// [ B^T C ]  ->  [     C - S^T S  ]      A = R^T R,  B = R^T S
/// ```
///
/// Returns false, and leaves the matrix invalid, if a pivot is not above `min_pivot`.
#[inline(always)]
pub fn eliminate(matrix: &mut [f64], pivots: usize, size: usize, width: usize, min_pivot: f64) -> bool {
    for k in 0..pivots {
        let (above, below) = matrix.split_at_mut((k + 1) * width);
        let row = &mut above[k * width..];
        if row[k].is_nan() || row[k] <= min_pivot {
            return false;
        }
        let root = row[k].sqrt();
        row[k] = root;
        let scale = 1.0 / root;
        for value in &mut row[k + 1..] {
            *value *= scale;
        }
        for (i, other) in (k + 1..size).zip(below.chunks_exact_mut(width)) {
            let from = i / LANES * LANES;
            add_scaled(&mut other[from..], -row[i], &row[from..width]);
        }
    }
    true
}

/// LU factorisation with row exchanges, in place.
#[derive(Clone, Debug, Default)]
pub struct Lu {
    size: usize,
    factors: Vec<f64>,
    exchanges: Vec<usize>,
}

impl Lu {
    /// Work arrays for a matrix of this order.
    pub fn new(size: usize) -> Self {
        Self { size, factors: vec![0.0; size * size], exchanges: vec![0; size] }
    }

    /// The matrix to be factored, row-major.
    pub fn matrix_mut(&mut self) -> &mut [f64] {
        &mut self.factors
    }

    /// Factors the content of [`matrix_mut`](Self::matrix_mut); false if it is singular to working precision.
    #[inline(always)]
    pub fn factor(&mut self) -> bool {
        let n = self.size;
        for k in 0..n {
            let magnitude = |i: usize| self.factors[i * n + k].abs();
            let pivot = (k + 1..n).fold(k, |best, i| if magnitude(i) > magnitude(best) { i } else { best });
            self.exchanges[k] = pivot;
            if pivot != k {
                let (above, below) = self.factors.split_at_mut(pivot * n);
                above[k * n..(k + 1) * n].swap_with_slice(&mut below[..n]);
            }
            let (above, below) = self.factors.split_at_mut((k + 1) * n);
            let row = &above[k * n..];
            if row[k].is_nan() || row[k].abs() <= f64::MIN_POSITIVE {
                return false;
            }
            let scale = 1.0 / row[k];
            for other in below.chunks_exact_mut(n) {
                let factor = other[k] * scale;
                other[k] = factor;
                add_scaled(&mut other[k + 1..], -factor, &row[k + 1..]);
            }
        }
        true
    }

    /// `b <- A^-1 b`, with rows of `width` columns.
    #[inline(always)]
    pub fn solve(&self, b: &mut [f64], width: usize) {
        let n = self.size;
        for k in 0..n {
            let pivot = self.exchanges[k];
            if pivot != k {
                let (above, below) = b.split_at_mut(pivot * width);
                above[k * width..(k + 1) * width].swap_with_slice(&mut below[..width]);
            }
        }
        for k in 0..n {
            let (done, rest) = b.split_at_mut(k * width);
            for (j, known) in done.chunks_exact(width).enumerate() {
                add_scaled(&mut rest[..width], -self.factors[k * n + j], known);
            }
        }
        for k in (0..n).rev() {
            let (rest, done) = b.split_at_mut((k + 1) * width);
            let row = &mut rest[k * width..];
            for (j, known) in done.chunks_exact(width).enumerate() {
                add_scaled(row, -self.factors[k * n + k + 1 + j], known);
            }
            let scale = 1.0 / self.factors[k * n + k];
            for value in row {
                *value *= scale;
            }
        }
    }

    /// `b <- A^-T b`, one column.
    #[inline(always)]
    pub fn solve_transposed(&self, b: &mut [f64]) {
        let n = self.size;
        for k in 0..n {
            let known: f64 = (0..k).map(|j| self.factors[j * n + k] * b[j]).sum();
            b[k] = (b[k] - known) / self.factors[k * n + k];
        }
        for k in (0..n).rev() {
            let known: f64 = (k + 1..n).map(|j| self.factors[j * n + k] * b[j]).sum();
            b[k] -= known;
        }
        for k in (0..n).rev() {
            b.swap(k, self.exchanges[k]);
        }
    }
}

/// `to += [G 0; 0 1]^T P [G 0; 0 1]` with G of n x n and P of `size` x `size`; `half` receives P [G 0; 0 1]. Rows of
/// `to` from n on are overwritten.
pub fn congruence(g: &[f64], p: &[f64], n: usize, size: usize, half: &mut [f64], to: &mut [f64]) {
    half.fill(0.0);
    for (half, p) in half.chunks_exact_mut(size).zip(p.chunks_exact(size)) {
        for c in 0..n {
            add_scaled(&mut half[..n], p[c], &g[c * n..(c + 1) * n]);
        }
        half[n..].copy_from_slice(&p[n..]);
    }
    for c in 0..n {
        for r in 0..n {
            add_scaled(&mut to[r * size..(r + 1) * size], g[c * n + r], &half[c * size..(c + 1) * size]);
        }
    }
    to[n * size..].copy_from_slice(&half[n * size..]);
}

#[cfg(test)]
mod tests {
    use nalgebra::{DMatrix, DVector};

    use super::*;

    fn noise(i: usize, j: usize) -> f64 {
        ((7 * i + 13 * j + i * j) as f64).sin()
    }

    #[test]
    fn lu_solves_with_the_matrix_and_its_transpose() {
        let n = 7;
        let a = DMatrix::from_fn(n, n, |i, j| noise(i, j) + if i + j == n - 1 { 3.0 } else { 0.0 });
        let mut lu = Lu::new(n);
        lu.matrix_mut().copy_from_slice(a.transpose().as_slice());
        assert!(lu.factor());
        let b = DVector::from_fn(n, |i, _| noise(i, 3));
        let mut x = b.as_slice().to_vec();
        lu.solve(&mut x, 1);
        assert!((&a * DVector::from_vec(x) - &b).amax() < 1e-12);
        let mut x = b.as_slice().to_vec();
        lu.solve_transposed(&mut x);
        assert!((a.transpose() * DVector::from_vec(x) - b).amax() < 1e-12);
    }

    #[test]
    fn elimination_computes_the_schur_complement() {
        let (n, pivots, width) = (11, 4, padded(11));
        let root = DMatrix::from_fn(n, n, noise);
        let a = &root * root.transpose() + DMatrix::identity(n, n);
        let mut rows = vec![0.0; padded(n) * width];
        for (i, j) in (0..n).flat_map(|i| (i..n).map(move |j| (i, j))) {
            rows[i * width + j] = a[(i, j)];
        }
        assert!(eliminate(&mut rows, pivots, n, width, 0.0));
        let (a11, a12) = (a.view((0, 0), (pivots, pivots)), a.view((0, pivots), (pivots, n - pivots)));
        let a22 = a.view((pivots, pivots), (n - pivots, n - pivots));
        let schur = a22 - a12.transpose() * a11.into_owned().try_inverse().unwrap() * a12;
        for (i, j) in (0..n - pivots).flat_map(|i| (i..n - pivots).map(move |j| (i, j))) {
            assert!((rows[(i + pivots) * width + j + pivots] - schur[(i, j)]).abs() < 1e-11);
        }
        rows[0] = -1.0;
        assert!(!eliminate(&mut rows, pivots, n, width, 0.0));
    }

    #[test]
    fn products_agree_with_nalgebra() {
        let (rows, inner, width) = (6, 5, 16);
        let a = DMatrix::from_fn(rows, inner, noise);
        let b = DMatrix::from_fn(inner, width, |i, j| noise(j, i));
        let row_major = |m: &DMatrix<f64>| m.transpose().as_slice().to_vec();
        let mut to = vec![0.0; rows * width];
        product(&mut to, &row_major(&a), inner, &row_major(&b), rows, inner, width);
        assert!((DMatrix::from_row_slice(rows, width, &to) - &a * &b).amax() < 1e-13);
        let c = DMatrix::from_fn(inner, width, |i, j| noise(i + 3, j));
        let mut to = vec![0.0; width * width];
        add_transposed_product(&mut to, width, width, &row_major(&b), &row_major(&c), inner);
        let expected = b.transpose() * &c;
        for (i, j) in (0..width).flat_map(|i| (i..width).map(move |j| (i, j))) {
            assert!((to[i * width + j] - expected[(i, j)]).abs() < 1e-13);
        }
    }
}
