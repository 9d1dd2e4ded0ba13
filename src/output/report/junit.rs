//! `junit.xml`: one suite per scenario and planner, one case per check, for CI servers.

use std::time::Duration;

use quick_junit::{NonSuccessKind, Report as Document, TestCase, TestCaseStatus, TestSuite, XmlString};

use super::{RefusedFile, headline};
use crate::campaign::comparison::{Comparison, Difference};
use crate::report::Report;
use crate::verdict::{Check, Outcome, Status};

/// The whole run as XML.
///
/// - `comparison`: with the baseline, if there is one; every suite then has one more case, `baseline`
pub fn document(
    reports: &[Report],
    refused: &[RefusedFile],
    comparison: Option<&Comparison>,
) -> Result<String, quick_junit::SerializeError> {
    let mut document = Document::new("harness");
    document.add_test_suites(reports.iter().map(|report| suite(report, comparison)));
    document.add_test_suites(refused.iter().map(refused_suite));
    document.to_string()
}

fn suite(report: &Report, comparison: Option<&Comparison>) -> TestSuite {
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
    let notes = headline::notes(report);
    if !notes.is_empty() {
        suite.set_system_out(notes.join("\n"));
    }
    let losses = comparison.map(|comparison| comparison.losses(&report.scenario, &report.planner));
    suite.add_test_cases(losses.map(|losses| case(report, "baseline", against_baseline(&losses))));
    suite
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
fn against_baseline(losses: &[&Difference]) -> TestCaseStatus {
    if losses.is_empty() {
        return TestCaseStatus::success();
    }
    let sentences: Vec<String> = losses.iter().map(|loss| loss.sentence()).collect();
    let mut status = TestCaseStatus::non_success(NonSuccessKind::Failure);
    status.set_type("worse-than-baseline").set_message(format!("worse than the baseline: {}", sentences[0]));
    status.set_description(XmlString::new(sentences.join("\n")));
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
    let mut status = TestCaseStatus::non_success(NonSuccessKind::Error);
    status.set_type("bad-input").set_message(refused.faults.first().cloned().unwrap_or_default());
    status.set_description(XmlString::new(refused.faults.join("\n")));
    let mut case = TestCase::new("load", status);
    case.set_classname(refused.file.clone());
    suite.add_test_case(case);
    suite
}
