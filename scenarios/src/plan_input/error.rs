use std::path::PathBuf;

use miette::Diagnostic;
use thiserror::Error;

use crate::Issue;

/// Maximum number of issues that are shown for one file; all are counted.
const MAX_SHOWN_ISSUES: usize = 20;

/// Why a plan file cannot be imported.
#[derive(Debug, Error, Diagnostic)]
pub enum PlanError {
    /// The file cannot be read.
    #[error("{}: {reason}", path.display())]
    Read {
        /// The file.
        path: PathBuf,
        /// The error of the operating system.
        reason: std::io::Error,
    },
    /// The extension of the file is not that of a supported format.
    #[error("{}: a plan file ends in .csv, .json or .parquet (tables also in .tsv, .txt or .tum)", path.display())]
    #[diagnostic(help("rename the file if it has one of these formats"))]
    Kind {
        /// The file.
        path: PathBuf,
    },
    /// The extension of the file is not that of a flight log.
    #[error("{}: a flight log is a table: .csv or .parquet (also .tsv, .txt or .tum)", path.display())]
    #[diagnostic(help("rename the file if it has one of these formats"))]
    FlightKind {
        /// The file.
        path: PathBuf,
    },
    /// The flights of this family are not judged from logs.
    #[error("{}: flights of a {family} cannot be judged from a log", path.display())]
    #[diagnostic(help("positions and velocities of fixed wings and multirotors can: `harness judge --help`"))]
    FlightFamily {
        /// The file.
        path: PathBuf,
        /// The family.
        family: crate::Family,
    },
    /// A Parquet file, but the feature `parquet` is off.
    #[error("{}: this harness was built without Parquet support", path.display())]
    #[diagnostic(help("build it with `--features parquet` (on by default), or convert the file to CSV"))]
    ParquetNotBuilt {
        /// The file.
        path: PathBuf,
    },
    /// The content of the file is not a valid plan for the scenario.
    #[error("{name} is not a valid {what} for `{scenario}`: {count} {}", if *count == 1 { "error" } else { "errors" })]
    Invalid {
        /// Name of the file, as the user gave it.
        name: String,
        /// What it should be: a plan, or a flight.
        what: &'static str,
        /// The scenario.
        scenario: String,
        /// Number of all issues.
        count: usize,
        /// The first issues, which are shown.
        #[related]
        issues: Vec<PlanIssue>,
    },
}

/// An issue with its place in a plan file.
#[derive(Clone, Debug, Error, Diagnostic, PartialEq)]
#[error("{place}: {issue}")]
pub struct PlanIssue {
    /// File, and line or row if applicable.
    pub place: String,
    /// The issue.
    pub issue: Issue,
    /// How to correct it.
    #[help]
    pub help: Option<String>,
}

impl PlanIssue {
    /// - `place`: suffix to the name of the file: `:17`, or empty for the whole file
    pub(super) fn new(place: impl Into<String>, issue: Issue) -> Self {
        let help = Some(issue.remedy.clone()).filter(|remedy| !remedy.is_empty());
        Self { place: place.into(), issue, help }
    }
}

impl PlanError {
    pub(super) fn invalid(name: &str, what: &'static str, scenario: &str, mut issues: Vec<PlanIssue>) -> Self {
        let count = issues.len();
        issues.truncate(MAX_SHOWN_ISSUES);
        for issue in &mut issues {
            issue.place = format!("{name}{}", issue.place);
        }
        Self::Invalid { name: name.to_owned(), what, scenario: scenario.to_owned(), count, issues }
    }

    /// One line per issue: `file:line: field: found ..., expected ...; remedy`.
    pub fn lines(&self) -> Vec<String> {
        let Self::Invalid { issues, .. } = self else { return vec![self.to_string()] };
        let line = |issue: &PlanIssue| match &issue.help {
            Some(help) => format!("{issue}; {help}"),
            None => issue.to_string(),
        };
        issues.iter().map(line).collect()
    }
}
