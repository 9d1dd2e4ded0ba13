//! Plans that were written elsewhere: by a planner of any language, as CSV, JSON or Parquet.
//!
//! All three are tables to us: per vehicle a [`ColumnTable`] of named columns over time. [`columns`] says what the columns of a
//! vehicle family mean; `check` holds a table against the scenario and finds every issue that is one of the file and
//! not of the motion it describes: wrong names, gaps, times that do not increase, numbers that are none, units that
//! cannot be meant.

mod check;
pub mod columns;
mod csv;
mod error;
mod imported;
mod json;
#[cfg(feature = "parquet")]
mod parquet;
mod units;

use std::collections::BTreeMap;
use std::path::Path;

use self::columns::Columns;
pub use self::error::{PlanError, PlanIssue};
pub use self::imported::ImportedTrajectory;
use crate::{Iteration, PlanDiagnostics, PlanStatus, PlanTimings, Scenario};

/// A plan as it was written, before anything is made of it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PlanDocument {
    /// What the document says of itself; CSV and Parquet say nothing.
    pub header: PlanHeader,
    /// One per vehicle, in the order in which they appear.
    pub tracks: Vec<ColumnTable>,
}

/// What a plan says of itself beside its trajectories.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PlanHeader {
    /// Scenario that it answers.
    pub scenario: Option<String>,
    /// Who made it.
    pub planner: Option<String>,
    /// What its maker says of it.
    pub status: Option<PlanStatus>,
    /// Why the status is not `solved`.
    pub reason: Option<String>,
    /// Value of the planner's objective.
    pub objective: Option<f64>,
    /// One entry per iteration.
    pub history: Vec<Iteration>,
    /// What the planner tells beyond its trajectories.
    pub diagnostics: PlanDiagnostics,
    /// Time that planning took, by the planner's own clock.
    pub timings: Option<PlanTimings>,
}

/// The rows of one vehicle.
#[derive(Clone, Debug, PartialEq)]
pub struct ColumnTable {
    /// Name of the vehicle.
    pub vehicle: String,
    /// Where each row stands, for messages.
    pub places: RowLocations,
    /// Times, s.
    pub times_s: Vec<f64>,
    /// Values by the names of their columns, each as long as `times_s`; words by their numbers.
    pub columns: BTreeMap<String, Vec<f64>>,
    /// The rows at which the planner's own constraints stood, by index; empty: all of them.
    pub planner_nodes: Vec<usize>,
}

impl ColumnTable {
    /// Three columns as one triple per row; `None` if one of them is missing.
    pub(crate) fn triples(&self, names: [&str; 3]) -> Option<Vec<[f64; 3]>> {
        let [a, b, c] = names.map(|name| self.columns.get(name));
        let (a, b, c) = (a?, b?, c?);
        Some((0..self.times_s.len()).map(|row| [a[row], b[row], c[row]]).collect())
    }
}

/// Where the rows of a track stand.
#[derive(Clone, Debug, PartialEq)]
pub enum RowLocations {
    /// Line of a text file, from 1, per row.
    Lines(Vec<usize>),
    /// Row of a binary table, from 1, per row.
    Rows(Vec<usize>),
    /// Index of the trajectory in a document; the row's index is its node.
    Trajectory(usize),
}

impl RowLocations {
    /// Where row `row` stands, in words that follow the name of the file: `:17`, ` row 16`, ` trajectories[0] node 3`.
    fn of(&self, row: usize) -> String {
        match self {
            Self::Lines(lines) => lines.get(row).map_or_else(String::new, |line| format!(":{line}")),
            Self::Rows(rows) => rows.get(row).map_or_else(String::new, |row| format!(", row {row}")),
            Self::Trajectory(index) => format!(", trajectories[{index}] node {row}"),
        }
    }
}

/// Reads a plan file for `scenario`: `.csv`, `.json` or (with the feature `parquet`) `.parquet`.
///
/// Returns the header and one track per vehicle, in the order of the scenario, or every issue of the file.
pub fn read(path: &Path, scenario: &Scenario) -> Result<(PlanHeader, Vec<ImportedTrajectory>), PlanError> {
    let name = path.display().to_string();
    let unreadable = |reason| PlanError::Read { path: path.to_owned(), reason };
    let table = match path.extension().and_then(|extension| extension.to_str()) {
        Some("csv") => csv::read(&text_of(&std::fs::read(path).map_err(unreadable)?), scenario),
        Some("json") => json::read(&text_of(&std::fs::read(path).map_err(unreadable)?), columns_of(scenario)),
        #[cfg(feature = "parquet")]
        Some("parquet") => parquet::read(std::fs::File::open(path).map_err(unreadable)?, scenario),
        #[cfg(not(feature = "parquet"))]
        Some("parquet") => return Err(PlanError::ParquetNotBuilt { path: path.to_owned() }),
        _ => return Err(PlanError::Kind { path: path.to_owned() }),
    };
    finish(&name, table, scenario)
}

/// Reads a plan from the text of a JSON document, as [`read`] does from a file. `name` stands for it in messages.
pub fn parse_json(
    name: &str,
    text: &str,
    scenario: &Scenario,
) -> Result<(PlanHeader, Vec<ImportedTrajectory>), PlanError> {
    finish(name, json::read(text, columns_of(scenario)), scenario)
}

/// Reads a plan from the text of a CSV file, as [`read`] does from a file. `name` stands for it in messages.
pub fn parse_csv(
    name: &str,
    text: &str,
    scenario: &Scenario,
) -> Result<(PlanHeader, Vec<ImportedTrajectory>), PlanError> {
    finish(name, csv::read(text, scenario), scenario)
}

fn finish(
    name: &str,
    table: Result<PlanDocument, Vec<PlanIssue>>,
    scenario: &Scenario,
) -> Result<(PlanHeader, Vec<ImportedTrajectory>), PlanError> {
    let checked = table.and_then(|table| {
        let tracks = check::tracks(&table, scenario)?;
        Ok((table.header, tracks))
    });
    checked.map_err(|issues| PlanError::invalid(name, &scenario.name, issues))
}

/// The columns of the scenario's vehicles, which are all of one family.
fn columns_of(scenario: &Scenario) -> &'static Columns {
    scenario.family().spec().columns
}

/// The text of a file; what is no UTF-8 becomes a sign that no number and no name contains.
fn text_of(bytes: &[u8]) -> String {
    let text = String::from_utf8_lossy(bytes);
    text.strip_prefix('\u{feff}').unwrap_or(&text).to_owned()
}
