//! What happened, as a text log on `sim_time`.

use rerun::{RecordingStream, TextLog, TextLogLevel};

use super::{Logged, Run, sim_times};
use crate::output::recording::events::{self, Level};

/// Logs every line at its time.
pub fn log(stream: &RecordingStream, run: &Run<'_>) -> Logged {
    let lines = events::lines(run);
    if lines.is_empty() {
        return Ok(());
    }
    let log = TextLog::update_fields()
        .with_many_text(lines.iter().map(|line| line.text.as_str()))
        .with_many_level(lines.iter().map(|line| level(line.level)));
    stream.send_columns("events", [sim_times(lines.iter().map(|line| line.t_s))], log.columns_of_unit_batches()?)?;
    Ok(())
}

fn level(level: Level) -> &'static str {
    match level {
        Level::Info => TextLogLevel::INFO,
        Level::Warning => TextLogLevel::WARN,
        Level::Error => TextLogLevel::ERROR,
        Level::Critical => TextLogLevel::CRITICAL,
    }
}
