//! Optimal control by Legendre-Gauss-Radau collocation over a mesh of segments, for second-order systems
//! `q'' = a(q, q', u)` in phases.
//!
//! On each segment of half-length η = h/2 the state is a polynomial through N Radau points and the segment's end, and
//!
//! ```text
//! Σ_i D_ki X_i - η f(X_k, U_k) = 0,   k = 1..N          J = Σ η w_k l(X_k, U_k)
//! ```
//!
//! (Kang, Huang, Wen 2020, eq. 21 to 27; Garg et al. 2010). [`Transcription`] is the resulting nonlinear program. It
//! solves its Newton systems segment by segment: each segment is condensed to a stage of a linear-quadratic problem,
//! and a Riccati recursion runs over the stages. No vehicle is named here.

mod condensed_segment;
mod condensed_solve;
mod condensing;
mod dense_kernels;
mod differentiation;
mod evaluation;
mod interpolation;
mod layout;
mod linearisation;
mod mesh;
mod mesh_transfer;
mod multiphase_system;
mod products;
mod program;
mod radau;
mod refinement;
mod riccati_recursion;
mod transcription;
mod workspace;

#[cfg(test)]
mod tests;

pub use interpolation::MeshPoint;
pub use mesh::{Mesh, Segment};
pub use multiphase_system::{
    Duration, MultiphaseSystem, NodeDerivatives, NodeWeights, TerminalDerivatives, TerminalValues, TerminalWeights,
};
pub use radau::Radau;
pub use refinement::{Quality, Tolerances, refine, segment_qualities};
pub use transcription::Transcription;
