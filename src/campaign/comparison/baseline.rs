//! Baseline files: accepted results, to be committed beside the scenarios.

use std::fs;
use std::path::Path;

use serde::{Deserialize, Serialize};

use super::{Snapshot, rules};
use crate::error::Error;
use crate::output;

/// Version of the format of a baseline file.
const SCHEMA: u32 = 1;

/// A baseline file.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Baseline {
    /// Version of this format: 1.
    pub schema: u32,
    /// The reasons of all acceptances, the latest last.
    pub accepted: Vec<Acceptance>,
    /// The results.
    pub results: Snapshot,
}

/// One acceptance of results.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Acceptance {
    /// The reason.
    pub reason: String,
    /// Version of the harness.
    pub harness: String,
}

impl Baseline {
    /// Reads a baseline file.
    ///
    /// # Errors
    ///
    /// [`Error::Results`] if it cannot be read, or is not a baseline of this version.
    pub fn read(path: &Path) -> Result<Self, Error> {
        let text = fs::read_to_string(path).map_err(|reason| Error::results(path, reason.to_string()))?;
        let baseline: Self = serde_json::from_str(&text)
            .map_err(|reason| Error::results(path, format!("not a baseline of this version: {reason}")))?;
        if baseline.schema != SCHEMA {
            return Err(Error::results(path, format!("format version {}; expected {SCHEMA}", baseline.schema)));
        }
        Ok(baseline)
    }

    /// Accepts `results` for `reason`. Results of an earlier baseline for other scenarios and all its reasons are kept.
    pub fn accept(earlier: Option<Self>, mut results: Snapshot, reason: &str) -> Self {
        for entry in &mut results.entries {
            // It depends on the machine.
            entry.figures.remove(rules::PLANNING_TIME);
        }
        let mut accepted = Vec::new();
        if let Some(earlier) = earlier {
            accepted = earlier.accepted;
            let is_kept = |scenario: &str, planner: &str| results.find(scenario, planner).is_none();
            let mut kept = earlier.results.entries;
            kept.retain(|entry| is_kept(&entry.scenario, &entry.planner));
            results.entries.extend(kept);
            results.entries.sort_by(|a, b| (&a.scenario, &a.planner).cmp(&(&b.scenario, &b.planner)));
        }
        accepted.push(Acceptance { reason: reason.to_owned(), harness: env!("CARGO_PKG_VERSION").to_owned() });
        Self { schema: SCHEMA, accepted, results }
    }

    /// Writes the file atomically.
    ///
    /// # Errors
    ///
    /// [`Error::Write`] if it cannot be written.
    pub fn write(&self, path: &Path) -> Result<(), Error> {
        output::write_json(path, self)
    }
}
