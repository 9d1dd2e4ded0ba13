//! The MCAP recording: `flight.mcap`, with Foxglove's schemas in Protobuf.
//!
//! | topic | schema | content | written by |
//! |---|---|---|---|
//! | `/tf` | `foxglove.FrameTransforms` | pose of every vehicle, load and moving obstacle in `world` | `bodies` |
//! | `/fleet`, `/moving` | `foxglove.SceneUpdate` | vehicles, moving obstacles, fixed to their frames; once | `bodies` |
//! | `/world` | `foxglove.SceneUpdate` | map, obstacles, gates, paths, starts and goals; once | `shapes` |
//! | `/KIND/NAME` | `foxglove.SceneUpdate` | what changes in space: `/cables`, `/trail`, `/hidden`, `/horizon`, ... | `shapes` |
//! | `/vehicles/NAME` | Protobuf | the quantities of a vehicle | `series` |
//! | `/plots/GROUP/NAME`, `/limits/GROUP/NAME` | `point.Point` | other quantities over time, limits | `series` |
//! | `/state/GROUP/NAME` | `state.State` | discrete states | `series` |
//! | `/distances` | `distances.Distances` | smallest separation and clearance of the fleet | `series` |
//! | `/log` | `foxglove.Log` | events and worst instants | here |
//!
//! The scene is translated as it is: no vehicle family is named here.
//!
//! Metadata `harness` names scenario, planner, seed and verdict; attachments hold scenario, plan and verdict as JSON.

mod bodies;
mod protobuf;
mod series;
mod shapes;

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

use self::shapes::Artist;
use super::{Recorder, Run};
use crate::output::scene::builder;
use crate::output::scene::events::{Event, Level};

/// Result of a writing function; the errors are Foxglove's, about the file.
type Written = Result<(), Box<dyn Error + Send + Sync>>;
type Writer = McapWriterHandle<BufWriter<File>>;

/// The fixed frame.
const WORLD: &str = "world";
/// Time between two messages of one topic, s.
const INTERVAL_S: f64 = 0.05;

/// Writes recordings for Foxglove and other readers of MCAP.
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
        let scene = builder::build(&run.judged());
        let artist = Artist::new(&run.scenario.world.map);
        shapes::log(&context, &scene, &artist);
        bodies::log(&context, &scene.bodies, &artist);
        series::log(&context, &scene)?;
        log_events(&context, &scene.events);
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

fn log_events(context: &Arc<Context>, events: &[Event]) {
    let channel: Channel<Log> = channel(context, "/log");
    for event in events {
        let message = Log {
            timestamp: Some(timestamp(event.t_s)),
            level: level(event.level),
            message: event.text.clone(),
            name: "harness".to_owned(),
            ..Log::default()
        };
        channel.log_with_time(&message, timestamp(event.t_s));
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

/// Simulated time as a time since the epoch, rounded to nanoseconds: flights begin at the epoch. Never before it.
fn timestamp(t_s: f64) -> Timestamp {
    let nanoseconds = (t_s.max(0.0) * 1e9).round() as u64;
    let (seconds, rest) = (nanoseconds / 1_000_000_000, nanoseconds % 1_000_000_000);
    u32::try_from(seconds).map_or(Timestamp::MAX, |seconds| Timestamp::new(seconds, rest as u32))
}

#[cfg(test)]
mod tests;
