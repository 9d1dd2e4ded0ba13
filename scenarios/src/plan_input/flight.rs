//! Logs of flights that were flown elsewhere: the columns of a plan without controls, and those of the setpoints.

use std::path::Path;

use super::columns::{Columns, Gaps};
use super::names::ColumnMap;
use super::{ImportedTrajectory, PlanDocument, PlanError, PlanIssue, check, csv, read_table};
use crate::{Issue, Scenario};

/// Columns of the setpoints, as the flight tables of `harness run` name them. A file has all of them or none.
pub(crate) const SETPOINT: [&str; 3] = ["reference_x_m", "reference_y_m", "reference_z_m"];

/// Columns of the flight tables of `harness run` that are not used.
const IGNORED: [&str; 9] =
    ["reference_vx_mps", "reference_vy_mps", "reference_vz_mps", "ax_mps2", "ay_mps2", "az_mps2", "n_x", "n_y", "n_z"];

/// What the logs of all vehicles give.
#[derive(Clone, Debug, PartialEq)]
pub struct RecordedRows {
    /// One per vehicle, in the order of the scenario.
    pub tracks: Vec<RecordedTrack>,
    /// What the user should know of how the file was read.
    pub remarks: Vec<String>,
}

/// What the log of one vehicle gives.
#[derive(Clone, Debug, PartialEq)]
pub struct RecordedTrack {
    /// Positions, with or without velocities.
    pub motion: ImportedTrajectory,
    /// Where it was told to be; `None` if the log does not tell.
    pub setpoints: Option<Setpoints>,
}

/// Where a vehicle was told to be, linear in time between two of them.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Setpoints {
    /// Times, s, increasing.
    pub times_s: Vec<f64>,
    /// World frame, m; as many as times.
    pub positions_m: Vec<[f64; 3]>,
}

/// The columns of a flight log of a family whose plans have these columns.
pub(crate) const fn flight_columns(plan: &Columns) -> Columns {
    Columns { controls: &SETPOINT, ignored: &IGNORED, allows_discontinuity: false, gaps: Gaps::RefusedAlways, ..*plan }
}

/// Reads the log of a flight of `scenario` from a table: text (`.csv`, `.tsv`, `.txt`, `.tum`) or (with the feature `parquet`)
/// `.parquet`. Columns of controls are not used: they are commands, which an actuator need not have followed.
///
/// # Errors
///
/// The file cannot be read, its format is not supported, or its content is not a flight of `scenario`: a vehicle is missing,
/// times do not increase from 0, rows are missing, a number is not finite. All issues are reported together.
pub fn read_flight(path: &Path, scenario: &Scenario, map: &ColumnMap) -> Result<RecordedRows, PlanError> {
    let columns = columns_for(path, scenario)?;
    let document = read_table(path, scenario, columns, map)?;
    let document = document.ok_or_else(|| PlanError::FlightKind { path: path.to_owned() })?;
    finish(&path.display().to_string(), document, scenario, columns)
}

/// Like [`read_flight`], from the text of a table. `path` is its name in messages.
///
/// # Errors
///
/// The text is not a flight of `scenario`.
pub fn parse_flight_csv(path: &Path, text: &str, scenario: &Scenario) -> Result<RecordedRows, PlanError> {
    let columns = columns_for(path, scenario)?;
    let document = csv::read(text, scenario, columns, &ColumnMap::default());
    finish(&path.display().to_string(), document, scenario, columns)
}

/// Like [`read_flight`], from tables in memory. `path` is their name in messages.
///
/// # Errors
///
/// The tables are not a flight of `scenario`.
pub fn flight_from_tables(path: &Path, document: PlanDocument, scenario: &Scenario) -> Result<RecordedRows, PlanError> {
    let columns = columns_for(path, scenario)?;
    finish(&path.display().to_string(), Ok(document), scenario, columns)
}

fn columns_for(path: &Path, scenario: &Scenario) -> Result<&'static Columns, PlanError> {
    let family = scenario.family();
    family.spec().flight_columns.ok_or_else(|| PlanError::FlightFamily { path: path.to_owned(), family })
}

fn finish(
    name: &str,
    document: Result<PlanDocument, Vec<PlanIssue>>,
    scenario: &Scenario,
    columns: &Columns,
) -> Result<RecordedRows, PlanError> {
    let rows = document.and_then(|document| rows(document, scenario, columns));
    rows.map_err(|issues| PlanError::invalid(name, "flight", &scenario.name, issues))
}

fn rows(document: PlanDocument, scenario: &Scenario, columns: &Columns) -> Result<RecordedRows, Vec<PlanIssue>> {
    if let Some(curve) = document.curves.first() {
        let field = format!("curve of {}", curve.vehicle);
        let issue = Issue::new(field, "polynomial pieces", "samples: a flight is measured, not planned");
        return Err(vec![PlanIssue::new("", issue.remedy("`harness check --plan` judges a plan"))]);
    }
    let motions = check::trajectories(&document, scenario, columns)?;
    let setpoints = |index: usize| {
        let table = document.tables.iter().find(|table| table.vehicle == scenario.vehicles[index].name)?;
        let positions_m = table.triples(SETPOINT)?;
        Some(Setpoints { times_s: table.times_s.clone(), positions_m })
    };
    let track = |(index, motion)| RecordedTrack { motion, setpoints: setpoints(index) };
    let tracks = motions.into_iter().enumerate().map(track).collect();
    Ok(RecordedRows { tracks, remarks: document.header.remarks })
}
