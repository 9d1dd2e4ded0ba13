//! Benchmarks: the tables of the papers, side by side with the baselines.

pub mod cooperative;
mod entry;
pub mod fleets;
pub mod horizon;
pub mod ipm;
pub mod slung;
pub mod subproblems;
pub mod suite;
