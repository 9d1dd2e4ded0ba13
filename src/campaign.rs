//! Many flights that answer one question: how good is a planner, where does it fail, what changed?

pub mod ab_test;
pub mod bench;
pub mod comparison;
pub mod distribution;
pub mod failure_threshold;
pub mod falsification;
pub mod figures;
#[cfg(feature = "parquet")]
pub mod first_difference;
pub mod generate;
pub mod margin_budget;
#[cfg(feature = "parquet")]
pub mod monte_carlo;
pub mod probability;
pub mod scenario_document;
pub mod selftest;
pub mod shrinking;
#[cfg(feature = "parquet")]
pub mod sweep_comparison;
pub mod trial;
pub mod typical_disturbances;
