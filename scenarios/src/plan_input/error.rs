use std::path::PathBuf;

use miette::Diagnostic;
use thiserror::Error;

use crate::Problem;

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
    #[error("{name} is no plan for `{scenario}`: {count} {}", if *count == 1 { "fault" } else { "faults" })]
    Invalid {
        /// The file, as the user named it.
        name: String,
        /// The scenario.
        scenario: String,
        /// Number of faults, those that are not shown included.
        count: usize,
        /// The first faults.
        #[related]
        faults: Vec<PlanFault>,
    },
}

/// One thing that is wrong, and where.
#[derive(Clone, Debug, Error, Diagnostic, PartialEq)]
#[error("{place}: {problem}")]
pub struct PlanFault {
    /// File, and line or row where there are any.
    pub place: String,
    /// What is wrong.
    pub problem: Problem,
    /// How to mend it.
    #[help]
    pub help: Option<String>,
}

impl PlanFault {
    /// A fault at `place`, which is what follows the name of the file: `:17`, or nothing for the whole file.
    pub(super) fn new(place: impl Into<String>, problem: Problem) -> Self {
        let help = Some(problem.remedy.clone()).filter(|remedy| !remedy.is_empty());
        Self { place: place.into(), problem, help }
    }
}

impl PlanError {
    pub(super) fn invalid(name: &str, scenario: &str, mut faults: Vec<PlanFault>) -> Self {
        let count = faults.len();
        faults.truncate(MOST_FAULTS);
        for fault in &mut faults {
            fault.place = format!("{name}{}", fault.place);
        }
        Self::Invalid { name: name.to_owned(), scenario: scenario.to_owned(), count, faults }
    }

    /// Every fault on a line of its own, as `file:line: field: found ..., expected ...; remedy`.
    pub fn lines(&self) -> Vec<String> {
        let Self::Invalid { faults, .. } = self else { return vec![self.to_string()] };
        let line = |fault: &PlanFault| match &fault.help {
            Some(help) => format!("{fault}; {help}"),
            None => fault.to_string(),
        };
        faults.iter().map(line).collect()
    }
}
