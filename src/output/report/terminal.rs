//! Results for the terminal: a table of checks, plan and verdict in one line each.
//!
//! The text contains ANSI colours, which [`console::print`](crate::console::print) strips where they are not supported.

use std::path::Path;

use anstyle::{AnsiColor, Style};
use comfy_table::{Cell, Color, Table};

use super::{Summary, SummaryRun, headline, table};
use crate::campaign::margin_budget::MarginBudget;
use crate::number_format::{number, quantity, signed, signed_quantity};
use crate::report::Report;
use crate::verdict::{Check, CurveAsCubics, Integration, Method, Outcome, Reconstruction, RoundedRows, Status};

/// Width of the table of checks where it is not printed to a terminal, characters.
const CHECKS_WIDTH: u16 = 80;
/// Number of lines of an external planner's log that are shown if there is no plan.
const LOG_LINES: usize = 20;

/// Number of checks that fail for the same reason from which they are shown in one line.
const MIN_ALIKE: usize = 5;

/// Which checks are listed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Detail {
    /// Failures, and the closest margins of what passed.
    Decisive,
    /// All that were made.
    All,
}

/// Everything about one job.
///
/// - `log`: standard error of an external planner; its end is shown if there is no plan
pub fn report(report: &Report, log: Option<&str>, detail: Detail) -> String {
    if report.verdict == Outcome::NoPlan {
        return no_plan(report, log);
    }
    let alike: Vec<&str> = common_failures(report).into_iter().flat_map(|(_, names)| names).collect();
    let rows = made(report).filter(|check| !alike.contains(&check.name.as_str()));
    let (shown, hidden): (Vec<&Check>, Vec<&Check>) =
        rows.partition(|check| detail == Detail::All || is_decisive(check));
    let mut lines = vec![checks_table(&shown).trim_fmt()];
    lines.extend(failed_alike(report));
    lines.extend((!hidden.is_empty()).then(|| format!("{} more checks passed; -v lists them", hidden.len())));
    lines.extend(skipped(report));
    lines.push(plan_line(report));
    lines.extend(flight_line(report));
    lines.extend(report.integration.as_ref().map(integration_line));
    lines.extend(report.waterfall.iter().map(waterfall_line));
    lines.push(format!(
        "{}  {}",
        verdict_line(report.verdict, &report.scenario, &report.planner),
        headline::reason(report)
    ));
    let warnings: Vec<&str> = headline::warnings(report).map(|check| check.name.as_str()).collect();
    if !warnings.is_empty() {
        lines.push(note(&format!("advisory checks failed: {}", warnings.join(", "))));
    }
    lines.extend(headline::overclaim(report).into_iter().chain(headline::notes(report)).map(|text| note(&text)));
    format!("{}\n", table::wrapped(&lines.join("\n")))
}

fn made(report: &Report) -> impl Iterator<Item = &Check> {
    report.checks.iter().filter(|check| check.status != Status::Skip)
}

fn is_decisive(check: &Check) -> bool {
    check.is_bad() || check.is_key()
}

/// Without a plan every check has failed for the same reason, which is shown with the end of the planner's log.
fn no_plan(report: &Report, log: Option<&str>) -> String {
    let verdict = verdict_line(report.verdict, &report.scenario, &report.planner);
    let said = log.map(|log| headline::last_lines(log, LOG_LINES)).filter(|said| !said.is_empty());
    let said = said.map_or_else(String::new, |said| format!("planner.log ends with:\n{said}\n"));
    let notes: String = headline::notes(report).into_iter().map(|text| note(&text) + "\n").collect();
    format!("{}\n{said}{notes}{verdict}  {}\n", plan_line(report), headline::reason(report))
}

/// The whole run: the jobs that did not pass (if there are several jobs), counts, and the result folder.
pub fn summary(summary: &Summary, out: &Path) -> String {
    let bad: Vec<&SummaryRun> = summary.runs.iter().filter(|run| !run.is_good()).collect();
    let repeated = if summary.runs.len() > 1 { bad.as_slice() } else { &[] };
    let repeated: String =
        repeated.iter().map(|run| verdict_line(run.verdict, &run.scenario, &run.planner) + "\n").collect();
    let color = if summary.is_good() { AnsiColor::Green } else { AnsiColor::Red };
    format!("{repeated}{}; results in {}", painted(&summary.counts_line(), color), out.display())
}

fn checks_table(checks: &[&Check]) -> Table {
    let header = ["check", "status", "value", "limit", "margin", "where, remarks"];
    let mut table = table::with_header(&header, &[2, 3, 4]);
    if !table.is_tty() {
        table.set_width(CHECKS_WIDTH);
    }
    table.enforce_styling();
    table.add_rows(checks.iter().map(|check| row(check)));
    table
}

/// The unit stands once, behind the margin, or behind the value where there is no margin.
fn row(check: &Check) -> Vec<Cell> {
    let bare = |value: Option<f64>| value.map_or_else(String::new, |value| number(value, &check.unit));
    let value = match check.margin {
        None => check.value.map_or_else(String::new, |value| quantity(value, &check.unit)),
        Some(_) => bare(check.value),
    };
    let margin = check.margin.map_or_else(String::new, |margin| signed_quantity(margin, &check.unit));
    let remarks = [check.place(), check.reason.clone(), check.advisory.then(|| "advisory".to_owned())];
    vec![
        Cell::new(&check.name),
        Cell::new(check.status).fg(color(check)),
        Cell::new(value),
        Cell::new(bare(check.limit)),
        Cell::new(margin),
        Cell::new(remarks.into_iter().flatten().collect::<Vec<_>>().join("; ")),
    ]
}

