//! The results as a table on the terminal and as a page.

use std::fmt::Write;

use super::{Coverage, FaultResult, Selftest};
use crate::output::report::table;

/// A fault that turned a check red; the check that it aims at; and one that stayed green.
const RED: char = '●';
const AIM: char = '◆';
const GREEN: char = '·';

/// Everything for the terminal: which fault turns which check red, what passed that should not have, and the score.
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
        let _ = write!(page, "\n## {family}\n\n| fault | aims at | caught | turned red |\n|---|---|---|---|\n");
        for fault in faults(selftest, family) {
            let caught = if fault.caught { "yes" } else { "**no**" };
            let _ = writeln!(page, "| {} | `{}` | {caught} | {} |", fault.fault, fault.aims_at, fault.red.join(", "));
        }
        page.push_str("\n| check | faults that turn it red |\n|---|---:|\n");
        for check in checks(selftest, family) {
            let _ = writeln!(page, "| `{}` | {} |", check.check, check.faults);
        }
    }
    page.push_str("\n## Near misses\n\n| near miss | scenario | passed |\n|---|---|---|\n");
    for near_miss in &selftest.near_misses {
        let passed = if near_miss.green { "yes".to_owned() } else { format!("**no**: {}", near_miss.red.join(", ")) };
        let _ = writeln!(page, "| {} | {} | {passed} |", near_miss.near_miss, near_miss.scenario);
    }
    page
}

/// Faults against checks, one letter for each pair, with the checks numbered below.
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
    let checks = "checks from left to right, with the number of faults that turn each red";
    format!(
        "{family}\n{}\n{AIM} the check that is aimed at, {RED} another that turned red, {GREEN} green; {checks}:\n{legend}",
        shown.trim_fmt()
    )
}

fn cell(fault: &FaultResult, check: &str) -> char {
    if !fault.red.iter().any(|red| red == check) {
        GREEN
    } else if fault.aims_at == check {
        AIM
    } else {
        RED
    }
}

/// What is wrong, line by line, and the score at the end.
fn remarks(selftest: &Selftest) -> Vec<String> {
    let missed = selftest.faults.iter().filter(|fault| !fault.caught);
    let missed = missed.map(|fault| {
        let red = if fault.red.is_empty() { "nothing turned red".to_owned() } else { fault.red.join(", ") };
        format!("a fault passed: {} ({}), aimed at {}: {red}", fault.fault, fault.scenario, fault.aims_at)
    });
    let red = selftest.near_misses.iter().filter(|near_miss| !near_miss.green);
    let red = red.map(|it| format!("a near miss failed: {} ({}): {}", it.near_miss, it.scenario, it.red.join(", ")));
    let idle = selftest.checks.iter().filter(|check| check.faults == 0);
    let idle = idle.map(|check| format!("no fault turns {} red ({})", check.check, check.family));
    missed.chain(red).chain(idle).chain([score(selftest)]).collect()
}

fn score(selftest: &Selftest) -> String {
    let Selftest { faults, near_misses, checks, .. } = selftest;
    let count = |good: usize, all: usize| format!("{good} of {all}");
    format!(
        "{} faults caught, {} near misses passed, {} checks turned red by a fault",
        count(faults.iter().filter(|fault| fault.caught).count(), faults.len()),
        count(near_misses.iter().filter(|near_miss| near_miss.green).count(), near_misses.len()),
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
