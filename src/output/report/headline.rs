//! Verdicts and checks in one line.

use scenarios::PlanStatus;

use crate::number_format::{given_quantity, is_count, quantity, signed_quantity};
use crate::report::Report;
use crate::verdict::{Check, KEY_CHECKS, Outcome, Status};

/// Number of failed checks that are named; the others are counted.
const FAILURES_NAMED: usize = 3;

/// The reason of a verdict: the smallest margins, the failed checks, or why there is no plan.
pub(super) fn reason(report: &Report) -> String {
    match report.verdict {
        Outcome::Pass => smallest_margins(report),
        Outcome::Fail => failures(report),
        Outcome::NoPlan => report.plan.reason.clone().unwrap_or_else(|| "the planner returned no trajectory".into()),
    }
}

/// A note if the planner reports `solved` for a plan that fails checks of the group `plan`.
pub(super) fn overclaim(report: &Report) -> Option<String> {
    let is_false = report.overclaimed && report.plan.status == PlanStatus::Solved;
    is_false.then(|| "the planner calls this plan solved, but it fails checks of the group `plan`".to_owned())
}

/// What a reader should know beyond the checks: of planning in the loop.
pub(super) fn notes(report: &Report) -> Vec<String> {
    let Some(in_loop) = &report.metrics.in_loop else { return Vec::new() };
    let late = (in_loop.late > 0).then(|| {
        format!(
            "planner: {} of {} replans were late, by at most {}; their references were entered after their beginning",
            in_loop.late,
            in_loop.replans,
            quantity(in_loop.latest_s, "s")
        )
    });
    let slow = report.timings.replans.as_ref().filter(|times| times.over_deadline > 0).map(|times| {
        format!(
            "planner: {} of {} answers took longer on this machine than their deadline, {} at most, and were flown in time: \
             with `--planner-clock measured` they are late",
            times.over_deadline,
            in_loop.replans,
            quantity(times.max_s, "s")
        )
    });
    let remarks = in_loop.remarks.iter().map(|remark| format!("planner: {remark}"));
    late.into_iter().chain(slow).chain(remarks).collect()
}

/// Failed and undecided checks that decide.
pub(super) fn failed(report: &Report) -> impl Iterator<Item = &Check> {
    report.checks.iter().filter(|check| check.is_bad() && !check.advisory)
}

/// Failed and undecided advisory checks.
pub(super) fn warnings(report: &Report) -> impl Iterator<Item = &Check> {
    report.checks.iter().filter(|check| check.is_bad() && check.advisory)
}

/// For each telling name the check with the smallest margin over all groups.
fn smallest_margins(report: &Report) -> String {
    let margins: Vec<String> = KEY_CHECKS.iter().filter_map(|name| smallest_margin(&report.checks, name)).collect();
    match margins.as_slice() {
        [] => "every deciding check passed".into(),
        margins => format!("smallest margins: {}", margins.join("; ")),
    }
}

fn smallest_margin(checks: &[Check], name: &str) -> Option<String> {
    let with_margin = checks.iter().filter(|check| check.question() == name && check.margin.is_some());
    let check = with_margin.min_by(|a, b| a.margin.partial_cmp(&b.margin).unwrap_or(std::cmp::Ordering::Equal))?;
    Some(line(check))
}

fn failures(report: &Report) -> String {
    let mut failed: Vec<&Check> = failed(report).collect();
    failed.sort_by_key(|check| precedence(check));
    let asked = report.checks.iter().filter(|check| check.status != Status::Skip).count();
    let first: Vec<String> = failed.iter().take(FAILURES_NAMED).map(|check| line(check)).collect();
    let others = failed.len().saturating_sub(FAILURES_NAMED);
    let rest = if others > 0 { format!("; and {others} more") } else { String::new() };
    format!("{} of {asked} checks failed: {}{rest}", failed.len(), first.join("; "))
}

/// What happened comes before what was planned; a crash, or a flight that is not whole, before what follows from it.
fn precedence(check: &Check) -> usize {
    let order =
        ["flight.crash", "flight.complete", "flight.separation", "flight.clearance", "flight.", "plan.", "nodes."];
    order.iter().position(|prefix| check.name.starts_with(prefix)).unwrap_or(order.len())
}

/// The last lines of a text, indented; empty if it is blank.
pub(super) fn last_lines(text: &str, count: usize) -> String {
    let lines: Vec<&str> = text.trim_end().lines().collect();
    let shown = &lines[lines.len().saturating_sub(count)..];
    shown.iter().map(|line| format!("    {line}")).collect::<Vec<_>>().join("\n")
}

/// A check with value, limit, margin, place and reason, readable on its own.
pub(super) fn sentence(check: &Check) -> String {
    let value = check.value.map(|value| format!("measured {}", quantity(value, &check.unit)));
    let limit = check.limit.map(|limit| format!("limit {}", given_quantity(limit, &check.unit)));
    let margin = check.margin.map(|margin| format!("margin {}", signed_quantity(margin, &check.unit)));
    let at_s = check.at_s.map(|at_s| format!("at {at_s:.2} s"));
    let who = check.who();
    let parts = [value, limit, margin, at_s, who, check.reason.clone()];
    format!("{}: {}", check.name, parts.into_iter().flatten().collect::<Vec<_>>().join(", "))
}

/// `flight.separation +4.200 m (83.10 s, uav-3 and uav-5)`, `plan.clearance undecided +0.001 m`.
pub(super) fn line(check: &Check) -> String {
    // "-1 crashes" says nothing that the name does not say.
    let margin = check.margin.filter(|_| !is_count(&check.unit));
    let margin = margin.map(|margin| format!(" {}", signed_quantity(margin, &check.unit)));
    let place = check.place().map(|place| format!(" ({place})"));
    let undecided = if check.status == Status::Undecided { " undecided" } else { "" };
    format!("{}{undecided}{}{}", check.name, margin.unwrap_or_default(), place.unwrap_or_default())
}
