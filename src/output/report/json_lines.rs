//! A run as a stream of JSON objects, one per line, for tools.

use serde::Serialize;

use super::{RefusedFile, Summary};
use crate::console;
use crate::error::Error;
use crate::report::Report;

/// One line.
#[derive(Serialize)]
#[serde(tag = "event", rename_all = "kebab-case")]
pub enum Event<'a> {
    /// A file that could not be run.
    Refused {
        /// The file and its faults.
        #[serde(flatten)]
        file: &'a RefusedFile,
    },
    /// A job is finished.
    Report {
        /// The contents of its `report.json`.
        report: &'a Report,
    },
    /// All jobs are finished.
    Summary {
        /// The contents of `summary.json`.
        summary: &'a Summary,
        /// Exit code of the process.
        exit_code: u8,
    },
    /// A comparison with an earlier run or a baseline.
    Comparison {
        /// Every difference.
        comparison: &'a crate::campaign::comparison::Comparison,
    },
    /// A comparison of two sweeps.
    #[cfg(feature = "parquet")]
    SweepComparison {
        /// The verdict and every check.
        comparison: &'a crate::campaign::sweep_comparison::SweepComparison,
    },
}

/// Prints one line.
///
/// # Errors
///
/// Standard output cannot be written.
pub fn print(event: &Event<'_>) -> Result<(), Error> {
    console::print(&serde_json::to_string(event).map_err(std::io::Error::from)?)
}
