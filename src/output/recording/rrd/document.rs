//! The verdict as a document: outcome, checks, plan, and how to read the picture.

use rerun::{RecordingStream, TextDocument};

use super::{Logged, Run};
use crate::number_format::{given_quantity, quantity, signed_quantity};
use crate::verdict::{Check, Outcome, Status};

/// Placeholder for a missing value.
const MISSING: &str = "–";

/// Logs the document.
///
/// - `legend`: how to read the picture, one line each, since the viewer does not wrap lists
pub fn log(stream: &RecordingStream, run: &Run<'_>, legend: &[String]) -> Logged {
    let legend = format!("## How to read the picture\n{}", legend.join("\n"));
    let text = [headline(run), checks(run), plan(run), legend].join("\n\n");
    Ok(stream.log_static("verdict", &TextDocument::from_markdown(text))?)
}

fn headline(run: &Run<'_>) -> String {
    let checks = &run.verdict.checks;
    let count = |status: Status| checks.iter().filter(|check| check.status == status && !check.advisory).count();
    let decided = checks.iter().filter(|check| check.status != Status::Skip && !check.advisory).count();
    let summary = match run.verdict.outcome {
        Outcome::Pass => format!("all {decided} deciding checks passed"),
        Outcome::Fail if count(Status::Fail) > 0 => {
            format!("{} of {decided} deciding checks failed", count(Status::Fail))
        }
        Outcome::Fail => "a deciding check is undecided, or a required one was skipped".to_owned(),
        Outcome::NoPlan => "the planner found no plan that could be flown".to_owned(),
    };
    let title = format!("# {}: {summary}", run.verdict.outcome);
    let overclaimed = match run.verdict.overclaimed {
        true => "**The planner calls this plan solved; between its nodes it is not.** ",
        false => "",
    };
    let (scenario, planner) = (run.scenario, &run.plan.planner);
    format!("{title}\n\n{overclaimed}**{}**, planned by **{planner}**. {}", scenario.name, scenario.description)
}

fn checks(run: &Run<'_>) -> String {
    let header = "| | check | margin | measured | limit | worst |\n|---|---|--:|--:|--:|---|\n".to_owned();
    let mut checks: Vec<&Check> = run.verdict.checks.iter().collect();
    checks.sort_by_key(|check| urgency(check));
    header + &checks.into_iter().map(row).collect::<Vec<_>>().join("\n")
}

/// Order of the rows: failed checks, then those that say how close the flight was, then the others.
fn urgency(check: &Check) -> usize {
    match check.status {
        Status::Fail | Status::Undecided => usize::from(check.advisory),
        Status::Pass if is_key(check) => 2,
        Status::Pass => 3,
        Status::Skip => 4,
    }
}

/// Does it say how close the flight was?
fn is_key(check: &Check) -> bool {
    check.is_key() && check.name.starts_with("flight.")
}

fn row(check: &Check) -> String {
    let mark = match check.status {
        Status::Pass => "✔ pass",
        Status::Fail => "**✖ FAIL**",
        Status::Undecided => "**? undecided**",
        Status::Skip => "skipped",
    };
    let advisory = if check.advisory { " (advisory)" } else { "" };
    let cell = |value: Option<f64>, form: fn(f64, &str) -> String| {
        value.map_or_else(|| MISSING.to_owned(), |value| form(value, &check.unit))
    };
    let margin = cell(check.margin, signed_quantity);
    let (value, limit) = (cell(check.value, quantity), cell(check.limit, given_quantity));
    format!("| {mark}{advisory} | `{}` | {margin} | {value} | {limit} | {} |", check.name, remarks(check))
}

/// Time and objects of the worst instant, and the reason.
fn remarks(check: &Check) -> String {
    let parts: Vec<String> = check.place().into_iter().chain(check.reason.clone()).collect();
    parts.join("; ").replace('|', "/").replace('\n', " ")
}

fn plan(run: &Run<'_>) -> String {
    let plan = run.plan;
    let reason = plan.reason.as_ref().map(|reason| format!(" ({reason})")).unwrap_or_default();
    let distributed = match plan.timings.distributed_s {
        0.0 => String::new(),
        distributed_s if distributed_s >= plan.timings.wall_s => String::new(),
        distributed_s => format!(" ({} with one computer per vehicle)", quantity(distributed_s, "s")),
    };
    [
        "## Plan".to_owned(),
        format!("- planner `{}`, seed {}", plan.planner, plan.seed),
        format!("- says of itself: **{}**{reason}, after {} iterations", plan.status, plan.history.len()),
        format!("- flight time {}, objective {}", seconds(plan.flight_time_s()), seconds(plan.objective)),
        format!("- planning time {}{distributed}", quantity(plan.timings.wall_s, "s")),
        format!(
            "- {} vehicles, {} obstacles",
            run.scenario.vehicles.len(),
            run.scenario.world.obstacle_names().count()
        ),
    ]
    .join("\n")
}

fn seconds(value: Option<f64>) -> String {
    value.map_or_else(|| MISSING.to_owned(), |value| quantity(value, "s"))
}
