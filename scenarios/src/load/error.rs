use std::ops::Range;
use std::path::PathBuf;

use miette::{Diagnostic, NamedSource, SourceSpan};
use thiserror::Error;

use super::position::line_and_column;
use crate::Issue;

/// Why a scenario file cannot be loaded.
#[derive(Debug, Error, Diagnostic)]
pub enum LoadError {
    /// The file cannot be read.
    #[error("{}: {reason}", path.display())]
    Read {
        /// The file.
        path: PathBuf,
        /// The error of the operating system.
        reason: std::io::Error,
    },
    /// There is no shipped scenario of this name.
    #[error("{}: found no shipped scenario of this name", path.display())]
    #[diagnostic(help("`harness list shipped:` lists them"))]
    NoShipped {
        /// What was asked for, with the prefix.
        path: PathBuf,
    },
    /// The content of the file is not a valid scenario.
    #[error(transparent)]
    #[diagnostic(transparent)]
    Invalid(#[from] Box<InvalidScenario>),
}

impl LoadError {
    /// One line per issue: `file:line:column: field: found ..., expected ...; remedy`.
    pub fn lines(&self) -> Vec<String> {
        match self {
            Self::Read { .. } | Self::NoShipped { .. } => vec![self.to_string()],
            Self::Invalid(invalid) => {
                let line = |issue: &LocatedIssue| {
                    format!("{}:{}:{}: {}", invalid.name, issue.line, issue.column, issue.summary())
                };
                invalid.issues.iter().map(line).collect()
            }
        }
    }

    /// The issues of the content, in the order of the file; empty if the file could not be read.
    pub fn issues(&self) -> &[LocatedIssue] {
        match self {
            Self::Read { .. } | Self::NoShipped { .. } => &[],
            Self::Invalid(invalid) => &invalid.issues,
        }
    }
}

/// A file that is not a valid scenario, with all its issues.
#[derive(Debug, Error, Diagnostic)]
#[error("{name} is not a valid scenario: {} {}", issues.len(), if issues.len() == 1 { "error" } else { "errors" })]
pub struct InvalidScenario {
    /// Name of the file, as the user gave it.
    pub name: String,
    #[source_code]
    text: NamedSource<String>,
    /// The issues, in the order of the file.
    #[related]
    pub issues: Vec<LocatedIssue>,
}

impl InvalidScenario {
    /// - `issues`: each with its byte range in `text`
    pub(super) fn new(name: &str, text: &str, issues: Vec<(Issue, Range<usize>)>) -> Self {
        let mut issues: Vec<LocatedIssue> =
            issues.into_iter().map(|(issue, span)| LocatedIssue::new(issue, span, text)).collect();
        issues.sort_by_key(|issue| (issue.line, issue.column));
        Self { name: name.to_owned(), text: NamedSource::new(name, text.to_owned()), issues }
    }
}

/// An issue with its place in the file.
#[derive(Clone, Debug, Error, Diagnostic)]
#[error("{issue}")]
pub struct LocatedIssue {
    /// The issue.
    pub issue: Issue,
    /// Line, from 1.
    pub line: usize,
    /// Column in characters, from 1.
    pub column: usize,
    #[label("here")]
    span: SourceSpan,
    #[help]
    help: Option<String>,
}

impl LocatedIssue {
    fn new(issue: Issue, span: Range<usize>, text: &str) -> Self {
        let (line, column) = line_and_column(text, span.start);
        let help = Some(issue.remedy.clone()).filter(|remedy| !remedy.is_empty());
        Self { issue, line, column, span: span.into(), help }
    }

    /// Issue and remedy on one line.
    fn summary(&self) -> String {
        match &self.help {
            Some(help) => format!("{}; {help}", self.issue),
            None => self.issue.to_string(),
        }
    }
}
