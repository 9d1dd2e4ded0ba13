//! Recordings of a run for viewers and other tools.
//!
//! A [`Recorder`] is the only place that knows its file format and the library for it. It records whatever a run produced,
//! a plan without trajectories and a flight full of NaN included: failed runs are those that people look at.

use std::path::{Path, PathBuf};

use scenarios::{Plan, Scenario};
use sim::Flight;

use crate::campaign::margin_budget::MarginBudget;
use crate::error::Error;
use crate::output;
use crate::output::ghost::Ghost;
use crate::output::run::JudgedRun;
use crate::verdict::Verdict;

#[cfg(feature = "mcap")]
pub mod mcap;
#[cfg(feature = "parquet")]
pub mod parquet;
#[cfg(feature = "rrd")]
pub mod rrd;
pub mod scene_json;

/// Everything that a run produced, from the scenario to the verdict.
#[derive(Clone, Copy, Debug)]
pub struct Run<'a> {
    /// The scenario.
    pub scenario: &'a Scenario,
    /// The plan, possibly without trajectories.
    pub plan: &'a Plan,
    /// The flight; `None` if the plan could not be flown.
    pub flight: Option<&'a Flight>,
    /// The verdict on plan and flight.
    pub verdict: &'a Verdict,
    /// The margin budgets; empty unless they were asked for.
    pub waterfall: &'a [MarginBudget],
    /// An earlier flight to show beside this one.
    pub ghost: Option<&'a Ghost>,
}

/// A recording format.
pub trait Recorder {
    /// Name of its file in a result folder.
    fn file_name(&self) -> &'static str;

    /// Writes the whole recording to the temporary file `path` and closes it.
    ///
    /// # Errors
    ///
    /// Those of the library, about serialisation or the file.
    fn write(&self, run: &Run<'_>, path: &Path) -> Result<(), Box<dyn std::error::Error + Send + Sync>>;
}

/// Records `run` into the existing folder `folder`, atomically, and returns the path of the file.
///
/// # Errors
///
/// [`Error::Write`] if the recorder fails or the file cannot be renamed.
pub fn record(recorder: &dyn Recorder, run: &Run<'_>, folder: &Path) -> Result<PathBuf, Error> {
    let path = folder.join(recorder.file_name());
    output::replace_file(&path, |partial| recorder.write(run, partial))?;
    Ok(path)
}

impl<'a> Run<'a> {
    /// Without the margin budgets.
    fn judged(&self) -> JudgedRun<'a> {
        let Self { scenario, plan, flight, verdict, ghost, .. } = *self;
        JudgedRun { scenario, plan, flight, verdict, ghost }
    }
}

#[cfg(test)]
mod tests;
