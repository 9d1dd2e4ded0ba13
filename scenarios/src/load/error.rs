use std::ops::Range;
use std::path::PathBuf;

use miette::{Diagnostic, NamedSource, SourceSpan};
use thiserror::Error;

use super::position::line_and_column;
use crate::Issue;

/// Why a file gives no scenario.
#[derive(Debug, Error, Diagnostic)]
pub enum LoadError {
    /// The file can't be read.
    #[error("{}: {reason}", path.display())]
    Read {
        /// The file.
        path: PathBuf,
        /// What the operating system says.
        reason: std::io::Error,
    },
    /// The file is read, but what it says is no scenario.
    #[error(transparent)]
    #[diagnostic(transparent)]
    Invalid(#[from] Box<InvalidScenario>),
}

impl LoadError {
    /// Every issue on a line of its own, as `file:line:column: field: found ..., expected ...; remedy`.
    pub fn lines(&self) -> Vec<String> {
        match self {
            Self::Read { .. } => vec![self.to_string()],
            Self::Invalid(invalid) => {
                let line = |issue: &LocatedIssue| {
                    format!("{}:{}:{}: {}", invalid.name, issue.line, issue.column, issue.summary())
                };
                invalid.issues.iter().map(line).collect()
            }
        }
    }

    /// The issues of the file's content, in the order of the file; none if it could not be read.
    pub fn issues(&self) -> &[LocatedIssue] {
        match self {
            Self::Read { .. } => &[],
            Self::Invalid(invalid) => &invalid.issues,
        }
    }
}

/// A file whose content is no scenario, and everything that is wrong with it.
#[derive(Debug, Error, Diagnostic)]
#[error("{name} is not a valid scenario: {} {}", issues.len(), if issues.len() == 1 { "error" } else { "errors" })]
pub struct InvalidScenario {
    /// The file, as the user named it.
    pub name: String,
    #[source_code]
    text: NamedSource<String>,
    /// What is wrong, in the order of the file.
    #[related]
    pub issues: Vec<LocatedIssue>,
}

impl InvalidScenario {
    /// - `issues`: what is wrong, with the bytes of `text` where it stands
    pub(super) fn new(name: &str, text: &str, issues: Vec<(Issue, Range<usize>)>) -> Self {
        let mut issues: Vec<LocatedIssue> =
            issues.into_iter().map(|(issue, span)| LocatedIssue::new(issue, span, text)).collect();
        issues.sort_by_key(|issue| (issue.line, issue.column));
        Self { name: name.to_owned(), text: NamedSource::new(name, text.to_owned()), issues }
    }
}

/// One thing that is wrong, and where.
#[derive(Clone, Debug, Error, Diagnostic)]
#[error("{issue}")]
pub struct LocatedIssue {
    /// What is wrong.
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

    /// What is wrong and how to mend it, on one line.
    fn summary(&self) -> String {
        match &self.help {
            Some(help) => format!("{}; {help}", self.issue),
            None => self.issue.to_string(),
        }
    }
}
