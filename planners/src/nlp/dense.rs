//! Dense test programs, given by values and gradients; Hessians are finite differences of gradients.

use nalgebra::{DMatrix, DVector};

use super::program::{Program, Sizes};

/// f, c and d with their gradients at a point.
pub struct Values {
    pub f: (f64, Vec<f64>),
    pub c: Vec<(f64, Vec<f64>)>,
    pub d: Vec<(f64, Vec<f64>)>,
}

/// A program given by a function.
pub struct DenseProgram {
    function: fn(&[f64]) -> Values,
    sizes: Sizes,
    lower: Vec<f64>,
    upper: Vec<f64>,
    hessian: DMatrix<f64>,
    matrix: DMatrix<f64>,
    j_c: DMatrix<f64>,
    j_d: DMatrix<f64>,
}

impl DenseProgram {
    pub fn new(function: fn(&[f64]) -> Values, lower: Vec<f64>, upper: Vec<f64>) -> Self {
        let n = lower.len();
        let at = function(&vec![0.5; n]);
        let sizes = Sizes { variables: n, equalities: at.c.len(), inequalities: at.d.len() };
        let zero = DMatrix::zeros(n, n);
        let [j_c, j_d] = [at.c.len(), at.d.len()].map(|rows| DMatrix::zeros(rows, n));
        Self { function, sizes, lower, upper, hessian: zero.clone(), matrix: zero, j_c, j_d }
    }

    fn lagrangian_gradient(&self, x: &[f64], y: &[f64], v: &[f64]) -> DVector<f64> {
        let at = (self.function)(x);
        let mut sum = DVector::from_vec(at.f.1);
        for ((_, row), y) in at.c.iter().zip(y) {
            sum += *y * DVector::from_column_slice(row);
        }
        for ((_, row), v) in at.d.iter().zip(v) {
            sum -= *v * DVector::from_column_slice(row);
        }
        sum
    }
}

impl Program for DenseProgram {
    fn sizes(&self) -> Sizes {
        self.sizes
    }

    fn bounds(&self) -> (&[f64], &[f64]) {
        (&self.lower, &self.upper)
    }

    fn evaluate(&mut self, x: &[f64], c: &mut [f64], d: &mut [f64]) -> f64 {
        let at = (self.function)(x);
        c.iter_mut().zip(at.c).for_each(|(c, row)| *c = row.0);
        d.iter_mut().zip(at.d).for_each(|(d, row)| *d = row.0);
        at.f.0
    }

    fn linearise(&mut self, x: &[f64], y: &[f64], v: &[f64], gradient: &mut [f64]) {
        let at = (self.function)(x);
        gradient.copy_from_slice(&at.f.1);
        for (rows, matrix) in [(&at.c, &mut self.j_c), (&at.d, &mut self.j_d)] {
            for (i, (_, row)) in rows.iter().enumerate() {
                matrix.row_mut(i).copy_from_slice(row);
            }
        }
        let h = 1e-5;
        for j in 0..x.len() {
            let moved = |sign: f64| {
                let mut moved = x.to_vec();
                moved[j] += sign * h;
                self.lagrangian_gradient(&moved, y, v)
            };
            let column = (moved(1.0) - moved(-1.0)) / (2.0 * h);
            self.hessian.set_column(j, &column);
        }
        self.hessian = 0.5 * (&self.hessian + self.hessian.transpose());
    }

    fn add_jacobian_transposed(&self, y: &[f64], v: &[f64], out: &mut [f64]) {
        let mut sum = self.j_c.transpose() * DVector::from_column_slice(y);
        if !v.is_empty() {
            sum -= self.j_d.transpose() * DVector::from_column_slice(v);
        }
        out.iter_mut().zip(sum.iter()).for_each(|(out, sum)| *out += sum);
    }

    fn jacobian_times(&self, dx: &[f64], c: &mut [f64], d: &mut [f64]) {
        let dx = DVector::from_column_slice(dx);
        c.copy_from_slice((&self.j_c * &dx).as_slice());
        d.copy_from_slice((&self.j_d * &dx).as_slice());
    }

    fn factor(&mut self, diagonal: &[f64], weights: &[f64]) -> bool {
        let weights = DMatrix::from_diagonal(&DVector::from_column_slice(weights));
        let diagonal = DMatrix::from_diagonal(&DVector::from_column_slice(diagonal));
        self.matrix = &self.hessian + diagonal + self.j_d.transpose() * weights * &self.j_d;
        // the inertia is correct: as many negative eigenvalues as equalities, none of them zero
        let eigenvalues = self.kkt().symmetric_eigenvalues();
        eigenvalues.iter().filter(|&&value| value < -1e-12).count() == self.sizes.equalities
            && eigenvalues.iter().all(|value| value.abs() > 1e-12)
    }

    fn hessian_times(&self, dx: &[f64], out: &mut [f64]) {
        out.copy_from_slice((&self.matrix * DVector::from_column_slice(dx)).as_slice());
    }

    fn solve(&mut self, x: &mut [f64], y: &mut [f64]) {
        let rhs = DVector::from_iterator(x.len() + y.len(), x.iter().chain(y.iter()).copied());
        let solution = self.kkt().lu().solve(&rhs).expect("it was factored");
        x.copy_from_slice(&solution.as_slice()[..x.len()]);
        y.copy_from_slice(&solution.as_slice()[x.len()..]);
    }
}

impl DenseProgram {
    fn kkt(&self) -> DMatrix<f64> {
        let (n, m) = (self.sizes.variables, self.sizes.equalities);
        let mut kkt = DMatrix::zeros(n + m, n + m);
        kkt.view_mut((0, 0), (n, n)).copy_from(&self.matrix);
        kkt.view_mut((n, 0), (m, n)).copy_from(&self.j_c);
        kkt.view_mut((0, n), (n, m)).copy_from(&self.j_c.transpose());
        kkt
    }
}
