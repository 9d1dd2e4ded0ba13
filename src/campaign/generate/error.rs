//! Why a scenario cannot be generated.

use miette::Diagnostic;
use thiserror::Error;

use super::Kind;

/// Why a scenario cannot be generated.
#[derive(Debug, Error, Diagnostic)]
pub enum GenerateError {
    /// There is no such kind or family.
    #[error("found `{name}`, expected {expected}")]
    #[diagnostic(help("{remedy}"))]
    UnknownKind {
        /// What was given.
        name: String,
        /// The valid names.
        expected: String,
        /// The closest valid name.
        remedy: String,
    },
    /// The size is out of the kind's range.
    #[error(
        "--size {found}: the size of the kind `{}` ({}) is {} to {}",
        kind.name, kind.size.meaning, kind.size.min, kind.size.max
    )]
    #[diagnostic(help("`harness generate --help` lists the kinds with their sizes"))]
    Size {
        /// The kind.
        kind: &'static Kind,
        /// What was given.
        found: usize,
    },
    /// The density is out of the kind's range.
    #[error(
        "--density {found}: the density of the kind `{}` ({}) is 0 to {}",
        kind.name, kind.density.meaning, kind.density.max
    )]
    #[diagnostic(help("`harness generate --help` lists the kinds with their densities"))]
    Density {
        /// The kind.
        kind: &'static Kind,
        /// What was given.
        found: f64,
    },
    /// The kind has no variant.
    #[error("the kind `{}` has no variant: neither --free-arrival nor --hidden applies to it", kind.name)]
    #[diagnostic(help("fleets of fixed wings have --free-arrival, multirotors among obstacles have --hidden"))]
    NoVariant {
        /// The kind.
        kind: &'static Kind,
    },
    /// Nothing that can be certified was found.
    #[error("--seed {seed}: no feasible `{kind}` of size {size} and density {density} was found")]
    #[diagnostic(help("try another seed, a lower density or a smaller size"))]
    NoRoom {
        /// The kind.
        kind: &'static str,
        /// The size.
        size: usize,
        /// The density.
        density: f64,
        /// The seed.
        seed: u64,
    },
}
