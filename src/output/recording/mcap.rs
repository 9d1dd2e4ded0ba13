//! The MCAP recording: `flight.mcap`, with Foxglove's schemas in Protobuf.
//!
//! | topic | schema | what | written in |
//! |---|---|---|---|
//! | `/tf` | `foxglove.FrameTransforms` | where every vehicle is, `world` from its name | `motion` |
//! | `/world` | `foxglove.SceneUpdate` | map, obstacles, planned and flown paths, starts and goals; once | `scene` |
//! | `/fleet` | `foxglove.SceneUpdate` | the vehicles with their safety volumes, fixed to their frames; once | `scene` |
//! | `/vehicles/NAME` | `aircraft.Aircraft`, `quadrotor.Quadrotor` | tracking error, altitude, controls, tension | `motion` |
//! | `/cables/NAME` | `foxglove.SceneUpdate` | the cable of a load | `motion` |
//! | `/distances` | `distances.Distances` | smallest separation and clearance of the fleet | `motion` |
//! | `/log` | `foxglove.Log` | events and worst instants | here |
//!
//! Metadata `harness` names scenario, planner, seed and verdict; attachments hold scenario, plan and verdict as JSON.

mod motion;
mod scene;

use std::borrow::Cow;
use std::collections::BTreeMap;
use std::error::Error;
use std::fs::File;
use std::io::BufWriter;
use std::path::Path;
use std::sync::Arc;

use foxglove::messages::{Log, Timestamp};
use foxglove::{Channel, Context, Encode, McapAttachment, McapWriterHandle};
use serde::Serialize;

use super::events::{self, Level};
use super::{Recorder, Run};

/// What writing functions return: the library's own errors, which concern the file.
type Written = Result<(), Box<dyn Error + Send + Sync>>;
type Writer = McapWriterHandle<BufWriter<File>>;

/// Frame of everything that stands still.
const WORLD: &str = "world";

/// Writes recordings for Foxglove and everything else that reads MCAP.
#[derive(Clone, Copy, Debug, Default)]
pub struct Mcap;

impl Recorder for Mcap {
    fn file_name(&self) -> &'static str {
        "flight.mcap"
    }

    fn write(&self, run: &Run<'_>, path: &Path) -> Written {
        let context = Context::new();
        let writer = context.mcap_writer().create(BufWriter::new(File::create(path)?))?;
        identify(&writer, run)?;
        attach(&writer, "scenario.json", run.scenario)?;
        attach(&writer, "plan.json", run.plan)?;
        attach(&writer, "verdict.json", run.verdict)?;
        scene::log(&context, run);
        if let Some(flight) = run.flight {
            motion::log(&context, run, flight);
        }
        log_events(&context, run);
        writer.close()?.into_inner()?.sync_data()?;
        Ok(())
    }
}

fn identify(writer: &Writer, run: &Run<'_>) -> Written {
    let pairs = [
        ("scenario", run.scenario.name.clone()),
        ("planner", run.plan.planner.clone()),
        ("seed", run.plan.seed.to_string()),
        ("verdict", run.verdict.outcome.to_string()),
        ("harness", env!("CARGO_PKG_VERSION").to_owned()),
    ];
    let pairs: BTreeMap<String, String> = pairs.map(|(key, value)| (key.to_owned(), value)).into();
    Ok(writer.write_metadata("harness", pairs)?)
}

fn attach(writer: &Writer, name: &str, value: &impl Serialize) -> Written {
    let data = serde_json::to_vec_pretty(value)?;
    let attachment = McapAttachment {
        log_time: 0,
        create_time: 0,
        name: name.to_owned(),
        media_type: "application/json".to_owned(),
        data: Cow::Owned(data),
    };
    Ok(writer.attach(&attachment)?)
}

fn log_events(context: &Arc<Context>, run: &Run<'_>) {
    let channel: Channel<Log> = channel(context, "/log");
    for line in events::lines(run) {
        let message = Log {
            timestamp: Some(timestamp(line.t_s)),
            level: level(line.level),
            message: line.text,
            name: "harness".to_owned(),
            ..Log::default()
        };
        channel.log_with_time(&message, timestamp(line.t_s));
    }
}

/// By the numbers of `foxglove.LogLevel`.
fn level(level: Level) -> i32 {
    match level {
        Level::Info => 2,
        Level::Warning => 3,
        Level::Error => 4,
        Level::Critical => 5,
    }
}

fn channel<T: Encode>(context: &Arc<Context>, topic: &str) -> Channel<T> {
    context.channel_builder(topic).build()
}

/// Simulated time as a time since the epoch: flights begin at 0. Not before it, and to the nanosecond.
fn timestamp(t_s: f64) -> Timestamp {
    let nanoseconds = (t_s.max(0.0) * 1e9).round() as u64;
    let (seconds, rest) = (nanoseconds / 1_000_000_000, nanoseconds % 1_000_000_000);
    u32::try_from(seconds).map_or(Timestamp::MAX, |seconds| Timestamp::new(seconds, rest as u32))
}

#[cfg(test)]
mod tests;
