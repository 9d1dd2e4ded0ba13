//! The verdict as a document: outcome, checks, plan, and how to read the picture.

use rerun::{RecordingStream, TextDocument};
use scenarios::Scenario;

use super::paths::TRAIL_S;
use super::{Logged, Run, fleet, outcome_word};
use crate::verdict::{Check, Outcome, Status};

/// Checks that say how close it was.
pub const TELLING: [&str; 3] = ["flight.separation", "flight.clearance", "flight.tracking_max"];

/// Logs the document.
pub fn log(stream: &RecordingStream, run: &Run<'_>) -> Logged {
    let text = [headline(run), checks(run), plan(run), legend(run.scenario)].join("\n\n");
    Ok(stream.log_static("verdict", &TextDocument::from_markdown(text))?)
}

fn headline(run: &Run<'_>) -> String {
    let checks = &run.verdict.checks;
    let count = |status: Status| checks.iter().filter(|check| check.status == status && !check.advisory).count();
    let made = checks.iter().filter(|check| check.status != Status::Skip && !check.advisory).count();
    let summary = match run.verdict.outcome {
        Outcome::Pass => format!("all {made} deciding checks passed"),
        Outcome::Fail if count(Status::Fail) > 0 => format!("{} of {made} deciding checks failed", count(Status::Fail)),
        Outcome::Fail => "a deciding check is undecided, or a required one was skipped".to_owned(),
        Outcome::NoPlan => "the planner found nothing that could be flown".to_owned(),
    };
    let title = format!("# {}: {summary}", outcome_word(run.verdict.outcome));
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

/// What a reader asks for first comes first: what decided against the plan, then how close the flight was.
fn urgency(check: &Check) -> usize {
    match check.status {
        Status::Fail | Status::Undecided => usize::from(check.advisory),
        Status::Pass if TELLING.contains(&check.name.as_str()) => 2,
        Status::Pass => 3,
        Status::Skip => 4,
    }
}

fn row(check: &Check) -> String {
    let mark = match check.status {
        Status::Pass => "✔ pass",
        Status::Fail => "**✖ FAIL**",
        Status::Undecided => "**? undecided**",
        Status::Skip => "skipped",
    };
    let advisory = if check.advisory { " (advisory)" } else { "" };
    let unit = check.unit.as_str();
    let (margin, value, limit) = (signed(check.margin, unit), quantity(check.value, unit), quantity(check.limit, unit));
    format!("| {mark}{advisory} | `{}` | {margin} | {value} | {limit} | {} |", check.name, worst(check))
}

/// When and between whom, or why there is no answer.
fn worst(check: &Check) -> String {
    let when = check.at_s.map(|at_s| format!("{at_s:.1} s"));
    let who = (!check.between.is_empty()).then(|| check.between.join(", "));
    let parts: Vec<String> = [when, who, check.reason.clone()].into_iter().flatten().collect();
    parts.join("; ").replace('|', "/").replace('\n', " ")
}

fn plan(run: &Run<'_>) -> String {
    let plan = run.plan;
    let reason = plan.reason.as_ref().map(|reason| format!(" ({reason})")).unwrap_or_default();
    let distributed = match plan.timings.distributed_s {
        0.0 => String::new(),
        distributed_s => format!(" ({} if every vehicle had its own computer)", quantity(Some(distributed_s), "s")),
    };
    [
        "## Plan".to_owned(),
        format!("- planner `{}`, seed {}", plan.planner, plan.seed),
        format!("- says of itself: **{}**{reason}, after {} iterations", plan.status, plan.history.len()),
        format!("- flight time {}, objective {}", quantity(plan.flight_time_s(), "s"), quantity(plan.objective, "s")),
        format!("- planning time {}{distributed}", quantity(Some(plan.timings.wall_s), "s")),
        format!("- {} vehicles, {} obstacles", run.scenario.vehicles.len(), run.scenario.world.cylinders.len()),
    ]
    .join("\n")
}

fn legend(scenario: &Scenario) -> String {
    let body_m = scenario.vehicles.iter().filter_map(|vehicle| scenario.models.fixed_wing.get(&vehicle.model));
    let body_m = body_m.map(|model| 2.0 * model.body_radius_m).fold(0.0, f64::max);
    let span_m = fleet::drawn_span_m(scenario);
    let safety = scenario.fleet.separation_m.map_or(String::new(), |separation_m| {
        let radius_m = separation_m / 2.0;
        format!(
            "\n- cylinder around an aircraft: radius R/2 = {radius_m} m, to scale; two touch when the separation is R"
        )
    });
    format!(
        "## How to read the picture\n\
         - one colour per vehicle, in space and in the plots; red is what must not be touched: obstacles, limits, \
         violations\n\
         - thin dim line: planned; bright line: flown; thick line: the last {TRAIL_S} s\n\
         - dots: start (dim) and goal (bright){safety}\n\
         - green or red line with a label: where the fleet came closest to a limit that was kept or broken; red dot: \
         crash\n\
         - obstacles are drawn from the floor to the ceiling of the map; they have neither top nor bottom\n\
         - **not to scale: the aircraft**, drawn with a span of {span_m:.0} m (a body of {body_m:.1} m would not be \
         seen); everything else is"
    )
}

/// A value with its unit, or a dash.
pub fn quantity(value: Option<f64>, unit: &str) -> String {
    match value {
        None => "–".to_owned(),
        Some(value) if unit == "-" || unit.is_empty() => number(value),
        Some(value) => format!("{} {unit}", number(value)),
    }
}

fn signed(value: Option<f64>, unit: &str) -> String {
    let sign = if value.is_some_and(|value| value > 0.0) { "+" } else { "" };
    format!("{sign}{}", quantity(value, unit))
}

/// A number with three or four digits that mean something.
pub fn number(value: f64) -> String {
    match value.abs() {
        magnitude if !magnitude.is_finite() => format!("{value}"),
        0.0 => "0".to_owned(),
        magnitude if magnitude >= 1000.0 => format!("{value:.0}"),
        magnitude if magnitude >= 100.0 => format!("{value:.1}"),
        magnitude if magnitude >= 1.0 => format!("{value:.2}"),
        magnitude if magnitude >= 0.01 => format!("{value:.3}"),
        magnitude if magnitude >= 0.001 => format!("{value:.4}"),
        _ => format!("{value:.1e}"),
    }
}
