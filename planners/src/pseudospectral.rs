//! Optimal control by Legendre-Gauss-Radau collocation over a mesh of segments, for second-order systems
//! `q'' = a(q, q', u)` in phases.
//!
//! On each segment of half-length η = h/2 the state is a polynomial through N Radau points and the segment's end, and
//!
//! ```text
//! Σ_i D_ki X_i - η f(X_k, U_k) = 0,   k = 1..N          J = Σ η w_k l(X_k, U_k)
//! ```
//!
//! (Kang, Huang, Wen 2020, eq. 21 to 27; Garg et al. 2010). [`Transcription`] is the nonlinear programme that results;
//! it solves its Newton systems segment by segment. No vehicle is named here.

mod condense;
mod condensed_solve;
mod layout;
mod mesh;
mod motion;
mod polynomial;
mod products;
mod programme;
mod radau;
mod refinement;
mod segment;
mod small;
mod sweep;
mod transcription;
mod workspace;

#[cfg(test)]
mod tests;

pub use mesh::{Mesh, Segment};
pub use motion::{Duration, EndDerivatives, EndValues, EndWeights, Motion, NodeDerivatives, NodeWeights};
pub use polynomial::Place;
pub use radau::Radau;
pub use refinement::{Quality, Tolerances, qualities, refine};
pub use transcription::Transcription;
