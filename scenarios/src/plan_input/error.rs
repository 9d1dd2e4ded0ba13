use std::path::PathBuf;

use miette::Diagnostic;
use thiserror::Error;

use crate::Issue;

/// Faults that are reported of one file; the others are counted.
const MOST_FAULTS: usize = 20;

/// Why a file gives no plan.
#[derive(Debug, Error, Diagnostic)]
pub enum PlanError {
    /// The file can't be read.
    #[error("{}: {reason}", path.display())]
    Read {
        /// The file.
        path: PathBuf,
        /// What the operating system says.
        reason: std::io::Error,
    },
    /// No format has this ending.
    #[error("{}: a plan file ends in .csv, .json or .parquet", path.display())]
    #[diagnostic(help("rename the file if it holds one of these"))]
    Kind {
        /// The file.
        path: PathBuf,
    },
    /// A Parquet file without the library for it.
    #[error("{}: this harness was built without Parquet", path.display())]
    #[diagnostic(help("build it with `--features parquet` (on by default), or convert the file to CSV"))]
    ParquetNotBuilt {
        /// The file.
        path: PathBuf,
    },
    /// The file is read, but what it says is no plan for the scenario.
    #[error("{name} is not a valid plan for `{scenario}`: {count} {}", if *count == 1 { "error" } else { "errors" })]
    Invalid {
        /// The file, as the user named it.
        name: String,
        /// The scenario.
        scenario: String,
        /// Number of issues, those that are not shown included.
        count: usize,
        /// The first issues.
        #[related]
        issues: Vec<PlanIssue>,
    },
}

/// One thing that is wrong, and where.
#[derive(Clone, Debug, Error, Diagnostic, PartialEq)]
#[error("{place}: {issue}")]
pub struct PlanIssue {
    /// File, and line or row where there are any.
    pub place: String,
    /// What is wrong.
    pub issue: Issue,
    /// How to mend it.
    #[help]
    pub help: Option<String>,
}

impl PlanIssue {
    /// A issue at `place`, which is what follows the name of the file: `:17`, or nothing for the whole file.
    pub(super) fn new(place: impl Into<String>, issue: Issue) -> Self {
        let help = Some(issue.remedy.clone()).filter(|remedy| !remedy.is_empty());
        Self { place: place.into(), issue, help }
    }
}

impl PlanError {
    pub(super) fn invalid(name: &str, scenario: &str, mut issues: Vec<PlanIssue>) -> Self {
        let count = issues.len();
        issues.truncate(MOST_FAULTS);
        for issue in &mut issues {
            issue.place = format!("{name}{}", issue.place);
        }
        Self::Invalid { name: name.to_owned(), scenario: scenario.to_owned(), count, issues }
    }

    /// Every issue on a line of its own, as `file:line: field: found ..., expected ...; remedy`.
    pub fn lines(&self) -> Vec<String> {
        let Self::Invalid { issues, .. } = self else { return vec![self.to_string()] };
        let line = |issue: &PlanIssue| match &issue.help {
            Some(help) => format!("{issue}; {help}"),
            None => issue.to_string(),
        };
        issues.iter().map(line).collect()
    }
}
