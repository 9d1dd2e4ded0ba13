//! GitHub Actions: annotations on lines of scenario files, and the job summary.

use std::env;
use std::fs::OpenOptions;
use std::io::Write;
use std::path::{Path, PathBuf};

use scenarios::{LoadError, LocatedIssue, Scenario, ScenarioFile};

use super::{headline, scenario_field};
use crate::campaign::comparison::Difference;
use crate::error::Error;
use crate::report::Report;
use crate::verdict::{Check, Outcome};

/// Number of errors that GitHub shows for one step.
const MAX_ANNOTATIONS: usize = 10;
/// Largest job summary, bytes: GitHub's limit less some space for other steps.
const MAX_SUMMARY_BYTES: usize = (1 << 20) - (64 << 10);

/// Is this a step of a GitHub workflow?
pub fn is_github_actions() -> bool {
    env::var_os("GITHUB_ACTIONS").is_some_and(|value| value == "true")
}

/// A job, as far as its annotations need it.
pub struct Finding<'a> {
    /// Its report.
    pub report: &'a Report,
    /// Its scenario.
    pub scenario: &'a Scenario,
    /// The file of the scenario.
    pub source: &'a ScenarioFile,
    /// What got worse than the baseline.
    pub losses: Vec<&'a Difference>,
}

/// An annotation in the making.
struct Annotation {
    /// Its place among those of its finding, from 0.
    rank: usize,
    /// How far beyond the limit; orders annotations of the same rank.
    severity: f64,
    line: String,
}

/// One annotation per line, for the most severe failures and for losses against the baseline. Each points to the line of
/// the scenario file in which the limit stands. Every finding gets one before any gets two.
pub fn annotations(findings: &[Finding<'_>]) -> Vec<String> {
    let mut annotations: Vec<Annotation> = findings.iter().flat_map(of_finding).collect();
    annotations.sort_by(|a, b| a.rank.cmp(&b.rank).then(b.severity.total_cmp(&a.severity)));
    annotations.into_iter().take(MAX_ANNOTATIONS).map(|annotation| annotation.line).collect()
}

fn of_finding(finding: &Finding<'_>) -> Vec<Annotation> {
    let mut lines: Vec<(f64, String)> = if finding.report.verdict == Outcome::NoPlan {
        vec![(f64::INFINITY, no_plan(finding))]
    } else {
        let mut failed: Vec<&Check> = headline::failed(finding.report).collect();
        failed.sort_by(|a, b| severity(b).total_cmp(&severity(a)));
        failed.into_iter().map(|check| (severity(check), failed_check(finding, check))).collect()
    };
    // Severities of failures are positive.
    lines.extend(worse(finding).map(|line| (0.0, line)));
    lines.into_iter().enumerate().map(|(rank, (severity, line))| Annotation { rank, severity, line }).collect()
}

/// One annotation per line for the faults of a file that is not a scenario.
pub fn load_error_annotations(error: &Error) -> Vec<String> {
    let Error::Load(error @ LoadError::Invalid(invalid)) = error else { return Vec::new() };
    let line = |fault: &LocatedIssue| command(&invalid.name, fault.line, "bad input", &fault.issue.to_string());
    error.issues().iter().take(MAX_ANNOTATIONS).map(line).collect()
}

/// Appends `page` to the job's summary, if the environment names one.
///
/// # Errors
///
/// [`Error::Write`] if the file of the summary cannot be written.
pub fn add_to_job_summary(page: &str) -> Result<(), Error> {
    let Some(path) = env::var_os("GITHUB_STEP_SUMMARY").filter(|path| !path.is_empty()).map(PathBuf::from) else {
        return Ok(());
    };
    let append = || {
        let mut file = OpenOptions::new().create(true).append(true).open(&path)?;
        writeln!(file, "{}", super::markdown::truncate(page, MAX_SUMMARY_BYTES))
    };
    append().map_err(|reason: std::io::Error| Error::Write { path: path.clone(), reason: reason.into() })
}

/// How far beyond its limit, as a fraction of it; infinite for a check that could not be measured.
fn severity(check: &Check) -> f64 {
    match (check.margin, check.limit) {
        (Some(margin), Some(limit)) => -margin / limit.abs().max(1e-3),
        _ => f64::INFINITY,
    }
}

fn failed_check(finding: &Finding<'_>, check: &Check) -> String {
    let line = limit_line(finding, check);
    annotation(finding, line, &check.name, &headline::sentence(check))
}

/// All losses against the baseline in one annotation, on the line of the first one's limit.
fn worse(finding: &Finding<'_>) -> Option<String> {
    let first = finding.losses.first()?;
    let check = finding.report.checks.iter().find(|check| check.name == first.check());
    let line = check.map_or(1, |check| limit_line(finding, check));
    let losses: Vec<String> = finding.losses.iter().map(|loss| loss.sentence()).collect();
    Some(annotation(finding, line, "worse than the baseline", &losses.join("\n")))
}

fn no_plan(finding: &Finding<'_>) -> String {
    let line = first_line(finding, &["planner.command", "planner.name"]);
    annotation(finding, line, "no plan", &headline::reason(finding.report))
}

fn limit_line(finding: &Finding<'_>, check: &Check) -> usize {
    first_line(finding, &scenario_field::candidates(check, finding.scenario))
}

/// Line of the first of these fields that the file has; 1 if it has none.
fn first_line(finding: &Finding<'_>, fields: &[impl AsRef<str>]) -> usize {
    fields.iter().find_map(|field| finding.source.line_of(field.as_ref())).unwrap_or(1)
}

fn annotation(finding: &Finding<'_>, line: usize, subject: &str, message: &str) -> String {
    let title = format!("{} · {}: {subject}", finding.report.scenario, finding.report.planner);
    command(finding.source.name(), line, &title, message)
}

/// A workflow command. [docs.github.com, Workflow commands for GitHub Actions]
fn command(file: &str, line: usize, title: &str, message: &str) -> String {
    let (file, title) = (property(&in_repository(file)), property(title));
    format!("::error file={file},line={line},title={title}::{}", data(message))
}

/// The file's path relative to the repository, if it is in it.
fn in_repository(file: &str) -> String {
    let workspace = env::var_os("GITHUB_WORKSPACE").map(PathBuf::from).and_then(|path| path.canonicalize().ok());
    let absolute = Path::new(file).canonicalize().ok();
    let relative = absolute.as_ref().zip(workspace.as_ref()).and_then(|(file, root)| file.strip_prefix(root).ok());
    relative.map_or_else(|| file.to_owned(), |path| path.display().to_string())
}

fn data(text: &str) -> String {
    text.replace('%', "%25").replace('\r', "%0D").replace('\n', "%0A")
}

fn property(text: &str) -> String {
    data(text).replace(':', "%3A").replace(',', "%2C")
}

#[cfg(test)]
mod tests {
    use super::command;

    #[test]
    fn delimiters_in_properties_are_escaped() {
        let line = command("no-such-folder/a,b.toml", 3, "pair · mine: goal", "100 %\nof it: lost, all");
        let expected =
            "::error file=no-such-folder/a%2Cb.toml,line=3,title=pair · mine%3A goal::100 %25%0Aof it: lost, all";
        assert_eq!(line, expected);
    }
}
