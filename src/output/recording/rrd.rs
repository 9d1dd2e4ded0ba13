//! The rerun recording: `flight.rrd`, with the layout that the viewer opens with.
//!
//! | entities | content | written by |
//! |---|---|---|
//! | `/world/**` | everything in space; `docs/recording.md` lists the entities | `shapes`, `bodies` |
//! | `/plots/GROUP/NAME`, `/limits/GROUP/NAME`, `/state/GROUP/NAME` | series, their limits, states | `series` |
//! | `/events` | text log | `events` |
//! | `/planner/NAME`, `/convergence` | convergence, on the timeline `planner_iter` and as a table | `convergence` |
//! | `/margins/QUANTITY` | margin budgets | `margin_budget` |
//! | `/verdict` | the verdict as a document | `document` |
//!
//! The scene is translated as it is: no vehicle family is named here. What changes over time is on the timeline `sim_time`;
//! everything else is static.

mod blueprint;
mod bodies;
mod convergence;
mod document;
mod events;
mod layout;
mod margin_budget;
mod series;
mod shapes;

use std::error::Error;
use std::hash::{DefaultHasher, Hash, Hasher};
use std::path::Path;

use rerun::components::Text;
use rerun::{AnyValues, EntityPath, EntityPathPart, RecordingStream, RecordingStreamBuilder, TimeColumn};

use super::{Recorder, Run};
use crate::output::scene::builder;

/// Result of a logging function; the errors are rerun's, about serialisation or the file.
type Logged = Result<(), Box<dyn Error + Send + Sync>>;

/// Application id: viewers keep one default layout per application.
const APPLICATION: &str = "harness";
/// Timeline of the flight, s.
const SIM_TIME: &str = "sim_time";

/// Writes recordings for the rerun viewer.
#[derive(Clone, Copy, Debug, Default)]
pub struct Rrd;

impl Recorder for Rrd {
    fn file_name(&self) -> &'static str {
        "flight.rrd"
    }

    fn write(&self, run: &Run<'_>, path: &Path) -> Logged {
        let stream = open(run, path)?;
        let scene = builder::build(&run.judged());
        layout::send(&stream, run, &scene)?;
        document::log(&stream, run, &scene.legend)?;
        events::log(&stream, &scene.events)?;
        margin_budget::log(&stream, run.waterfall)?;
        convergence::log(&stream, run.plan)?;
        shapes::log(&stream, &scene)?;
        bodies::log(&stream, &scene.bodies)?;
        series::log(&stream, &scene)?;
        stream.flush_blocking()?;
        Ok(())
    }
}

/// Opens the file and writes the properties that identify the recording.
fn open(run: &Run<'_>, path: &Path) -> Result<RecordingStream, Box<dyn Error + Send + Sync>> {
    let name = format!("{} · {} · {}", run.scenario.name, run.plan.planner, run.verdict.outcome);
    let stream = RecordingStreamBuilder::new(APPLICATION)
        .enabled(true) // also if the variable RERUN disables rerun: the user asked for this file
        .recording_id(recording_id(run))
        .send_properties(true)
        .recording_name(name)
        .save(path)?;
    stream.set_log_time_enabled(false);
    stream.set_log_tick_enabled(false);
    let text = |value: &str| [Text::from(value)];
    let properties = AnyValues::default()
        .with_component::<Text>("scenario", text(&run.scenario.name))
        .with_component::<Text>("planner", text(&run.plan.planner))
        .with_component::<Text>("seed", text(&run.plan.seed.to_string()))
        .with_component::<Text>("verdict", text(&run.verdict.outcome.to_string()));
    stream.send_property("harness", &properties)?;
    Ok(stream)
}

/// Equal for equal plan and flight: the viewer treats a run that was recorded twice as one recording, and can open two
/// different results of one scenario side by side.
fn recording_id(run: &Run<'_>) -> String {
    let mut hasher = DefaultHasher::new();
    let planned = run
        .plan
        .trajectories
        .iter()
        .flat_map(|trajectory| (0..trajectory.node_count()).map(|node| trajectory.nodes().position_m(node)));
    let logs = run.flight.iter().flat_map(|flight| &flight.vehicles);
    let flown = logs.flat_map(|log| &log.samples).map(|sample| sample.position_m);
    planned.chain(flown).flatten().for_each(|coordinate| coordinate.to_bits().hash(&mut hasher));
    format!("{}/{}/seed-{}/{:016x}", run.scenario.name, run.plan.planner, run.plan.seed, hasher.finish())
}

/// The entity `name` in `group`, whatever characters the name has.
fn entity(group: &str, name: &str) -> EntityPath {
    EntityPath::from(group) / EntityPathPart::new(name)
}

/// A column of times on `sim_time`, s.
fn sim_times(times_s: impl IntoIterator<Item = f64>) -> TimeColumn {
    TimeColumn::new_duration_secs(SIM_TIME, times_s)
}

/// To the viewer's single precision.
fn to_f32<const N: usize>(values: [f64; N]) -> [f32; N] {
    values.map(|value| value as f32)
}

#[cfg(test)]
mod tests;
