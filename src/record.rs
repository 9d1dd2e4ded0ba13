//! Recordings: a run as one file that explains itself in a viewer.
//!
//! A [`Recorder`] knows one file format and the library behind it; nobody else does. What it is given is a [`Run`]:
//! everything from the scenario to the verdict. It must cope with whatever a run can bring, a plan without
//! trajectories and a flight full of NaN included, because a failed run is the one that people want to look at.

use std::error::Error;
use std::fs;
use std::path::{Path, PathBuf};

use scenarios::{Plan, Scenario};
use sim::Flight;

use crate::verdict::Verdict;

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
}

/// One recording format.
pub trait Recorder {
    /// Name of its file in a result folder.
    fn file_name(&self) -> &'static str;

    /// Writes the whole recording to `path`, which nobody else looks at yet, and closes it.
    fn write(&self, run: &Run<'_>, path: &Path) -> Result<(), Box<dyn Error + Send + Sync>>;
}

/// A recording could not be written: an error of the environment (folder, disk), never of the run.
#[derive(Debug, thiserror::Error)]
#[error("cannot write the recording {}: {reason}", path.display())]
pub struct RecordError {
    /// Where it should have gone.
    pub path: PathBuf,
    /// What stood in the way.
    pub reason: String,
}

/// Records `run` into the existing folder `folder` and returns the path of the file.
///
/// The file appears under its name only when it is complete: it is written beside it and renamed.
pub fn record(recorder: &dyn Recorder, run: &Run<'_>, folder: &Path) -> Result<PathBuf, RecordError> {
    let path = folder.join(recorder.file_name());
    let partial = folder.join(format!(".{}.{}.partial", recorder.file_name(), std::process::id()));
    let written = recorder.write(run, &partial).and_then(|()| Ok(fs::rename(&partial, &path)?));
    match written {
        Ok(()) => Ok(path),
        Err(reason) => {
            // Nothing to add if even that fails: the reason is already on its way to the user.
            let _ = fs::remove_file(&partial);
            Err(RecordError { path, reason: reason.to_string() })
        }
    }
}

#[cfg(test)]
mod tests;
