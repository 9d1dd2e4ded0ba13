//! The verdict as a document: outcome, checks, plan, and how to read the picture.

use rerun::{RecordingStream, TextDocument};
use scenarios::{Family, Scenario};

use super::paths::TRAIL_S;
use super::{Logged, Run, fleet};
use crate::number_format::{given, given_quantity, quantity, signed_quantity};
use crate::verdict::{Check, Outcome, Status};

/// What stands where there is no value.
const NOTHING: &str = "–";

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

/// What a reader asks for first comes first: what decided against the plan, then how close the flight was.
fn urgency(check: &Check) -> usize {
    match check.status {
        Status::Fail | Status::Undecided => usize::from(check.advisory),
        Status::Pass if is_key(check) => 2,
        Status::Pass => 3,
        Status::Skip => 4,
    }
}

/// Does it say how close the flight was?
pub fn is_key(check: &Check) -> bool {
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
        value.map_or_else(|| NOTHING.to_owned(), |value| form(value, &check.unit))
    };
    let margin = cell(check.margin, signed_quantity);
    let (value, limit) = (cell(check.value, quantity), cell(check.limit, given_quantity));
    format!("| {mark}{advisory} | `{}` | {margin} | {value} | {limit} | {} |", check.name, remarks(check))
}

/// When and between whom, or why there is no answer.
fn remarks(check: &Check) -> String {
    let parts: Vec<String> = check.place().into_iter().chain(check.reason.clone()).collect();
    parts.join("; ").replace('|', "/").replace('\n', " ")
}

fn plan(run: &Run<'_>) -> String {
    let plan = run.plan;
    let reason = plan.reason.as_ref().map(|reason| format!(" ({reason})")).unwrap_or_default();
    let distributed = match plan.timings.distributed_s {
        0.0 => String::new(),
        distributed_s => format!(" ({} if every vehicle had its own computer)", quantity(distributed_s, "s")),
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
    value.map_or_else(|| NOTHING.to_owned(), |value| quantity(value, "s"))
}

/// One line each: the viewer does not wrap lists.
fn legend(scenario: &Scenario) -> String {
    match scenario.family() {
        Family::FixedWing => legend_of_fixed_wings(scenario),
        Family::SlungLoad => legend_of_a_slung_load(),
        Family::Multirotor => legend_of_multirotors(),
    }
}

fn legend_of_multirotors() -> String {
    [
        "## How to read the picture",
        "- everything is to scale; obstacles without bottom or top end at floor and ceiling of the map",
        "- obstacles: red where a vehicle knows of them, pale violet until they are sensed; orange: what moves",
        "- sphere around a vehicle: its body; large ring: how far it senses",
        "- thin lines: the edges of the cost map; dim ones: the best candidates of the last replan",
        "- thick line ahead of a vehicle: its horizon; those of earlier replans fade behind it",
        "- bright line: flown; line with a label: where it came closest to an obstacle, green if the limit was kept",
    ]
    .join("\n")
}

fn legend_of_a_slung_load() -> String {
    [
        "## How to read the picture",
        "- everything is to scale; obstacles without bottom or top end at floor and ceiling of the map",
        "- red: what must not be touched: obstacles, limits, violations",
        "- thin dim line: planned; bright line: flown; amber: the load",
        "- cable: straight while taut, its colour the tension, from green (none) to red (three times the load's weight); \
         grey and loose while slack",
        "- blue circle: the envelope, body or horizontal reach of the load, whichever is larger",
        "- line with a label: where a part came closest to an obstacle, green if the limit was kept",
    ]
    .join("\n")
}

fn legend_of_fixed_wings(scenario: &Scenario) -> String {
    let body_m = scenario.vehicles.iter().filter_map(|vehicle| scenario.models.fixed_wing.get(&vehicle.model));
    let body_m = body_m.map(|model| 2.0 * model.body_radius_m).fold(0.0, f64::max);
    let span_m = fleet::drawn_span_m(scenario);
    let safety = scenario.fleet.separation_m.map(|separation_m| {
        let radius_m = given(separation_m / 2.0);
        format!("- cylinder around an aircraft: radius R/2 = {radius_m} m; two touch when the separation is R")
    });
    let lines = [
        "## How to read the picture".to_owned(),
        "- one colour per vehicle, in space and in the plots".to_owned(),
        "- red: what must not be touched: obstacles, limits, violations".to_owned(),
        format!("- thin dim line: planned; bright line: flown; thick line: the last {TRAIL_S} s"),
        "- dots: start (dim) and goal (bright); large red dot: crash".to_owned(),
        "- line with a label: where the fleet came closest, green if the limit was kept".to_owned(),
        "- obstacles end at floor and ceiling of the map; in truth they have no end".to_owned(),
        format!("- **not to scale: the aircraft**, {span_m:.0} m wide: a body of {body_m:.1} m would not be seen"),
    ];
    lines.into_iter().chain(safety).collect::<Vec<_>>().join("\n")
}
