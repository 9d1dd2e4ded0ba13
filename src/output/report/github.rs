//! What GitHub shows of a run: annotations on the lines of scenario files, and the job's summary page.

use std::env;
use std::fs::OpenOptions;
use std::io::Write;
use std::path::{Path, PathBuf};

use scenarios::{LoadError, LocatedIssue, Scenario, ScenarioFile};

use super::{headline, scenario_field};
use crate::error::Error;
use crate::report::Report;
use crate::verdict::Check;

/// GitHub shows so many errors of one step.
const MOST_ANNOTATIONS: usize = 10;
/// Size up to which GitHub takes a summary, bytes; some of it is left for other steps' words on the page.
const MOST_SUMMARY: usize = (1 << 20) - (64 << 10);

/// Is this a step of a GitHub workflow?
pub fn is_present() -> bool {
    env::var_os("GITHUB_ACTIONS").is_some_and(|value| value == "true")
}

/// The report of a job, and the scenario that it is about.
pub struct Finding<'a> {
    /// What was found.
    pub report: &'a Report,
    /// The question.
    pub scenario: &'a Scenario,
    /// The file that it stands in.
    pub source: &'a ScenarioFile,
}

/// One line per annotation, for the worst few failures: each points to the line of the scenario file in which the limit
/// stands that was broken. Every finding gets one before any gets two.
pub fn annotations(findings: &[Finding<'_>]) -> Vec<String> {
    let mut ranked: Vec<(usize, f64, String)> = Vec::new();
    for finding in findings {
        let mut failed: Vec<&Check> = headline::failed(finding.report).collect();
        failed.sort_by(|a, b| severity(b).total_cmp(&severity(a)));
        let reason = (finding.report.verdict == crate::verdict::Outcome::NoPlan).then_some(finding);
        match reason {
            Some(finding) => ranked.push((0, f64::INFINITY, no_plan(finding))),
            None => ranked
                .extend(failed.iter().enumerate().map(|(rank, check)| (rank, severity(check), broken(finding, check)))),
        }
    }
    ranked.sort_by(|a, b| (a.0).cmp(&b.0).then(b.1.total_cmp(&a.1)));
    ranked.into_iter().take(MOST_ANNOTATIONS).map(|(_, _, line)| line).collect()
}

/// One line per fault of a file that is no scenario.
pub fn annotations_of(error: &Error) -> Vec<String> {
    let Error::Load(error @ LoadError::Invalid(invalid)) = error else { return Vec::new() };
    let line = |fault: &LocatedIssue| command(&invalid.name, fault.line, "bad input", &fault.issue.to_string());
    error.issues().iter().take(MOST_ANNOTATIONS).map(line).collect()
}

/// Appends `page` to the job's summary, if the environment names one.
pub fn add_to_job_summary(page: &str) -> Result<(), Error> {
    let Some(path) = env::var_os("GITHUB_STEP_SUMMARY").filter(|path| !path.is_empty()).map(PathBuf::from) else {
        return Ok(());
    };
    let append = || {
        let mut file = OpenOptions::new().create(true).append(true).open(&path)?;
        writeln!(file, "{}", super::markdown::cut(page, MOST_SUMMARY))
    };
    append().map_err(|reason: std::io::Error| Error::Write { path: path.clone(), reason: reason.into() })
}

/// How far beyond its limit, as a share of it; what could not be measured at all comes first.
fn severity(check: &Check) -> f64 {
    match (check.margin, check.limit) {
        (Some(margin), Some(limit)) => -margin / limit.abs().max(1e-3),
        _ => f64::INFINITY,
    }
}

fn broken(finding: &Finding<'_>, check: &Check) -> String {
    let fields = scenario_field::candidates(check, finding.scenario);
    let line = fields.iter().find_map(|field| finding.source.line_of(field)).unwrap_or(1);
    let title = format!("{} · {}: {}", finding.report.scenario, finding.report.planner, check.name);
    command(finding.source.name(), line, &title, &headline::sentence(check))
}

fn no_plan(finding: &Finding<'_>) -> String {
    let fields = ["planner.command", "planner.name"];
    let line = fields.iter().find_map(|field| finding.source.line_of(field)).unwrap_or(1);
    let title = format!("{} · {}: no plan", finding.report.scenario, finding.report.planner);
    command(finding.source.name(), line, &title, &headline::reason(finding.report))
}

/// A workflow command. [docs.github.com, Workflow commands for GitHub Actions]
fn command(file: &str, line: usize, title: &str, message: &str) -> String {
    let (file, title) = (property(&in_repository(file)), property(title));
    format!("::error file={file},line={line},title={title}::{}", data(message))
}

/// The file's path as the repository knows it.
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
    fn what_would_end_a_property_is_escaped() {
        let line = command("no-such-folder/a,b.toml", 3, "pair · mine: goal", "100 %\nof it: lost, all");
        let expected =
            "::error file=no-such-folder/a%2Cb.toml,line=3,title=pair · mine%3A goal::100 %25%0Aof it: lost, all";
        assert_eq!(line, expected);
    }
}
