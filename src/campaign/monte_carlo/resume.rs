//! Samples that a folder holds already: of a sweep that was killed, or of one with fewer samples.

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::path::Path;
use std::sync::Mutex;
use std::time::{Duration, Instant};

use sha2::{Digest, Sha256};

use super::{Experiment, Sample, Sweep, merge, table};
use crate::error::Error;
use crate::output;
use crate::plan_source::PlanSource;

/// The samples of a finished sweep.
pub const TABLE: &str = "sweep.parquet";
/// The samples so far of a running or killed sweep.
const CHECKPOINT: &str = "sweep-checkpoint.parquet";
/// Time between two checkpoints.
const CHECKPOINT_INTERVAL: Duration = Duration::from_secs(1);
/// Bytes of a fingerprint.
const FINGERPRINT_BYTES: usize = 16;

/// A fingerprint of everything that is flown besides the program: the scenario, and the plan if it is made before the flight.
pub fn fingerprint(experiment: &Experiment<'_>) -> String {
    let mut hash = Sha256::new();
    hash.update(experiment.scenario.to_toml());
    if let PlanSource::Imported(answer) = experiment.system {
        let mut rows = Vec::new();
        // Nothing can fail when memory is written to; a plan that has no table has no rows in both sweeps.
        let _ = answer.plan.write_csv(&mut rows);
        hash.update(rows);
    }
    hash.finalize().iter().take(FINGERPRINT_BYTES).fold(String::new(), |mut text, byte| {
        let _ = write!(text, "{byte:02x}");
        text
    })
}

/// The samples of `sweep` that a folder holds, in the order of their numbers.
///
/// # Errors
///
/// [`Error::Samples`] if a table in the folder cannot be read, belongs to another sweep, or holds more samples.
pub fn known_samples(folder: &Path, sweep: &Sweep) -> Result<Vec<Sample>, Error> {
    let mut known = BTreeMap::new();
    for name in [TABLE, CHECKPOINT] {
        let path = folder.join(name);
        if !path.exists() {
            continue;
        }
        let (other, samples) = table::read(&path)?;
        let same_size = Sweep { samples: sweep.samples, ..other };
        if let Some(property) = merge::difference(sweep, &same_size) {
            let reason =
                format!("{property} differs from that of the sweep to be resumed: leave out --resume to begin anew");
            return Err(Error::Samples { path, reason });
        }
        let flown = samples.iter().map(|sample| sample.number + 1).max().unwrap_or(0);
        if flown > sweep.samples {
            let asked = sweep.samples;
            let reason =
                format!("it holds {flown} samples, and {asked} are asked for: --resume adds samples and removes none");
            return Err(Error::Samples { path, reason });
        }
        known.extend(samples.into_iter().map(|sample| (sample.number, sample)));
    }
    Ok(known.into_values().collect())
}

/// Removes the checkpoint of a folder.
///
/// # Errors
///
/// [`Error::Write`] if it exists and cannot be removed.
pub fn remove_checkpoint(folder: &Path) -> Result<(), Error> {
    output::remove_stale(&folder.join(CHECKPOINT))
}

/// Collects samples from any thread, and writes those so far about once per second, so that a sweep that is killed can be resumed.
pub struct Checkpoint<'a> {
    sweep: &'a Sweep,
    folder: &'a Path,
    state: Mutex<State>,
}

struct State {
    samples: BTreeMap<usize, Sample>,
    written: Instant,
    failure: Option<Error>,
}

impl<'a> Checkpoint<'a> {
    /// A collector that holds the samples that are known already.
    pub fn new(sweep: &'a Sweep, folder: &'a Path, known: Vec<Sample>) -> Self {
        let samples = known.into_iter().map(|sample| (sample.number, sample)).collect();
        Self { sweep, folder, state: Mutex::new(State { samples, written: Instant::now(), failure: None }) }
    }

    /// Takes a sample.
    pub fn add(&self, sample: Sample) {
        let Ok(mut state) = self.state.lock() else { return };
        state.samples.insert(sample.number, sample);
        if state.written.elapsed() >= CHECKPOINT_INTERVAL && state.failure.is_none() {
            let so_far: Vec<Sample> = state.samples.values().cloned().collect();
            state.failure = table::write(self.sweep, &so_far, &self.folder.join(CHECKPOINT)).err();
            state.written = Instant::now();
        }
    }

    /// All samples, in the order of their numbers.
    ///
    /// # Errors
    ///
    /// [`Error::Write`] if a checkpoint could not be written.
    ///
    /// # Panics
    ///
    /// If a flight panicked (a bug).
    pub fn finish(self) -> Result<Vec<Sample>, Error> {
        let state = self.state.into_inner().expect("no flight has panicked");
        match state.failure {
            Some(failure) => Err(failure),
            None => Ok(state.samples.into_values().collect()),
        }
    }
}
