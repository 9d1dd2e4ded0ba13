//! Loading: from the text of a file to a valid scenario, or to the list of all its issues.

mod error;
mod files;
mod finite;
pub(crate) mod geographic;
mod position;
mod shape;

use std::ops::Range;
use std::path::{Path, PathBuf};

use serde::Deserialize;
use serde_json::Value;
use toml::Spanned;
use toml::de::{DeTable, Deserializer};

pub use error::{InvalidScenario, LoadError, LocatedIssue};

use crate::{Issue, Scenario, shipped, validate};

/// An issue with its byte range in the text.
type SpannedIssue = (Issue, Range<usize>);

/// Reads and validates a scenario file.
///
/// # Errors
///
/// The file cannot be read, or its content is not a valid scenario. All issues are reported together.
pub fn load(path: &Path) -> Result<Scenario, LoadError> {
    ScenarioFile::read(path)?.scenario()
}

/// Parses and validates the text of a scenario file.
///
/// - `name`: name of the file for messages; its stem must be the scenario's name
///
/// # Errors
///
/// The text is not a valid scenario. All issues are reported together.
///
/// # Examples
///
/// ```
/// let error = scenarios::parse("pair.toml", "name = \"pair\"\n[planner]\nnam = \"fleet-scp\"\n").unwrap_err();
/// assert!(error.lines().iter().any(|line| line.starts_with("pair.toml:3:1: planner.nam: found an unknown key")));
/// ```
pub fn parse(name: &str, text: &str) -> Result<Scenario, LoadError> {
    ScenarioFile::new(name, text).scenario()
}

/// A scenario file: its name and text, so that later findings can point to a line.
#[derive(Clone, Debug)]
pub struct ScenarioFile {
    name: String,
    text: String,
}

impl ScenarioFile {
    /// A file with the given name and text.
    pub fn new(name: impl Into<String>, text: impl Into<String>) -> Self {
        Self { name: name.into(), text: text.into() }
    }

    /// Reads the file; `shipped:NAME` is one of the [`shipped`] ones.
    ///
    /// # Errors
    ///
    /// The file cannot be read, or there is no shipped scenario of that name.
    pub fn read(path: &Path) -> Result<Self, LoadError> {
        if let Some(request) = shipped::request(path) {
            return match shipped::select(request).as_deref() {
                Ok([file]) => Ok(Self::new(file.to_path().display().to_string(), file.text)),
                _ => Err(LoadError::NoShipped { path: path.to_owned() }),
            };
        }
        let text = std::fs::read_to_string(path).map_err(|reason| LoadError::Read { path: path.to_owned(), reason })?;
        Ok(Self::new(path.display().to_string(), text))
    }

    /// Name of the file, as the user gave it.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Its text.
    pub fn text(&self) -> &str {
        &self.text
    }

    /// Where a file lies that it refers to: absolute, or below `shipped:`.
    pub fn resolve(&self, file: &str) -> PathBuf {
        files::resolved(file, Path::new(&self.name))
    }

    /// Line of the value of `field`, from 1; `None` if the file does not give it.
    pub fn line_of(&self, field: &str) -> Option<usize> {
        let tree = DeTable::parse(&self.text).ok()?;
        let span = position::exact_span(tree.get_ref(), field)?;
        Some(position::line_and_column(&self.text, span.start).0)
    }

    /// The scenario in this file.
    ///
    /// # Errors
    ///
    /// The text is not a valid scenario. The issues of the first failing stage are reported together: syntax; then keys,
    /// types and finite numbers; then, unless a required field is missing or has the wrong type, also the values.
    pub fn scenario(&self) -> Result<Scenario, LoadError> {
        let tree = self.tree()?;
        let mut issues = shape::issues(&Scenario::json_schema(), &tree);
        let unknown_keys = issues.iter().filter(|(issue, _)| issue.found == shape::UNKNOWN_KEY);
        let known = position::without(&tree, unknown_keys.map(|(issue, _)| issue.field.as_str()));
        issues.extend(finite::issues(tree.get_ref()));
        let (parsed, misplaced) = self.parsed(known);
        match parsed {
            Ok(mut scenario) => {
                let unread = files::read(&mut scenario.world, Path::new(&self.name));
                let is_unread = |issue: &Issue| unread.iter().any(|it| it.field == issue.field);
                let valid = validate(&scenario).into_iter().filter(|issue| !is_unread(issue));
                let semantic = self.name_issue(&scenario).into_iter().chain(misplaced).chain(unread.iter().cloned());
                let semantic = semantic.chain(valid);
                let fresh: Vec<Issue> = semantic.filter(|issue| !is_reported(&issue.field, &issues)).collect();
                issues.extend(fresh.into_iter().map(|issue| locate(&self.text, tree.get_ref(), issue)));
                if issues.is_empty() { Ok(scenario) } else { Err(self.invalid(issues)) }
            }
            Err(_) if !misplaced.is_empty() => {
                let fresh: Vec<Issue> = misplaced.into_iter().filter(|it| !is_reported(&it.field, &issues)).collect();
                issues.extend(fresh.into_iter().map(|issue| locate(&self.text, tree.get_ref(), issue)));
                Err(self.invalid(issues))
            }
            Err(issue) => Err(self.invalid(if issues.is_empty() { vec![issue] } else { issues })),
        }
    }

    /// An error that locates `issues` in this file.
    pub fn error(&self, issues: Vec<Issue>) -> LoadError {
        let located = |issue: Issue| match DeTable::parse(&self.text) {
            Ok(tree) => locate(&self.text, tree.get_ref(), issue),
            Err(_) => (issue, 0..0),
        };
        self.invalid(issues.into_iter().map(located).collect())
    }

    /// The scenario in a document, or an error of serde that the schema did not catch; and what is wrong with its positions on the
    /// Earth, which are converted on the way.
    fn parsed(&self, document: Spanned<DeTable<'_>>) -> (Result<Scenario, SpannedIssue>, Vec<Issue>) {
        let given = Value::deserialize(Deserializer::from(document.clone())).unwrap_or_default();
        let mut converted = given.clone();
        let misplaced = geographic::to_world_frame(&mut converted, Path::new(&self.name));
        let scenario = if converted == given {
            Scenario::deserialize(Deserializer::from(document))
                .map_err(|error| not_in_schema(error.message(), error.span()))
        } else {
            Scenario::deserialize(converted).map_err(|error| not_in_schema(&error.to_string(), None))
        };
        (scenario, misplaced)
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

fn locate(text: &str, tree: &DeTable<'_>, issue: Issue) -> (Issue, Range<usize>) {
    let span = position::span_of_field(tree, &issue.field);
    let start = position::within_string(text, &span, issue.byte);
    (issue, start..span.end)
}

fn syntax_issue(error: &toml::de::Error) -> (Issue, Range<usize>) {
    let (found, expected) = error.message().split_once(", expected ").unwrap_or((error.message(), "valid TOML"));
    (Issue::new("TOML syntax", found, expected), error.span().unwrap_or(0..0))
}

/// An error of serde that the schema did not catch.
fn not_in_schema(error: &str, span: Option<Range<usize>>) -> SpannedIssue {
    let issue = Issue::new("scenario", error, "the form that `harness schema scenario` shows");
    (issue, span.unwrap_or(0..0))
}

/// Whether one of `issues` concerns `field`, a part of it, or a parent of it.
fn is_reported(field: &str, issues: &[(Issue, Range<usize>)]) -> bool {
    issues.iter().any(|(known, _)| known.field.starts_with(field) || field.starts_with(&known.field))
}
