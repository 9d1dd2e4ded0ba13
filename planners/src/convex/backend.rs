//! The choice between the methods for the Newton direction.

/// How the Newton direction is computed. All backends compute the same direction; they differ in time and rounding.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Backend {
    /// The block factorisation over the stages, in square-root form, four programs at a time: this project's own.
    #[default]
    Block,
    /// Method I of the paper: sparse LDL^T of the reduced matrix of P4, one symbolic analysis per sparsity pattern.
    SparseLdl,
    /// Method II: the dense reduced matrix, n_X x n_X.
    DenseReduced,
    /// Method III: the dense KKT matrix, (n_X + 2 n_A) x (n_X + 2 n_A).
    DenseKkt,
}

impl Backend {
    /// Every backend: the block factorisation, then the paper's in its order.
    pub const ALL: [Self; 4] = [Self::Block, Self::SparseLdl, Self::DenseReduced, Self::DenseKkt];

    /// Name in tables and files.
    pub fn name(self) -> &'static str {
        match self {
            Self::Block => "block",
            Self::SparseLdl => "sparse-ldl",
            Self::DenseReduced => "dense-reduced",
            Self::DenseKkt => "dense-kkt",
        }
    }
}
