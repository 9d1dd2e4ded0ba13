//! Sizes and operation counts.

use planners::convex::{Backend, Program};
use serde::Serialize;

/// Sizes of the paper's form P4 of a subproblem.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Sizes {
    /// Variables n_X = n_z + n_eq + n_in.
    pub n_x: usize,
    /// Rows n_A = n_tr + 2 n_eq + 2 n_in.
    pub n_a: usize,
}

impl Sizes {
    /// Those of `program`.
    pub fn of(program: &Program) -> Self {
        let (n_z, n_eq, n_in) = (program.len(), program.equalities(), program.inequalities());
        Self { n_x: n_z + n_eq + n_in, n_a: 2 * (n_z + n_eq + n_in) }
    }

    /// Operations of one iteration by Table 1 of the paper; `None` for the block method. Methods I and II differ in the
    /// reduced matrix alone: the one factorises it, the other inverts it.
    pub fn paper_flops(&self, backend: Backend) -> Option<f64> {
        let (n_x, n_a) = (self.n_x as f64, self.n_a as f64);
        let elimination = 3.0 * n_a.powi(3) + n_x * n_x * n_a + n_x * n_a * n_a;
        match backend {
            Backend::Block => None,
            Backend::SparseLdl => Some(0.33 * n_x.powi(3) + elimination),
            Backend::DenseReduced => Some(2.67 * n_x.powi(3) + elimination),
            Backend::DenseKkt => Some(2.67 * (n_x + 2.0 * n_a).powi(3)),
        }
    }

    /// Order of the dense matrix that a backend factorises; `None` for sparse backends.
    pub fn dense_order(&self, backend: Backend) -> Option<usize> {
        match backend {
            Backend::Block | Backend::SparseLdl => None,
            Backend::DenseReduced => Some(self.n_x),
            Backend::DenseKkt => Some(self.n_x + 2 * self.n_a),
        }
    }
}

#[cfg(test)]
mod tests {
    use planners::convex::Backend;

    use super::Sizes;

    #[test]
    fn counts_are_those_of_table_1() {
        let sizes = Sizes { n_x: 1000, n_a: 2000 };
        let flops = |backend| sizes.paper_flops(backend).unwrap();
        assert_eq!(sizes.paper_flops(Backend::Block), None);
        assert!((flops(Backend::SparseLdl) / 1e9 - (0.33 + 24.0 + 2.0 + 4.0)).abs() < 1e-9);
        assert!((flops(Backend::DenseReduced) / 1e9 - (2.67 + 24.0 + 2.0 + 4.0)).abs() < 1e-9);
        assert!((flops(Backend::DenseKkt) / 1e9 - 2.67 * 125.0).abs() < 1e-9);
    }
}
