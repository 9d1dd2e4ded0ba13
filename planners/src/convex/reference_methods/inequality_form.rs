//! The paper's P4 in inequality form: `min g^T X  s.t.  A X <= b` with X = (z, α, β), eq. 21 and 22 (with the penalty μ
//! that eq. 21 as printed omits).
//!
//! ```text
//!         [  I    0   0 ]        [  hi ]     trust region, upper bounds
//!         [ -I    0   0 ]        [ -lo ]     and lower bounds
//!     A = [  E   -I   0 ]    b = [  d  ]     α >= |E z - d|
//!         [ -E   -I   0 ]        [ -d  ]
//!         [  F    0  -I ]        [  g  ]     β >= max(F z - g, 0)
//!         [  0    0  -I ]        [  0  ]
//! ```

use std::ops::Range;

use crate::convex::program::{DYNAMICS_ROWS, Program, STAGE_LEN};

/// Cost, right-hand side and matrix of P4, in compressed rows.
#[derive(Clone, Debug)]
pub struct InequalityForm {
    /// g, length n_X.
    pub cost: Vec<f64>,
    /// b, length n_A.
    pub rhs: Vec<f64>,
    /// Index of the first entry of every row, and the number of entries.
    starts: Vec<usize>,
    columns: Vec<usize>,
    values: Vec<f64>,
}

/// Coefficients of a dynamics constraint that may be nonzero, by row: left, right, θ. All intervals share the pattern,
/// so that an accidental zero does not change the pattern of A.
type DynamicsPattern = [[bool; 2 * STAGE_LEN + 1]; DYNAMICS_ROWS];

impl InequalityForm {
    /// P4 of `program`; n_X = n_z + n_eq + n_in, n_A = 2 n_z + 2 n_eq + 2 n_in.
    pub fn new(program: &Program) -> Self {
        let (n_z, n_eq, n_in) = (program.len(), program.equalities(), program.inequalities());
        let mut cost = vec![0.0; n_z];
        cost[n_z - 1] = program.theta_cost;
        cost.extend(program.units().map(|unit| program.penalty * unit));
        let mut form = Self { cost, rhs: Vec::new(), starts: vec![0], columns: Vec::new(), values: Vec::new() };
        for (sign, bounds) in [(1.0, &program.box_upper), (-1.0, &program.box_lower)] {
            for (j, bound) in bounds.iter().enumerate() {
                form.push([(j, sign)], sign * bound);
            }
        }
        let equalities = equality_rows(program);
        for sign in [1.0, -1.0] {
            for (i, (entries, d)) in equalities.iter().zip(program.equality_rhs()).enumerate() {
                let signed = entries.iter().map(|&(j, value)| (j, sign * value));
                form.push(signed.chain([(n_z + i, -1.0)]), sign * d);
            }
        }
        let first_β = n_z + n_eq;
        for (i, (entries, g)) in inequality_rows(program).into_iter().zip(program.inequality_rhs()).enumerate() {
            form.push(entries.into_iter().chain([(first_β + i, -1.0)]), g);
        }
        for i in 0..n_in {
            form.push([(first_β + i, -1.0)], 0.0);
        }
        form
    }

    /// n_X, the number of variables.
    pub fn n_x(&self) -> usize {
        self.cost.len()
    }

    /// n_A, the number of rows.
    pub fn n_a(&self) -> usize {
        self.rhs.len()
    }

    /// Entries (column, value) of a row, columns ascending.
    pub fn row(&self, row: usize) -> impl Iterator<Item = (usize, f64)> + Clone + '_ {
        let entries = self.entries(row);
        self.columns[entries.clone()].iter().copied().zip(self.values[entries].iter().copied())
    }

    /// Columns of a row, ascending.
    pub fn columns(&self, row: usize) -> &[usize] {
        &self.columns[self.entries(row)]
    }

    /// Values of a row.
    pub fn values(&self, row: usize) -> &[f64] {
        &self.values[self.entries(row)]
    }

    /// Does `other` have the same sparsity pattern?
    pub fn has_pattern_of(&self, other: &Self) -> bool {
        self.starts == other.starts && self.columns == other.columns
    }

    /// `out += A x`.
    pub fn add_product(&self, x: &[f64], out: &mut [f64]) {
        for (row, out) in out.iter_mut().enumerate() {
            *out += self.row(row).map(|(column, value)| value * x[column]).sum::<f64>();
        }
    }

    /// `out += A^T v`.
    pub fn add_transposed_product(&self, v: &[f64], out: &mut [f64]) {
        for (row, v) in v.iter().enumerate() {
            for (column, value) in self.row(row) {
                out[column] += value * v;
            }
        }
    }

    fn entries(&self, row: usize) -> Range<usize> {
        self.starts[row]..self.starts[row + 1]
    }

    fn push(&mut self, entries: impl IntoIterator<Item = (usize, f64)>, rhs: f64) {
        for (column, value) in entries {
            self.columns.push(column);
            self.values.push(value);
        }
        self.starts.push(self.columns.len());
        self.rhs.push(rhs);
    }
}

/// Rows of E.
fn equality_rows(program: &Program) -> Vec<Vec<(usize, f64)>> {
    let pattern = dynamics_pattern(program);
    let mut rows = Vec::with_capacity(program.equalities());
    for k in 0..program.intervals() {
        for (i, pattern) in pattern.iter().enumerate() {
            let all = dynamics_row(program, k, i);
            rows.push(all.zip(pattern).filter_map(|(entry, present)| present.then_some(entry)).collect());
        }
    }
    rows.extend(program.fixed_variables.iter().map(|fixed| vec![(fixed.index, 1.0)]));
    rows
}

/// All entries of row i of dynamics constraint k, zeros included.
fn dynamics_row(program: &Program, k: usize, i: usize) -> impl Iterator<Item = (usize, f64)> + '_ {
    let constraint = &program.dynamics[k];
    let left = (0..STAGE_LEN).map(move |j| (STAGE_LEN * k + j, constraint.left[(i, j)]));
    let right = (0..STAGE_LEN).map(move |j| (STAGE_LEN * (k + 1) + j, constraint.right[(i, j)]));
    left.chain(right).chain([(program.len() - 1, constraint.theta[i])])
}

fn dynamics_pattern(program: &Program) -> DynamicsPattern {
    let mut pattern = DynamicsPattern::default();
    for k in 0..program.intervals() {
        for (i, pattern) in pattern.iter_mut().enumerate() {
            for (present, (_, value)) in pattern.iter_mut().zip(dynamics_row(program, k, i)) {
                *present |= value != 0.0;
            }
        }
    }
    pattern
}

/// Rows of F.
fn inequality_rows(program: &Program) -> Vec<Vec<(usize, f64)>> {
    let upper = (0..program.len()).map(|j| vec![(j, 1.0)]);
    let lower = (0..program.len()).map(|j| vec![(j, -1.0)]);
    let halfspaces = program.halfspaces.iter().map(|halfspace| halfspace.terms().collect());
    upper.chain(lower).chain(halfspaces).collect()
}
