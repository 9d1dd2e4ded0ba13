//! A run as a stream of JSON objects, one per line, for tools that read along.

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
        /// Which, and why.
        #[serde(flatten)]
        file: &'a RefusedFile,
    },
    /// A job is done: all of its `report.json`.
    Report {
        /// What was found.
        report: &'a Report,
    },
    /// Everything is done.
    Summary {
        /// The contents of `summary.json`.
        summary: &'a Summary,
        /// Exit code of the process.
        exit_code: u8,
    },
    /// What a comparison with an earlier run found.
    Comparison {
        /// Every difference.
        comparison: &'a crate::campaign::comparison::Comparison,
    },
}

/// Prints one line.
pub fn print(event: &Event<'_>) -> Result<(), Error> {
    console::print(&serde_json::to_string(event).map_err(std::io::Error::from)?)
}
