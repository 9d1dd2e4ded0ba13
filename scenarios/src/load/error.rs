use std::ops::Range;
use std::path::PathBuf;

use miette::{Diagnostic, NamedSource, SourceSpan};
use thiserror::Error;

use super::position::line_and_column;
use crate::Problem;

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
    Invalid(#[from] Box<Invalid>),
}

impl LoadError {
    /// Every fault on a line of its own, as `file:line:column: field: found ..., expected ...; remedy`.
    pub fn lines(&self) -> Vec<String> {
        match self {
            Self::Read { .. } => vec![self.to_string()],
            Self::Invalid(invalid) => {
                let line =
                    |fault: &Fault| format!("{}:{}:{}: {}", invalid.name, fault.line, fault.column, fault.summary());
                invalid.faults.iter().map(line).collect()
            }
        }
    }

    /// The faults of the file's content, in the order of the file; none if it could not be read.
    pub fn faults(&self) -> &[Fault] {
        match self {
            Self::Read { .. } => &[],
            Self::Invalid(invalid) => &invalid.faults,
        }
    }
}

/// A file whose content is no scenario, and everything that is wrong with it.
#[derive(Debug, Error, Diagnostic)]
#[error("{name} is no scenario: {} {}", faults.len(), if faults.len() == 1 { "fault" } else { "faults" })]
pub struct Invalid {
    /// The file, as the user named it.
    pub name: String,
    #[source_code]
    text: NamedSource<String>,
    /// What is wrong, in the order of the file.
    #[related]
    pub faults: Vec<Fault>,
}

impl Invalid {
    /// - `faults`: what is wrong, with the bytes of `text` where it stands
    pub(super) fn new(name: &str, text: &str, faults: Vec<(Problem, Range<usize>)>) -> Self {
        let mut faults: Vec<Fault> =
            faults.into_iter().map(|(problem, span)| Fault::new(problem, span, text)).collect();
        faults.sort_by_key(|fault| (fault.line, fault.column));
        Self { name: name.to_owned(), text: NamedSource::new(name, text.to_owned()), faults }
    }
}

/// One thing that is wrong, and where.
#[derive(Clone, Debug, Error, Diagnostic)]
#[error("{problem}")]
pub struct Fault {
    /// What is wrong.
    pub problem: Problem,
    /// Line, from 1.
    pub line: usize,
    /// Column in characters, from 1.
    pub column: usize,
    #[label("here")]
    span: SourceSpan,
    #[help]
    help: Option<String>,
}

impl Fault {
    fn new(problem: Problem, span: Range<usize>, text: &str) -> Self {
        let (line, column) = line_and_column(text, span.start);
        let help = Some(problem.remedy.clone()).filter(|remedy| !remedy.is_empty());
        Self { problem, line, column, span: span.into(), help }
    }

    /// What is wrong and how to mend it, on one line.
    fn summary(&self) -> String {
        match &self.help {
            Some(help) => format!("{}; {help}", self.problem),
            None => self.problem.to_string(),
        }
    }
}
