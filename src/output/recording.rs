//! Recordings: a run as one file that explains itself in a viewer.
//!
//! A [`Recorder`] knows one file format and the library behind it; nobody else does. What it is given is a [`Run`]:
//! everything from the scenario to the verdict. It must cope with whatever a run can bring, a plan without
//! trajectories and a flight full of NaN included, because a failed run is the one that people want to look at.

use std::path::{Path, PathBuf};

use scenarios::{Plan, Scenario};
use sim::Flight;

use crate::campaign::margin_budget::MarginBudget;
use crate::error::Error;
use crate::output;
use crate::verdict::Verdict;

#[cfg(any(feature = "mcap", feature = "rrd"))]
mod colours;
#[cfg(any(feature = "mcap", feature = "rrd"))]
mod events;
#[cfg(feature = "mcap")]
pub mod mcap;
#[cfg(feature = "parquet")]
pub mod parquet;
#[cfg(feature = "rrd")]
pub mod rrd;

/// What there is to record.
#[derive(Clone, Copy, Debug)]
pub struct Run<'a> {
    /// The question.
    pub scenario: &'a Scenario,
    /// The planner's answer, possibly without trajectories.
    pub plan: &'a Plan,
    /// What became of it; `None` if nothing could be flown.
    pub flight: Option<&'a Flight>,
    /// What the judge made of it.
    pub verdict: &'a Verdict,
    /// Where the margins went; empty if nobody asked.
    pub waterfall: &'a [MarginBudget],
}

/// One recording format.
pub trait Recorder {
    /// Name of its file in a result folder.
    fn file_name(&self) -> &'static str;

    /// Writes the whole recording to `path`, which nobody else looks at yet, and closes it.
    fn write(&self, run: &Run<'_>, path: &Path) -> Result<(), Box<dyn std::error::Error + Send + Sync>>;
}

/// Records `run` into the existing folder `folder`, all or nothing, and returns the path of the file.
pub fn record(recorder: &dyn Recorder, run: &Run<'_>, folder: &Path) -> Result<PathBuf, Error> {
    let path = folder.join(recorder.file_name());
    output::replace_file(&path, |partial| recorder.write(run, partial))?;
    Ok(path)
}

/// Can a viewer draw a vehicle from this sample?
#[cfg(any(feature = "mcap", feature = "rrd"))]
fn is_drawable(sample: &sim::Sample) -> bool {
    let attitude_norm: f64 = sample.world_from_body.iter().map(|q| q * q).sum();
    sample.t_s.is_finite() && sample.position_m.iter().all(|p| p.is_finite()) && (0.5..2.0).contains(&attitude_norm)
}

#[cfg(test)]
mod tests;
