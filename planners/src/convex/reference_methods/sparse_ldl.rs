//! Method I of the paper: sparse LDL^T of the reduced matrix A^T (S^-1 Λ) A, by faer (the paper uses MA57).

use std::sync::Arc;

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::cholesky::ldlt::factor::LdltRegularization;
use faer::sparse::linalg::cholesky::{
    CholeskySymbolicParams, LdltRef, SymbolicCholesky, SymmetricOrdering, factorize_symbolic_cholesky,
};
use faer::sparse::{SparseColMatRef, SymbolicSparseColMat};
use faer::{Conj, MatMut, Par, Side};

use super::inequality_form::InequalityForm;

/// The matrix is positive definite, so a pivot at or below this is rounding. It is replaced by [`REPLACEMENT_PIVOT`].
const MIN_PIVOT: f64 = 1e-13;

/// Replaces a pivot that is only rounding; large enough to leave its variable almost unchanged.
const REPLACEMENT_PIVOT: f64 = 1e-7;

/// The reduced matrix and its factors. The symbolic analysis is shared by clones and kept from solve to solve.
#[derive(Clone, Debug)]
pub struct SparseLdl {
    analysis: Arc<Analysis>,
    values: Vec<f64>,
    factors: Vec<f64>,
    scratch: Scratch,
}

/// The symbolic analysis, which depends on the sparsity pattern of A only.
#[derive(Debug)]
struct Analysis {
    /// The form whose pattern was analysed.
    form: InequalityForm,
    /// Lower triangle of the matrix.
    lower: SymbolicSparseColMat<usize>,
    /// Index in the lower triangle of every product of two entries of a row of A, row by row, the second entry at or
    /// before the first.
    targets: Vec<u32>,
    cholesky: SymbolicCholesky<usize>,
}

impl SparseLdl {
    /// Analyses the pattern of `form`.
    pub fn new(form: &InequalityForm) -> Self {
        let analysis = Analysis::new(form);
        Self {
            values: vec![0.0; analysis.lower.row_idx().len()],
            factors: vec![0.0; analysis.cholesky.len_val()],
            scratch: Scratch::new(&analysis.cholesky),
            analysis: Arc::new(analysis),
        }
    }

    /// Prepares for `form`; repeats the analysis only if the pattern has changed.
    pub fn prepare(&mut self, form: &InequalityForm) {
        if !form.has_pattern_of(&self.analysis.form) {
            *self = Self::new(form);
        }
    }

    /// Factors A^T diag(weights) A.
    pub fn factor(&mut self, form: &InequalityForm, weights: &[f64]) {
        self.assemble(form, weights);
        let regularization = LdltRegularization {
            dynamic_regularization_signs: None,
            dynamic_regularization_delta: REPLACEMENT_PIVOT,
            dynamic_regularization_epsilon: MIN_PIVOT,
        };
        let matrix = SparseColMatRef::new(self.analysis.lower.as_ref(), &self.values);
        let stack = MemStack::new(&mut self.scratch.0);
        let cholesky = &self.analysis.cholesky;
        let done = cholesky.factorize_numeric_ldlt(
            &mut self.factors,
            matrix,
            Side::Lower,
            regularization,
            Par::Seq,
            stack,
            faer::Spec::default(),
        );
        if done.is_err() {
            // a pivot is zero or NaN: the direction becomes NaN, and the loop ends as stalled
            self.factors.fill(f64::NAN);
        }
    }

    /// `x <- matrix^-1 x`.
    pub fn solve(&mut self, x: &mut [f64]) {
        let n = x.len();
        let factors = LdltRef::new(&self.analysis.cholesky, &self.factors);
        let stack = MemStack::new(&mut self.scratch.0);
        factors.solve_in_place_with_conj(Conj::No, MatMut::from_column_major_slice_mut(x, n, 1), Par::Seq, stack);
    }

    fn assemble(&mut self, form: &InequalityForm, weights: &[f64]) {
        self.values.fill(0.0);
        let mut targets = self.analysis.targets.as_slice();
        for (row, weight) in weights.iter().enumerate() {
            let entries = form.values(row);
            for (i, first) in entries.iter().enumerate() {
                let (own, rest) = targets.split_at(i + 1);
                let scaled = weight * first;
                for (second, &target) in entries.iter().zip(own) {
                    self.values[target as usize] += scaled * second;
                }
                targets = rest;
            }
        }
    }
}

impl Analysis {
    fn new(form: &InequalityForm) -> Self {
        let pairs = || (0..form.n_a()).flat_map(|row| pairs(form.columns(row)));
        let mut entries: Vec<(usize, usize)> = pairs().collect();
        entries.sort_unstable();
        entries.dedup();
        let n = form.n_x();
        let starts = (0..=n).map(|column| entries.partition_point(|entry| entry.0 < column)).collect();
        let index = |entry| entries.binary_search(&entry).expect("every pair is an entry");
        let targets = pairs().map(|pair| u32::try_from(index(pair)).expect("fewer than 2^32 entries")).collect();
        let rows = entries.iter().map(|entry| entry.1).collect();
        let lower = SymbolicSparseColMat::new_checked(n, n, starts, None, rows);
        let parameters = CholeskySymbolicParams::default();
        let cholesky = factorize_symbolic_cholesky(lower.as_ref(), Side::Lower, SymmetricOrdering::Amd, parameters)
            .expect("memory for the analysis of a small matrix");
        Self { form: form.clone(), lower, targets, cholesky }
    }
}

/// (column, row) in the lower triangle of every product of two entries of one row of A.
fn pairs(columns: &[usize]) -> impl Iterator<Item = (usize, usize)> + '_ {
    columns.iter().enumerate().flat_map(|(i, &row)| columns[..=i].iter().map(move |&column| (column, row)))
}

/// Work space of faer for factorisation and solution.
struct Scratch(MemBuffer);

impl Scratch {
    fn new(cholesky: &SymbolicCholesky<usize>) -> Self {
        let factor = cholesky.factorize_numeric_ldlt_scratch::<f64>(Par::Seq, faer::Spec::default());
        Self(MemBuffer::new(factor.or(cholesky.solve_in_place_scratch::<f64>(1, Par::Seq))))
    }
}

impl Clone for Scratch {
    fn clone(&self) -> Self {
        Self(MemBuffer::new(faer::dyn_stack::StackReq::new_aligned::<u8>(self.0.len(), 64)))
    }
}

impl std::fmt::Debug for Scratch {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(formatter, "Scratch({} bytes)", self.0.len())
    }
}
