//! Options that searches and estimates share.

use std::path::PathBuf;

use clap::Args;
use thiserror::Error;

use super::session::start_threads;
use crate::error::Error as HarnessError;
use crate::jobs::Job;

/// Where the results go, and how much is used and said meanwhile.
#[derive(Args, Debug)]
pub struct CampaignArgs {
    /// Folder for the results
    #[arg(short, long, value_name = "DIR", default_value = "out")]
    out: PathBuf,
    /// Number of worker threads [default: one per core]; results do not depend on it
    #[arg(short, long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..))]
    jobs: Option<u16>,
    /// Print errors only
    #[arg(short, long)]
    pub quiet: bool,
}

impl CampaignArgs {
    /// Starts the worker threads.
    ///
    /// # Errors
    ///
    /// They cannot be started.
    pub fn start_threads(&self) -> Result<(), HarnessError> {
        start_threads(self.jobs)
    }

    /// The folder of a job's results.
    pub fn folder_of(&self, job: &Job) -> PathBuf {
        self.out.join(&job.scenario.name).join(job.plan_source.name())
    }
}

/// Why a number on the command line is refused.
#[derive(Debug, Error)]
#[error("expected {0}")]
pub struct OutOfRange(pub &'static str);

/// A number that meets a condition.
///
/// # Errors
///
/// The text is no number, or the number does not; `expected` says what is.
pub fn number_if(text: &str, is_valid: impl Fn(f64) -> bool, expected: &'static str) -> Result<f64, OutOfRange> {
    text.parse().ok().filter(|value| is_valid(*value)).ok_or(OutOfRange(expected))
}
