//! Recordings: a run as one file that explains itself in a viewer.
//!
//! A [`Recorder`] knows one file format and the library behind it; nobody else does. What it is given is a [`Run`]:
//! everything from the scenario to the verdict. It must cope with whatever a run can bring, a plan without
//! trajectories and a flight full of NaN included, because a failed run is the one that people want to look at.

use std::path::{Path, PathBuf};

use crate::error::Error;
use crate::output;

pub use crate::output::run::Run;

#[cfg(feature = "mcap")]
pub mod mcap;
#[cfg(feature = "parquet")]
pub mod parquet;
#[cfg(feature = "rrd")]
pub mod rrd;

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

#[cfg(test)]
mod tests;
