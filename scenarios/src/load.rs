//! From the text of a file to a scenario that holds together, or to a list of everything that is wrong with it.

mod error;
mod finite;
mod position;
mod shape;

use std::ops::Range;
use std::path::Path;

use serde::Deserialize;
use toml::Spanned;
use toml::de::{DeTable, Deserializer};

pub use error::{InvalidScenario, LoadError, LocatedIssue};

use crate::{Issue, Scenario, validate};

/// Reads and validates a scenario file.
pub fn load(path: &Path) -> Result<Scenario, LoadError> {
    ScenarioFile::read(path)?.scenario()
}

/// Validates the text of a scenario file. `name` stands for the file in messages; its stem must be the scenario's name.
pub fn parse(name: &str, text: &str) -> Result<Scenario, LoadError> {
    ScenarioFile::new(name, text).scenario()
}

/// The text of a scenario file, kept so that whoever finds issue with a field later can point to it.
#[derive(Clone, Debug)]
pub struct ScenarioFile {
    name: String,
    text: String,
}

impl ScenarioFile {
    /// A file with this name and this text.
    pub fn new(name: impl Into<String>, text: impl Into<String>) -> Self {
        Self { name: name.into(), text: text.into() }
    }

    /// Reads the file.
    pub fn read(path: &Path) -> Result<Self, LoadError> {
        let text = std::fs::read_to_string(path).map_err(|reason| LoadError::Read { path: path.to_owned(), reason })?;
        Ok(Self::new(path.display().to_string(), text))
    }

    /// The file, as the user named it.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Line, from 1, on which the value of `field` stands; `None` if the file leaves it to its default.
    pub fn line_of(&self, field: &str) -> Option<usize> {
        let tree = DeTable::parse(&self.text).ok()?;
        let span = position::exact_span(tree.get_ref(), field)?;
        Some(position::line_and_column(&self.text, span.start).0)
    }

    /// The scenario in this file. All issues of the file are reported together, as far as they can be told apart: a
    /// text that is no TOML says nothing about fields, and without a field that must be there (or with one of the wrong
    /// kind) there is no scenario yet whose values could be judged.
    pub fn scenario(&self) -> Result<Scenario, LoadError> {
        let tree = self.tree()?;
        let mut issues = shape::issues(&Scenario::json_schema(), &tree);
        let unknown_keys = issues.iter().filter(|(issue, _)| issue.found == shape::UNKNOWN_KEY);
        let known = position::without(&tree, unknown_keys.map(|(issue, _)| issue.field.as_str()));
        issues.extend(finite::issues(tree.get_ref()));
        match Scenario::deserialize(Deserializer::from(known)) {
            Ok(scenario) => {
                let semantic = self.name_issue(&scenario).into_iter().chain(validate(&scenario));
                let fresh: Vec<Issue> = semantic.filter(|issue| !is_reported(&issue.field, &issues)).collect();
                issues.extend(fresh.into_iter().map(|issue| locate(tree.get_ref(), issue)));
                if issues.is_empty() { Ok(scenario) } else { Err(self.invalid(issues)) }
            }
            Err(error) if issues.is_empty() => Err(self.invalid(vec![beyond_the_schema(&error)])),
            Err(_) => Err(self.invalid(issues)),
        }
    }

    /// An error that points to the fields of this file that `issues` are about.
    pub fn error(&self, issues: Vec<Issue>) -> LoadError {
        let located = |issue: Issue| match DeTable::parse(&self.text) {
            Ok(tree) => locate(tree.get_ref(), issue),
            Err(_) => (issue, 0..0),
        };
        self.invalid(issues.into_iter().map(located).collect())
    }

    fn tree(&self) -> Result<Spanned<DeTable<'_>>, LoadError> {
        let (tree, errors) = DeTable::parse_recoverable(&self.text);
        if errors.is_empty() { Ok(tree) } else { Err(self.invalid(errors.iter().map(syntax_issue).collect())) }
    }

    fn name_issue(&self, scenario: &Scenario) -> Option<Issue> {
        let stem = Path::new(&self.name).file_stem()?.to_string_lossy().into_owned();
        (scenario.name != stem).then(|| {
            Issue::new("name", format!("\"{}\"", scenario.name), format!("\"{stem}\", as the file is named"))
                .remedy("change the name, or rename the file")
        })
    }

    fn invalid(&self, issues: Vec<(Issue, Range<usize>)>) -> LoadError {
        Box::new(InvalidScenario::new(&self.name, &self.text, issues)).into()
    }
}

fn locate(tree: &DeTable<'_>, issue: Issue) -> (Issue, Range<usize>) {
    let span = position::span_of_field(tree, &issue.field);
    (issue, span)
}

fn syntax_issue(error: &toml::de::Error) -> (Issue, Range<usize>) {
    let (found, expected) = error.message().split_once(", expected ").unwrap_or((error.message(), "valid TOML"));
    (Issue::new("TOML syntax", found, expected), error.span().unwrap_or(0..0))
}

/// The last word is serde's: should the schema let something through that the types refuse, it is reported as this.
fn beyond_the_schema(error: &toml::de::Error) -> (Issue, Range<usize>) {
    let issue = Issue::new("scenario", error.message(), "the form that `harness schema scenario` shows");
    (issue, error.span().unwrap_or(0..0))
}

/// Is one of `issues` about `field`, about a part of it, or about what it is a part of?
fn is_reported(field: &str, issues: &[(Issue, Range<usize>)]) -> bool {
    issues.iter().any(|(known, _)| known.field.starts_with(field) || field.starts_with(&known.field))
}
