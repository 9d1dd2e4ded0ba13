//! A simulation-in-the-loop test harness for trajectory planners of unmanned aerial vehicles.
//!
//! ```text
//! scenario file -> Scenario -> planner -> Plan -> sim -> Flight -> judge -> Verdict -> recording + reports
//! ```
//!
//! [`plan_source`] is where a plan comes from, [`verdict`] judges it and its flight, [`metrics`] measures what decides
//! nothing, [`output`] writes recordings and reports, [`campaign`] runs many flights to answer one question.

pub mod campaign;
pub mod cli;
pub mod console;
#[cfg(all(test, unix))]
#[path = "../scenarios/tests/damage/mod.rs"]
mod damage;
pub mod error;
mod families;
pub mod interrupt;
mod jobs;
pub mod metrics;
pub mod number_format;
pub mod output;
mod pipeline;
pub mod plan_source;
mod progress;
pub mod report;
mod statistics;
pub mod verdict;

pub use verdict::multirotor::guard;
