//! What happened, as a text log on `sim_time`.

use rerun::{RecordingStream, TextLog, TextLogLevel};
use scenarios::{Family, Scenario};
use sim::{Event, EventKind, Flight};

use super::document::is_telling;
use super::{Logged, Run, palette, sim_times};
use crate::notation::{given_quantity, quantity};
use crate::verdict::{Check, Status};

struct Line {
    t_s: f64,
    level: &'static str,
    text: String,
}

/// Logs the flight's events and the worst instants that the judge found, in the order of time.
pub fn log(stream: &RecordingStream, run: &Run<'_>) -> Logged {
    let end_s = run.plan.flight_time_s().unwrap_or(0.0);
    let mut lines: Vec<Line> = run.verdict.checks.iter().filter_map(|check| about_check(check, end_s)).collect();
    if let Some(flight) = run.flight {
        lines.extend(flight.events.iter().map(about_event));
        lines.extend(about_phases(run.scenario, flight));
    }
    lines.retain(|line| line.t_s.is_finite());
    lines.sort_by(|a, b| a.t_s.total_cmp(&b.t_s));
    if lines.is_empty() {
        return Ok(());
    }
    let log = TextLog::update_fields()
        .with_many_text(lines.iter().map(|line| line.text.as_str()))
        .with_many_level(lines.iter().map(|line| line.level));
    stream.send_columns("events", [sim_times(lines.iter().map(|line| line.t_s))], log.columns_of_unit_batches()?)?;
    Ok(())
}

fn about_phases(scenario: &Scenario, flight: &Flight) -> [Line; 2] {
    let count = flight.vehicles.len();
    let start = Line { t_s: 0.0, level: TextLogLevel::INFO, text: format!("start of {count} vehicles") };
    let text = match scenario.family() {
        Family::FixedWing => "the plan ends, the vehicles fly straight on".to_owned(),
        Family::SlungLoad => "the plan ends, the vehicle hovers".to_owned(),
    };
    [start, Line { t_s: flight.plan_end_s, level: TextLogLevel::INFO, text }]
}

fn about_event(event: &Event) -> Line {
    let who = event.vehicles.join(" and ");
    let (level, text) = match &event.kind {
        EventKind::Crash { obstacle: Some(obstacle) } => {
            (TextLogLevel::CRITICAL, format!("crash: {who} into {obstacle}"))
        }
        EventKind::Crash { obstacle: None } => (TextLogLevel::CRITICAL, format!("crash: {who}")),
        EventKind::SaturationBegan => (TextLogLevel::WARN, format!("{who}: command cut off at the vehicle's limits")),
        EventKind::SaturationEnded => (TextLogLevel::INFO, format!("{who}: command inside its limits again")),
        EventKind::CableTaut { impulse_ns } => {
            (TextLogLevel::INFO, format!("{who}: cable taut, with an impulse of {}", quantity(*impulse_ns, "N s")))
        }
        EventKind::CableSlack => (TextLogLevel::INFO, format!("{who}: cable slack")),
    };
    Line { t_s: event.t_s, level, text }
}

/// Violations and open questions at their worst instant, or at the plan's end if they have none; worst instants of the
/// checks that everybody asks for.
fn about_check(check: &Check, end_s: f64) -> Option<Line> {
    let is_shown = match check.status {
        Status::Fail | Status::Undecided => true,
        Status::Pass => is_telling(check),
        Status::Skip => false,
    };
    if !is_shown {
        return None;
    }
    let level = palette::level(check.status, check.advisory);
    Some(Line { t_s: check.at_s.unwrap_or(end_s), level, text: sentence(check) })
}

fn sentence(check: &Check) -> String {
    let what = match check.status {
        Status::Pass => "at its worst",
        Status::Undecided => "UNDECIDED",
        Status::Fail => "VIOLATED",
        Status::Skip => "skipped",
    };
    let value = check.value.map(|value| quantity(value, &check.unit));
    let limit = check.limit.map(|limit| format!("limit {}", given_quantity(limit, &check.unit)));
    let parts: Vec<String> = [value, limit, check.place(), check.reason.clone()].into_iter().flatten().collect();
    format!("{} {what}: {}", check.name, parts.join("; "))
}
