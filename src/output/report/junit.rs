//! `junit.xml`: one suite per scenario and planner, one case per check, for CI servers.

use std::time::Duration;

use chrono::Utc;
use quick_junit::{NonSuccessKind, Report as Document, TestCase, TestCaseStatus, TestSuite, XmlString};

use super::{RefusedFile, Summary, headline};
use crate::number_format::given_quantity;
use crate::report::Report;
use crate::verdict::{Check, Outcome, Status};

/// The whole run as XML, valid against the schema of Jenkins' xUnit plugin (`junit-10.xsd`) and against that of Apache Ant
/// (`JUnit.xsd` of Windy Road).
///
/// - `summary`: of the same jobs; if they were compared with a baseline, every suite has one more case, `baseline`
///
/// # Errors
///
/// Those of the XML writer.
pub fn document(reports: &[Report], summary: &Summary) -> Result<String, quick_junit::SerializeError> {
    let suites = reports.iter().map(|report| suite(report, summary));
    let suites = suites.chain(summary.refused.iter().map(refused_suite));
    let mut document = Document::new("harness");
    document.add_test_suites(suites.enumerate().map(|(id, suite)| completed(suite, id)));
    document.to_string().map(|xml| without_attributes_of_the_root(&xml))
}

/// The suite with everything that the schemas demand: identity, host and time, a duration of every case, both streams.
fn completed(mut suite: TestSuite, id: usize) -> TestSuite {
    let timestamp = Utc::now().format("%Y-%m-%dT%H:%M:%S").to_string();
    let attributes =
        [("id", id.to_string()), ("package", "harness".to_owned()), ("hostname", host()), ("timestamp", timestamp)];
    suite.extra.extend(attributes.map(|(name, value)| (name.into(), value.into())));
    suite.time.get_or_insert_default();
    suite.test_cases.iter_mut().for_each(|case| {
        case.time.get_or_insert_default();
    });
    suite.system_out.get_or_insert_with(|| XmlString::new(""));
    suite.system_err.get_or_insert_with(|| XmlString::new(""));
    suite
}

/// Jenkins' schema has no `skipped` on `testsuites`, Ant's has no attribute at all; readers add up the suites.
fn without_attributes_of_the_root(xml: &str) -> String {
    match xml.split_once("<testsuites ") {
        Some((head, rest)) => format!("{head}<testsuites{}", rest.find('>').map_or(rest, |end| &rest[end..])),
        None => xml.to_owned(),
    }
}

#[cfg(unix)]
fn host() -> String {
    let name = rustix::system::uname().nodename().to_string_lossy().trim().to_owned();
    if name.is_empty() { "localhost".to_owned() } else { name }
}

#[cfg(not(unix))]
fn host() -> String {
    "localhost".to_owned()
}

fn suite(report: &Report, summary: &Summary) -> TestSuite {
    let mut suite = TestSuite::new(format!("{} · {}", report.scenario, report.planner));
    suite.set_time(Duration::try_from_secs_f64(report.timings.total_s()).unwrap_or_default());
    suite.add_property(("seed", report.seed.to_string().as_str()));
    suite.add_property(("harness", report.harness.as_str()));
    suite.add_property(("verdict", report.verdict.to_string().as_str()));
    if report.verdict == Outcome::NoPlan {
        let mut status = TestCaseStatus::non_success(NonSuccessKind::Error);
        status.set_type("no-plan").set_message(headline::reason(report));
        suite.add_test_case(case(report, "plan", status));
    }
    suite.add_test_cases(report.checks.iter().map(|check| case(report, &check.name, status(report, check))));
    for check in report.checks.iter().filter(|check| check.status != Status::Skip) {
        let figures = [("value", check.value), ("limit", check.limit), ("margin", check.margin)];
        for (what, value) in figures.into_iter().filter_map(|(what, value)| Some((what, value?))) {
            let name = format!("{}.{what}", check.name);
            suite.add_property((name.as_str(), given_quantity(value, &check.unit).as_str()));
        }
    }
    suite.set_system_out(standard_output(report));
    if summary.worse_than_baseline.is_some() {
        suite.add_test_case(case(report, "baseline", against_baseline(summary.losses(report))));
    }
    suite
}

/// Every check in a line, and the notes: Ant's schema has no output of single cases.
fn standard_output(report: &Report) -> String {
    let checks = report.checks.iter().filter(|check| check.status != Status::Skip);
    let lines = checks.map(|check| format!("{:<9} {}", check.status, headline::sentence(check)));
    lines.chain(headline::notes(report)).collect::<Vec<_>>().join("\n")
}

fn case(report: &Report, name: &str, status: TestCaseStatus) -> TestCase {
    let mut case = TestCase::new(name.to_owned(), status);
    case.set_classname(format!("{}.{}", report.scenario, report.planner));
    case
}

fn status(report: &Report, check: &Check) -> TestCaseStatus {
    match check.status {
        Status::Pass => TestCaseStatus::success(),
        Status::Skip => skipped(check.reason.clone().unwrap_or_default()),
        // The error of the case `plan` says it all.
        Status::Fail | Status::Undecided if report.verdict == Outcome::NoPlan => skipped("there is no plan".into()),
        Status::Fail | Status::Undecided if check.advisory => {
            skipped(format!("advisory, does not decide: {}", headline::line(check)))
        }
        Status::Fail => failure("fail", check),
        Status::Undecided => failure("undecided", check),
    }
}

/// Passes unless something got worse.
fn against_baseline(losses: &[String]) -> TestCaseStatus {
    if losses.is_empty() {
        return TestCaseStatus::success();
    }
    let mut status = TestCaseStatus::non_success(NonSuccessKind::Failure);
    status.set_type("worse-than-baseline").set_message(format!("worse than the baseline: {}", losses[0]));
    status.set_description(XmlString::new(losses.join("\n")));
    status
}

fn skipped(reason: String) -> TestCaseStatus {
    let mut status = TestCaseStatus::skipped();
    status.set_message(reason);
    status
}

fn failure(kind: &str, check: &Check) -> TestCaseStatus {
    let mut status = TestCaseStatus::non_success(NonSuccessKind::Failure);
    status.set_type(kind).set_message(headline::line(check)).set_description(headline::sentence(check));
    status
}

fn refused_suite(refused: &RefusedFile) -> TestSuite {
    let mut suite = TestSuite::new(refused.file.clone());
    suite.add_property(("verdict", "refused as bad input"));
    let mut status = TestCaseStatus::non_success(NonSuccessKind::Error);
    status.set_type("bad-input").set_message(refused.faults.first().cloned().unwrap_or_default());
    status.set_description(XmlString::new(refused.faults.join("\n")));
    let mut case = TestCase::new("load", status);
    case.set_classname(refused.file.clone());
    suite.add_test_case(case);
    suite
}
