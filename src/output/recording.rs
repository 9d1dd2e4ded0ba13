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
///
/// # Examples
///
/// A table of altitudes, and its recording of a run whose plan could not be flown:
///
/// ```
/// use std::error::Error;
/// use std::fs;
/// use std::path::Path;
///
/// use harness::output::recording::{Recorder, Run, record};
///
/// struct Altitudes;
///
/// impl Recorder for Altitudes {
///     fn file_name(&self) -> &'static str {
///         "altitudes.csv"
///     }
///
///     fn write(&self, run: &Run<'_>, path: &Path) -> Result<(), Box<dyn Error + Send + Sync>> {
///         let mut csv = "vehicle,t_s,z_m\n".to_owned();
///         for log in run.flight.iter().flat_map(|flight| &flight.vehicles) {
///             for sample in &log.samples {
///                 csv += &format!("{},{},{}\n", log.vehicle, sample.t_s, sample.position_m[2]);
///             }
///         }
///         Ok(fs::write(path, csv)?)
///     }
/// }
///
/// let file = concat!(env!("CARGO_MANIFEST_DIR"), "/scenarios/fixed-wing/rendezvous-1.toml");
/// let scenario = scenarios::load(file.as_ref())?;
/// let plan = scenarios::Plan::no_plan(&scenario.name, "by-hand", 0, "not tried");
/// let verdict = harness::verdict::judge(&scenario, &plan, None);
/// let run = Run { scenario: &scenario, plan: &plan, flight: None, verdict: &verdict, waterfall: &[], ghost: None };
/// let folder = tempfile::tempdir()?;
/// let recording = record(&Altitudes, &run, folder.path())?;
/// assert_eq!(fs::read_to_string(recording)?, "vehicle,t_s,z_m\n");
/// # Ok::<(), Box<dyn Error>>(())
/// ```
pub trait Recorder: Sync {
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
