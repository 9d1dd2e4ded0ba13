//! Import of plans from CSV, JSON or Parquet files.
//!
//! Every format is read into one [`ColumnTable`] per vehicle: named columns over time. [`columns`] defines the columns of
//! the vehicle families, [`names`] how people write them. Polynomial pieces and splines are read into a
//! [`Curve`]. `check` compares the tables with the scenario and rejects faulty files: wrong names, gaps, times
//! that do not increase, numbers that are not finite, implausible units. Whether the motion can be flown is left to the
//! judge.
//!
//! # Examples
//!
//! ```
//! use std::path::Path;
//! use scenarios::plan_input::parse_csv;
//!
//! let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("multirotor/trap.toml");
//! let scenario = scenarios::load(&file)?;
//! let text = "t_s,x_m,y_m,z_m,vx_mps,vy_mps,vz_mps\n0,0,0,oops,0,0,0\n";
//! let error = parse_csv("plan.csv", text, &scenario).unwrap_err();
//! assert!(error.lines()[0].starts_with("plan.csv:2: z_m: found \"oops\", expected a number"));
//! # Ok::<(), scenarios::LoadError>(())
//! ```

mod check;
pub mod columns;
mod csv;
mod digits;
mod error;
mod flight;
mod imported;
mod json;
mod layout;
pub mod names;
#[cfg(feature = "parquet")]
mod parquet;
mod polynomial;
mod units;

use std::collections::BTreeMap;
use std::path::Path;

use self::columns::Columns;
pub use self::error::{PlanError, PlanIssue};
pub(crate) use self::flight::flight_columns;
pub use self::flight::{RecordedRows, RecordedTrack, Setpoints, flight_from_tables, parse_flight_csv, read_flight};
pub use self::imported::ImportedTrajectory;
use self::names::ColumnMap;
use crate::curve::Curve;
use crate::{Iteration, PlanDiagnostics, PlanStatus, PlanTimings, Scenario};

/// The content of a plan file, not yet checked against a scenario.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PlanDocument {
    /// Everything except the trajectories; empty for CSV and Parquet.
    pub header: PlanHeader,
    /// One table per vehicle, in the order of their appearance.
    pub tables: Vec<ColumnTable>,
    /// One curve per vehicle that is not given as a table.
    pub curves: Vec<Curve>,
}

/// The content of a plan file except the trajectories.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PlanHeader {
    /// Name of the scenario.
    pub scenario: Option<String>,
    /// Name of the planner.
    pub planner: Option<String>,
    /// Status reported by the planner.
    pub status: Option<PlanStatus>,
    /// Why the status is not `solved`.
    pub reason: Option<String>,
    /// Value of the objective.
    pub objective: Option<f64>,
    /// One entry per iteration.
    pub history: Vec<Iteration>,
    /// Events and alternatives.
    pub diagnostics: PlanDiagnostics,
    /// Planning time, measured by the planner.
    pub timings: Option<PlanTimings>,
    /// What the user should know of how the file was read.
    pub remarks: Vec<String>,
}

/// The rows of one vehicle.
#[derive(Clone, Debug, PartialEq)]
pub struct ColumnTable {
    /// Name of the vehicle.
    pub vehicle: String,
    /// Location of each row, for messages.
    pub locations: RowLocations,
    /// Times, s.
    pub times_s: Vec<f64>,
    /// Values by column name, each as long as `times_s`; words as their numbers.
    pub columns: BTreeMap<String, Vec<f64>>,
    /// Indices of the rows at which the planner imposed its constraints; empty: all rows.
    pub planner_nodes: Vec<usize>,
}

impl PlanDocument {
    /// The table of `vehicle`; created with empty `columns` if there is none.
    fn table_of(
        &mut self,
        vehicle: &str,
        locations: RowLocations,
        columns: impl Iterator<Item = String>,
    ) -> &mut ColumnTable {
        let index = self.tables.iter().rposition(|table| table.vehicle == vehicle).unwrap_or_else(|| {
            self.tables.push(ColumnTable {
                vehicle: vehicle.to_owned(),
                locations,
                times_s: Vec::new(),
                columns: columns.map(|name| (name, Vec::new())).collect(),
                planner_nodes: Vec::new(),
            });
            self.tables.len() - 1
        });
        &mut self.tables[index]
    }
}

impl ColumnTable {
    /// Three columns as one triple per row; `None` if one of them is missing.
    pub(crate) fn triples(&self, names: [&str; 3]) -> Option<Vec<[f64; 3]>> {
        let [a, b, c] = names.map(|name| self.columns.get(name));
        let (a, b, c) = (a?, b?, c?);
        Some((0..self.times_s.len()).map(|row| [a[row], b[row], c[row]]).collect())
    }
}

/// Locations of the rows of a table in their file.
#[derive(Clone, Debug, PartialEq)]
pub enum RowLocations {
    /// Line of a text file, from 1, per row.
    Lines(Vec<usize>),
    /// Row of a binary table, from 1, per row.
    Rows(Vec<usize>),
    /// Index of the trajectory in a JSON document; rows are nodes.
    Trajectory(usize),
}

