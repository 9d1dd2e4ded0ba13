//! What happened, as lines in the order of time.

use scenarios::{Family, Scenario};
use sim::{Event, EventKind, Flight};

use super::Run;
use crate::number_format::{given_quantity, quantity};
use crate::verdict::{Check, Status};

/// One line.
#[derive(Clone, Debug, PartialEq)]
pub struct Line {
    /// When, s: finite.
    pub t_s: f64,
    /// How bad.
    pub level: Level,
    /// What.
    pub text: String,
}

/// How bad something is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Level {
    /// It is as it should be.
    Info,
    /// It should not be, and does not decide.
    Warning,
    /// It decides against the plan.
    Error,
    /// A crash.
    Critical,
}

/// The flight's events and the worst instants that the judge found, in the order of time.
pub fn lines(run: &Run<'_>) -> Vec<Line> {
    let end_s = run.plan.flight_time_s().unwrap_or(0.0);
    let mut lines: Vec<Line> = run.verdict.checks.iter().filter_map(|check| about_check(check, end_s)).collect();
    if let Some(flight) = run.flight {
        lines.extend(flight.events.iter().map(about_event));
        lines.extend(about_phases(run.scenario, flight));
    }
    lines.retain(|line| line.t_s.is_finite());
    lines.sort_by(|a, b| a.t_s.total_cmp(&b.t_s));
    lines
}

fn about_phases(scenario: &Scenario, flight: &Flight) -> [Line; 2] {
    let count = flight.vehicles.len();
    let start = Line { t_s: 0.0, level: Level::Info, text: format!("start of {count} vehicles") };
    let text = match scenario.family() {
        Family::FixedWing => "the plan ends, the vehicles fly straight on".to_owned(),
        Family::SlungLoad => "the plan ends, the vehicle hovers".to_owned(),
        Family::Multirotor => "the flight is over".to_owned(),
    };
    [start, Line { t_s: flight.plan_end_s, level: Level::Info, text }]
}

fn about_event(event: &Event) -> Line {
    let who = event.vehicles.join(" and ");
    let (level, text) = match &event.kind {
        EventKind::Crash { obstacle: Some(obstacle) } => (Level::Critical, format!("crash: {who} into {obstacle}")),
        EventKind::Crash { obstacle: None } => (Level::Critical, format!("crash: {who}")),
        EventKind::SaturationBegan => (Level::Warning, format!("{who}: command cut off at the vehicle's limits")),
        EventKind::SaturationEnded => (Level::Info, format!("{who}: command inside its limits again")),
        EventKind::CableTaut { impulse_ns } => {
            (Level::Info, format!("{who}: cable taut, with an impulse of {}", quantity(*impulse_ns, "N s")))
        }
        EventKind::CableSlack => (Level::Info, format!("{who}: cable slack")),
        EventKind::Discovered { obstacle } => (Level::Info, format!("{who} discovers {obstacle}")),
        EventKind::AnswerLate { by_s } => (Level::Warning, format!("{who}: new plan late by {}", quantity(*by_s, "s"))),
        EventKind::AnswerRejected { reason } => (Level::Warning, format!("{who}: new plan cannot be flown: {reason}")),
        EventKind::Arrived => (Level::Info, format!("{who}: at rest at the goal")),
    };
    Line { t_s: event.t_s, level, text }
}

/// Violations and open questions at their worst instant, or at the plan's end if they have none; worst instants of the
/// checks that everybody asks for.
fn about_check(check: &Check, end_s: f64) -> Option<Line> {
    let is_shown = match check.status {
        Status::Fail | Status::Undecided => true,
        Status::Pass => check.is_key() && check.name.starts_with("flight."),
        Status::Skip => false,
    };
    if !is_shown {
        return None;
    }
    let level = level(check);
    Some(Line { t_s: check.at_s.unwrap_or(end_s), level, text: sentence(check) })
}

fn level(check: &Check) -> Level {
    match check.status {
        Status::Fail if !check.advisory => Level::Error,
        Status::Fail | Status::Undecided => Level::Warning,
        Status::Pass | Status::Skip => Level::Info,
    }
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
