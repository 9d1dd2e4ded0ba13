//! The text log on `sim_time`.

use rerun::{RecordingStream, TextLog, TextLogLevel};

use super::{Logged, sim_times};
use crate::output::scene::events::{Event, Level};

/// Logs every event at its time.
pub fn log(stream: &RecordingStream, events: &[Event]) -> Logged {
    if events.is_empty() {
        return Ok(());
    }
    let log = TextLog::update_fields()
        .with_many_text(events.iter().map(|event| format!("{:7.2} s  {}", event.t_s, event.text)))
        .with_many_level(events.iter().map(|event| level(event.level)));
    let times = sim_times(events.iter().map(|event| event.t_s));
    Ok(stream.send_columns("events", [times], log.columns_of_unit_batches()?)?)
}

fn level(level: Level) -> &'static str {
    match level {
        Level::Info => TextLogLevel::INFO,
        Level::Warning => TextLogLevel::WARN,
        Level::Error => TextLogLevel::ERROR,
        Level::Critical => TextLogLevel::CRITICAL,
    }
}
