//! Benchmarks: the tables of the papers, side by side with the baselines.

pub mod cooperative;
mod entry;
pub mod fleets;
mod geometry;
pub mod horizon;
pub mod ipm;
mod log_log_chart;
pub mod min_flight_time;
pub mod slung;
pub mod subproblems;
pub mod suite;
