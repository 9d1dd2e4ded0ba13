//! A simulation-in-the-loop test harness for trajectory planners of unmanned aerial vehicles.
//!
//! ```text
//! scenario file -> Scenario -> planner -> Plan -> sim -> Flight -> judge -> Verdict -> recording + reports
//! ```

pub mod author;
pub mod bench;
pub mod cli;
pub mod compare;
mod contender;
#[cfg(all(test, unix))]
#[path = "../scenarios/tests/damage/mod.rs"]
mod damage;
#[cfg(feature = "parquet")]
pub mod diverge;
pub mod error;
mod export;
pub mod in_loop;
pub mod interrupt;
mod jobs;
pub mod metrics;
pub mod notation;
mod output;
pub mod outside;
mod pipeline;
mod progress;
pub mod record;
pub mod report;
pub mod selftest;
pub mod stress;
pub mod submitted;
#[cfg(feature = "parquet")]
pub mod sweep;
pub mod verdict;
pub mod waterfall;
