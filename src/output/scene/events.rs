//! The text log: the flight's events and the worst instants that the judge found.

use serde::Serialize;
use sim::{EventKind, Flight};

use crate::number_format::{given_quantity, quantity};
use crate::output::run::JudgedRun;
use crate::verdict::{Check, Status};

/// A line of the log.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Event {
    /// Time, s: finite.
    pub t_s: f64,
    /// How serious it is.
    pub level: Level,
    /// What happened.
    pub text: String,
}

/// How serious an event is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Level {
    /// As expected.
    Info,
    /// Undesired, but not deciding.
    Warning,
    /// A deciding check failed.
    Error,
    /// A crash.
    Critical,
}

/// All events in the order of time.
///
/// - `end_of_plan`: what happens when the plan ends
pub(super) fn all(run: &JudgedRun<'_>, end_of_plan: &str) -> Vec<Event> {
    let end_s = run.plan.flight_time_s().unwrap_or(0.0);
    let mut events: Vec<Event> = run.verdict.checks.iter().filter_map(|check| check_event(check, end_s)).collect();
    if let Some(flight) = run.flight {
        events.extend(flight.events.iter().map(flight_event));
        events.extend(phases(flight, end_of_plan));
    }
    events.retain(|event| event.t_s.is_finite());
    events.sort_by(|a, b| a.t_s.total_cmp(&b.t_s));
    events
}

fn phases(flight: &Flight, end_of_plan: &str) -> [Event; 2] {
    let start = match flight.vehicles.as_slice() {
        [vehicle] => format!("start of {}", vehicle.vehicle),
        vehicles => format!("start of {} vehicles", vehicles.len()),
    };
    let info = |t_s, text: &str| Event { t_s, level: Level::Info, text: text.to_owned() };
    [info(0.0, &start), info(flight.plan_end_s, end_of_plan)]
}

fn flight_event(event: &sim::Event) -> Event {
    let vehicles = event.vehicles.join(" and ");
    let (level, text) = match &event.kind {
        EventKind::Crash { obstacle: Some(obstacle) } => {
            (Level::Critical, format!("crash: {vehicles} into {obstacle}"))
        }
        EventKind::Crash { obstacle: None } => (Level::Critical, format!("crash: {vehicles}")),
        EventKind::SaturationBegan => {
            (Level::Warning, format!("{vehicles}: command saturated at the vehicle's limits"))
        }
        EventKind::SaturationEnded => (Level::Info, format!("{vehicles}: command within its limits again")),
        EventKind::CableTaut { impulse_ns } => {
            (Level::Info, format!("{vehicles}: cable taut, with an impulse of {}", quantity(*impulse_ns, "N s")))
        }
        EventKind::CableSlack => (Level::Info, format!("{vehicles}: cable slack")),
        EventKind::Discovered { obstacle } => (Level::Info, format!("{vehicles} discovers {obstacle}")),
        EventKind::ReplanLate { by_s } => {
            (Level::Warning, format!("{vehicles}: new plan is late by {}", quantity(*by_s, "s")))
        }
        EventKind::ReplanRejected { reason } => {
            (Level::Warning, format!("{vehicles}: new plan cannot be flown: {reason}"))
        }
        EventKind::ReplanFailed { reason } => (Level::Warning, format!("{vehicles}: no new plan: {reason}")),
        EventKind::PlannerRemark { text } => (Level::Warning, format!("planner: {text}")),
        EventKind::Arrived => (Level::Info, format!("{vehicles}: at rest at the goal")),
    };
    Event { t_s: event.t_s, level, text }
}

/// Failed and undecided checks at their worst instant, or at the plan's end if they have none; and the worst instants of
/// the key checks of the flight.
fn check_event(check: &Check, end_s: f64) -> Option<Event> {
    let is_shown = match check.status {
        Status::Fail | Status::Undecided => true,
        Status::Pass => check.is_key() && check.name.starts_with("flight."),
        Status::Skip => false,
    };
    if !is_shown {
        return None;
    }
    let level = level(check);
    Some(Event { t_s: check.at_s.unwrap_or(end_s), level, text: sentence(check) })
}

fn level(check: &Check) -> Level {
    match check.status {
        Status::Fail if !check.advisory => Level::Error,
        Status::Fail | Status::Undecided => Level::Warning,
        Status::Pass | Status::Skip => Level::Info,
    }
}

fn sentence(check: &Check) -> String {
    let result = match check.status {
        Status::Pass => "at its worst",
        Status::Undecided => "UNDECIDED",
        Status::Fail => "VIOLATED",
        Status::Skip => "skipped",
    };
    let value = check.value.map(|value| quantity(value, &check.unit));
    let limit = check.limit.map(|limit| format!("limit {}", given_quantity(limit, &check.unit)));
    let who = check.who();
    let parts: Vec<String> = [value, limit, who, check.reason.clone()].into_iter().flatten().collect();
    format!("{} {result}: {}", check.name, parts.join("; "))
}
