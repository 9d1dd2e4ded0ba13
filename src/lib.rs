//! A simulation-in-the-loop test harness for trajectory planners of unmanned aerial vehicles.
//!
//! ```text
//! scenario file -> Scenario -> planner -> Plan -> sim -> Flight -> judge -> Verdict -> recording + reports
//! ```

pub mod bench;
pub mod cli;
pub mod error;
mod jobs;
pub mod metrics;
pub mod notation;
mod output;
mod pipeline;
mod progress;
pub mod record;
pub mod report;
pub mod verdict;
