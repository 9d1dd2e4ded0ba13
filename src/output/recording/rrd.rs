//! The rerun recording: `flight.rrd`, with a layout that opens by itself.
//!
//! | entities | what | where it is written |
//! |---|---|---|
//! | `/world/map`, `/world/obstacles`, `/world/ends` | map, obstacles, starts and goals | `world` |
//! | `/world/planned`, `/world/flown`, `/world/trail` | one line per vehicle | `paths` |
//! | `/world/alternatives` | ways that were tried and not taken | `paths` |
//! | `/world/fleet/NAME` | the moving aircraft and its safety volume | `fleet` |
//! | `/world/closest`, `/world/crashed` | where it came closest to a limit, where it crashed | `closest` |
//! | `/plots/GROUP/NAME`, `/limits/GROUP/NAME` | time series and what they are held against | `series` |
//! | `/planner/NAME` | convergence, on the timeline `planner_iter` | `convergence` |
//! | `/events` | text log | `events` |
//! | see there | what a quadrotor with a slung load has of its own | `slung_load` |
//! | see there | what multirotors sense and plan in the loop | `multirotor` |
//! | `/margins/QUESTION` | where the margins went | `margin_budget` |
//! | `/verdict`, `/convergence` | documents | `document`, `convergence` |
//!
//! Everything that moves is on the timeline `sim_time` and is sent in columns; everything else is static.

mod airframe;
mod blueprint;
mod closest;
mod convergence;
mod decimation;
mod distances;
mod document;
mod events;
mod fleet;
mod layout;
mod margin_budget;
mod multirotor;
mod palette;
mod paths;
mod quantity;
mod series;
mod slung_load;
mod world;

use std::error::Error;
use std::hash::{DefaultHasher, Hash, Hasher};
use std::path::Path;

use rerun::components::Text;
use rerun::{AnyValues, EntityPath, EntityPathPart, RecordingStream, RecordingStreamBuilder, TimeColumn};
use scenarios::Family;

use self::distances::Distances;
use super::{Recorder, Run, is_drawable};

/// What logging functions return: rerun's own errors, which concern serialisation and the file.
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
        let distances = Distances::of(run);
        layout::send(&stream, run, &distances)?;
        document::log(&stream, run)?;
        events::log(&stream, run)?;
        margin_budget::log(&stream, run.waterfall)?;
        world::log(&stream, run.scenario)?;
        convergence::log(&stream, run.plan)?;
        paths::log_planned(&stream, run)?;
        paths::log_alternatives(&stream, run)?;
        if let Some(flight) = run.flight {
            paths::log_flown(&stream, flight)?;
            closest::log(&stream, run, flight)?;
            match run.scenario.family() {
                Family::FixedWing => {
                    fleet::log(&stream, run.scenario, flight)?;
                    series::log(&stream, run.scenario, flight, distances)?;
                }
                Family::SlungLoad => slung_load::log(&stream, run, flight)?,
                Family::Multirotor => multirotor::log(&stream, run, flight, distances)?,
            }
        }
        stream.flush_blocking()?;
        Ok(())
    }
}

/// Opens the file and says whose recording it is.
fn open(run: &Run<'_>, path: &Path) -> Result<RecordingStream, Box<dyn Error + Send + Sync>> {
    let name = format!("{} · {} · {}", run.scenario.name, run.plan.planner, run.verdict.outcome);
    let stream = RecordingStreamBuilder::new(APPLICATION)
        .enabled(true) // also when the variable RERUN says otherwise: the user has asked for this file
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

/// The same for the same plan and flight, so that a run recorded twice is one recording to the viewer, while two
/// different results of one scenario can be open side by side.
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