impl RowLocations {
    /// Location of a row, to append to the name of the file: `:17`, `, row 16`, `, trajectories[0] node 3`.
    fn of(&self, row: usize) -> String {
        match self {
            Self::Lines(lines) => lines.get(row).map_or_else(String::new, |line| format!(":{line}")),
            Self::Rows(rows) => rows.get(row).map_or_else(String::new, |row| format!(", row {row}")),
            Self::Trajectory(index) => format!(", trajectories[{index}] node {row}"),
        }
    }
}

/// Reads a plan file for `scenario`: a text table (`.csv`, `.tsv`, `.txt`, `.tum`), `.json` or (with the feature `parquet`)
/// `.parquet`.
///
/// Returns the header, and one trajectory per vehicle in the order of the scenario.
///
/// # Errors
///
/// The file cannot be read, its format is not supported, or its content is not a plan for `scenario`. All issues are
/// reported together.
pub fn read(path: &Path, scenario: &Scenario) -> Result<(PlanHeader, Vec<ImportedTrajectory>), PlanError> {
    read_with(path, scenario, &ColumnMap::default())
}

/// Like [`read()`], with names of the file's columns.
///
/// # Errors
///
/// As of [`read()`].
pub fn read_with(
    path: &Path,
    scenario: &Scenario,
    map: &ColumnMap,
) -> Result<(PlanHeader, Vec<ImportedTrajectory>), PlanError> {
    let name = path.display().to_string();
    let columns = columns_of(scenario);
    let document = match path.extension().and_then(|extension| extension.to_str()) {
        Some("json") => json::read(&text_of(&bytes_of(path)?), columns),
        _ => read_table(path, scenario, columns, map)?.ok_or_else(|| PlanError::Kind { path: path.to_owned() })?,
    };
    finish(&name, document, scenario)
}

/// The content of a table; `None` if the extension is not that of one.
///
/// - `columns`: those of the kind of file
fn read_table(
    path: &Path,
    scenario: &Scenario,
    columns: &'static Columns,
    map: &ColumnMap,
) -> Result<Option<Result<PlanDocument, Vec<PlanIssue>>>, PlanError> {
    Ok(match path.extension().and_then(|extension| extension.to_str()) {
        Some("csv" | "txt" | "tum" | "tsv") => Some(csv::read(&text_of(&bytes_of(path)?), scenario, columns, map)),
        #[cfg(feature = "parquet")]
        Some("parquet") => {
            let file = std::fs::File::open(path).map_err(|reason| unreadable(path, reason))?;
            Some(parquet::read(file, scenario, columns, map))
        }
        #[cfg(not(feature = "parquet"))]
        Some("parquet") => return Err(PlanError::ParquetNotBuilt { path: path.to_owned() }),
        _ => None,
    })
}

fn bytes_of(path: &Path) -> Result<Vec<u8>, PlanError> {
    std::fs::read(path).map_err(|reason| unreadable(path, reason))
}

fn unreadable(path: &Path, reason: std::io::Error) -> PlanError {
    PlanError::Read { path: path.to_owned(), reason }
}

/// Like [`read`], from the text of a JSON document. `name` is its name in messages.
///
/// # Errors
///
/// The text is not a plan for `scenario`.
pub fn parse_json(
    name: &str,
    text: &str,
    scenario: &Scenario,
) -> Result<(PlanHeader, Vec<ImportedTrajectory>), PlanError> {
    finish(name, json::read(text, columns_of(scenario)), scenario)
}

/// Like [`read`], from the text of a CSV file. `name` is its name in messages.
///
/// # Errors
///
/// The text is not a plan for `scenario`.
pub fn parse_csv(
    name: &str,
    text: &str,
    scenario: &Scenario,
) -> Result<(PlanHeader, Vec<ImportedTrajectory>), PlanError> {
    finish(name, csv::read(text, scenario, columns_of(scenario), &ColumnMap::default()), scenario)
}

/// Like [`read()`], from tables in memory. `name` is their name in messages.
///
/// # Errors
///
/// The tables are not a plan for `scenario`.
pub fn from_tables(
    name: &str,
    document: PlanDocument,
    scenario: &Scenario,
) -> Result<(PlanHeader, Vec<ImportedTrajectory>), PlanError> {
    finish(name, Ok(document), scenario)
}

fn finish(
    name: &str,
    document: Result<PlanDocument, Vec<PlanIssue>>,
    scenario: &Scenario,
) -> Result<(PlanHeader, Vec<ImportedTrajectory>), PlanError> {
    let checked = document.and_then(|document| {
        let trajectories = check::trajectories(&document, scenario, columns_of(scenario))?;
        Ok((document.header, trajectories))
    });
    checked.map_err(|issues| PlanError::invalid(name, "plan", &scenario.name, issues))
}

fn columns_of(scenario: &Scenario) -> &'static Columns {
    scenario.family().spec().columns
}

/// The text of a file without byte order mark. Invalid UTF-8 becomes U+FFFD, which no number and no name contains.
fn text_of(bytes: &[u8]) -> String {
    let text = String::from_utf8_lossy(bytes);
    text.strip_prefix('\u{feff}').unwrap_or(&text).to_owned()
}
