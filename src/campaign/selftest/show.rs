//! The results as tables on the terminal and as a page in Markdown.

use std::fmt::Write;

use super::{Coverage, FaultResult, Selftest};
use crate::output::report::table;

/// A check that failed for a fault.
const FAILED: char = '●';
/// The target check of a fault, if it failed.
const TARGET: char = '◆';
/// A check that passed.
const PASSED: char = '·';

/// The text for the terminal: faults against checks, unexpected results, and the score.
pub fn text(selftest: &Selftest) -> String {
    let mut parts: Vec<String> = families(selftest).into_iter().map(|family| matrix(selftest, family)).collect();
    parts.push(remarks(selftest).join("\n"));
    parts.retain(|part| !part.is_empty());
    parts.join("\n\n")
}

/// The same as a page in Markdown.
pub fn markdown(selftest: &Selftest) -> String {
    let mut page = format!("# Selftest: {}\n\n", score(selftest));
    for remark in remarks(selftest) {
        let _ = writeln!(page, "- {remark}");
    }
    for family in families(selftest) {
        let _ = write!(page, "\n## {family}\n\n| fault | target check | caught | failed checks |\n|---|---|---|---|\n");
        for fault in faults(selftest, family) {
            let caught = if fault.caught { "yes" } else { "**no**" };
            let _ = writeln!(
                page,
                "| {} | `{}` | {caught} | {} |",
                fault.fault,
                fault.aims_at,
                fault.failed_checks.join(", ")
            );
        }
        page.push_str("\n| check | faults for which it failed |\n|---|---:|\n");
        for check in checks(selftest, family) {
            let _ = writeln!(page, "| `{}` | {} |", check.check, check.faults);
        }
    }
    page.push_str("\n## Near misses\n\n| near miss | scenario | passed |\n|---|---|---|\n");
    for near_miss in &selftest.near_misses {
        let passed =
            if near_miss.passed { "yes".to_owned() } else { format!("**no**: {}", near_miss.failed_checks.join(", ")) };
        let _ = writeln!(page, "| {} | {} | {passed} |", near_miss.near_miss, near_miss.scenario);
    }
    page
}

/// Faults against checks, one character for each pair, with a legend of the checks.
fn matrix(selftest: &Selftest, family: &str) -> String {
    let checks: Vec<&Coverage> = checks(selftest, family).collect();
    let mut shown = table::with_header(&["", "fault", "checks"], &[]);
    for fault in faults(selftest, family) {
        let mark = if fault.caught { "" } else { "PASSED" };
        let row: String = checks.iter().map(|check| cell(fault, &check.check)).collect();
        shown.add_row([mark, fault.fault, &row]);
    }
    let numbered = |(index, check): (usize, &&Coverage)| format!("{:>2} {} ({})", index + 1, check.check, check.faults);
    let legend: Vec<String> = checks.iter().enumerate().map(numbered).collect();
    let legend: Vec<String> =
        legend.chunks(3).map(|three| three.iter().map(|it| format!("{it:<34}")).collect()).collect();
    let legend = legend.iter().map(|line| line.trim_end()).collect::<Vec<_>>().join("\n");
    let checks = "checks from left to right, with the number of faults for which each failed";
    format!(
        "{family}\n{}\n{TARGET} target check that failed, {FAILED} other check that failed, {PASSED} passed; {checks}:\n{legend}",
        shown.trim_fmt()
    )
}

fn cell(fault: &FaultResult, check: &str) -> char {
    if !fault.failed_checks.iter().any(|failed| failed == check) {
        PASSED
    } else if fault.aims_at == check {
        TARGET
    } else {
        FAILED
    }
}

/// Unexpected results, one per line, and the score at the end.
fn remarks(selftest: &Selftest) -> Vec<String> {
    let missed = selftest.faults.iter().filter(|fault| !fault.caught);
    let missed = missed.map(|fault| {
        let failed =
            if fault.failed_checks.is_empty() { "no check failed".to_owned() } else { fault.failed_checks.join(", ") };
        format!("fault not caught: {} ({}), target check {}: {failed}", fault.fault, fault.scenario, fault.aims_at)
    });
    let failed = selftest.near_misses.iter().filter(|near_miss| !near_miss.passed);
    let failed = failed
        .map(|it| format!("near miss failed: {} ({}): {}", it.near_miss, it.scenario, it.failed_checks.join(", ")));
    let idle = selftest.checks.iter().filter(|check| check.faults == 0);
    let idle = idle.map(|check| format!("no fault fails {} ({})", check.check, check.family));
    missed.chain(failed).chain(idle).chain([score(selftest)]).collect()
}

fn score(selftest: &Selftest) -> String {
    let Selftest { faults, near_misses, checks, .. } = selftest;
    let count = |good: usize, all: usize| format!("{good} of {all}");
    format!(
        "{} faults caught, {} near misses passed, {} checks failed for some fault",
        count(faults.iter().filter(|fault| fault.caught).count(), faults.len()),
        count(near_misses.iter().filter(|near_miss| near_miss.passed).count(), near_misses.len()),
        count(checks.iter().filter(|check| check.faults > 0).count(), checks.len())
    )
}

fn families(selftest: &Selftest) -> Vec<&str> {
    let mut families: Vec<&str> = selftest.checks.iter().map(|check| check.family.as_str()).collect();
    families.dedup();
    families
}

fn faults<'a>(selftest: &'a Selftest, family: &'a str) -> impl Iterator<Item = &'a FaultResult> {
    selftest.faults.iter().filter(move |fault| fault.family == family)
}

fn checks<'a>(selftest: &'a Selftest, family: &'a str) -> impl Iterator<Item = &'a Coverage> {
    selftest.checks.iter().filter(move |check| check.family == family)
}