fn color(check: &Check) -> Color {
    match check.status {
        Status::Pass => Color::Green,
        Status::Fail if !check.advisory => Color::Red,
        Status::Fail | Status::Undecided => Color::Yellow,
        Status::Skip => Color::Reset,
    }
}

/// Skipped checks, one line per reason.
fn skipped(report: &Report) -> Vec<String> {
    let by_reason = by_reason(report.checks.iter().filter(|check| check.status == Status::Skip));
    by_reason.into_iter().map(|(reason, names)| format!("skipped: {} ({reason})", names.join(", "))).collect()
}

/// Checks that could not be made for a common reason, one line per reason in place of many rows.
fn failed_alike(report: &Report) -> Vec<String> {
    let line = |(reason, names): (&str, Vec<&str>)| {
        painted(&format!("failed: {reason}"), AnsiColor::Red) + &format!(" ({})", names.join(", "))
    };
    common_failures(report).into_iter().map(line).collect()
}

/// The reasons for which several checks failed without a value, and these checks.
fn common_failures(report: &Report) -> Vec<(&str, Vec<&str>)> {
    let has_no_value = |check: &&Check| check.status == Status::Fail && check.value.is_none() && !check.advisory;
    let mut by_reason = by_reason(report.checks.iter().filter(has_no_value));
    by_reason.retain(|(_, names)| names.len() >= MIN_ALIKE);
    by_reason
}

/// Names of checks by their reasons, in the order of the checks.
fn by_reason<'r>(checks: impl Iterator<Item = &'r Check>) -> Vec<(&'r str, Vec<&'r str>)> {
    let mut by_reason: Vec<(&str, Vec<&str>)> = Vec::new();
    for check in checks {
        let reason = check.reason.as_deref().unwrap_or("not applicable");
        match by_reason.iter_mut().find(|(known, _)| *known == reason) {
            Some((_, names)) => names.push(&check.name),
            None => by_reason.push((reason, vec![&check.name])),
        }
    }
    by_reason
}

fn plan_line(report: &Report) -> String {
    let plan = &report.plan;
    let iterations = if plan.iterations > 0 { format!(", {} iterations", plan.iterations) } else { String::new() };
    let wall = if plan.wall_s > 0.0 { format!(" in {:.3} s on this machine", plan.wall_s) } else { String::new() };
    let plain = if report.recorded { "log: flown elsewhere".to_owned() } else { format!("plan: {}", plan.status) };
    let mut parts = vec![format!("{plain}{iterations}{wall}")];
    // A machine with a core for every vehicle is no slower than one computer per vehicle.
    if plan.distributed_s > 0.0 && plan.distributed_s < plan.wall_s {
        parts.push(format!("{:.3} s with one computer per vehicle", plan.distributed_s));
    }
    parts.extend(plan.flight_time_s.map(|flight_time_s| format!("flight time {}", quantity(flight_time_s, "s"))));
    parts.extend(plan.reconstruction.as_ref().map(Reconstruction::describe));
    parts.extend(plan.rounded.as_ref().map(RoundedRows::describe));
    parts.extend(plan.curve.as_ref().map(CurveAsCubics::describe));
    parts.extend(plan.remarks.iter().cloned());
    parts.join("; ")
}

fn flight_line(report: &Report) -> Option<String> {
    let flight = report.metrics.flight.as_ref()?;
    let figures = [
        ("mean speed", flight.mean_speed_mps, "m/s"),
        ("standard deviation of speed", flight.speed_std_mps, "m/s"),
        ("of altitude", flight.altitude_std_m, "m"),
    ];
    let known =
        figures.into_iter().filter_map(|(name, value, unit)| Some(format!("{name} {}", quantity(value?, unit))));
    let simulated = format!("simulated in {:.3} s", report.timings.flying_s);
    Some(format!("flight: {}", std::iter::once(simulated).chain(known).collect::<Vec<_>>().join("; ")))
}

/// The integration-error estimate.
fn integration_line(Integration { method, disagreement_m, .. }: &Integration) -> String {
    let how = match method {
        Method::Replay => "in windows, by a replay of its log",
        Method::FinerSteps => "when it is flown again with a quarter of the step",
    };
    let by = disagreement_m.map_or_else(|| "more than a crash".to_owned(), |it| quantity(it, "m"));
    format!("integrators disagree on the flight by {by} {how}")
}

/// The budget of a margin: `clearance: +12.000 m at the nodes; between the nodes -0.210; ...; +11.655 m flown`.
fn waterfall_line(waterfall: &MarginBudget) -> String {
    let MarginBudget { question, unit, steps } = waterfall;
    let (Some(first), Some(last)) = (steps.first(), steps.last()) else { return String::new() };
    let terms: Vec<String> =
        steps[1..].iter().map(|step| format!("{} {}", step.name, signed(step.change, unit))).collect();
    let [first, last] = [first, last].map(|step| signed_quantity(step.margin, unit));
    let where_first = if steps[0].name == "nodes" { "at the nodes" } else { &steps[0].name };
    format!("margin of {question}: {first} {where_first}; {}; {last} flown", terms.join("; "))
}

fn verdict_line(outcome: Outcome, scenario: &str, planner: &str) -> String {
    let color = if outcome == Outcome::Pass { AnsiColor::Green } else { AnsiColor::Red };
    format!("{}  {scenario} · {planner}", painted(&outcome.to_string(), color))
}

fn note(text: &str) -> String {
    format!("{} {text}", painted("note", AnsiColor::Yellow))
}

fn painted(text: &str, color: AnsiColor) -> String {
    let style = Style::new().bold().fg_color(Some(color.into()));
    format!("{style}{text}{style:#}")
}
