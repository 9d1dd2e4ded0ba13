//! Parquet files: the columns of the CSV format, with numbers as numbers and names as text.

use std::collections::BTreeMap;
use std::fs::File;

use parquet::errors::ParquetError;
use parquet::file::reader::{FileReader, SerializedFileReader};
use parquet::record::{Field, Row};

use super::columns::{Columns, TIME, VEHICLE};
use super::{PlanDocument, PlanIssue, RowLocations};
use crate::{Issue, Scenario};

/// Reads the file. The column `vehicle` is optional if the scenario has a single vehicle.
pub(super) fn read(file: File, scenario: &Scenario) -> Result<PlanDocument, Vec<PlanIssue>> {
    let broken = |error: ParquetError| {
        let issue = Issue::new(
            "Parquet",
            error.to_string(),
            "a valid Parquet file, uncompressed or compressed with snappy or zstd",
        );
        vec![PlanIssue::new("", issue)]
    };
    let reader = SerializedFileReader::new(file).map_err(broken)?;
    let columns = reader.metadata().file_metadata().schema().get_fields();
    let names: Vec<&str> = columns.iter().map(|column| column.name()).collect();
    if let Some((_, twice)) = names.iter().enumerate().find(|(index, name)| names[..*index].contains(name)) {
        let issue = Issue::new("columns", format!("two columns named `{twice}`"), "each name once");
        return Err(vec![PlanIssue::new("", issue.remedy("rename or remove one of them"))]);
    }
    let only_vehicle = (scenario.vehicles.len() == 1).then(|| scenario.vehicles[0].name.as_str());
    let mut document = PlanDocument::default();
    let mut issues = Vec::new();
    for (index, row) in reader.get_row_iter(None).map_err(broken)?.enumerate() {
        let row = row.map_err(broken)?;
        if let Err(issue) = add(&row, index + 1, only_vehicle, super::columns_of(scenario), &mut document) {
            issues.push(PlanIssue::new(format!(", row {}", index + 1), issue));
        }
    }
    if issues.is_empty() { Ok(document) } else { Err(issues) }
}

/// Adds a row to the table of its vehicle.
fn add(
    row: &Row,
    number: usize,
    only_vehicle: Option<&str>,
    known: &Columns,
    document: &mut PlanDocument,
) -> Result<(), Issue> {
    let mut vehicle = only_vehicle;
    let mut t_s = None;
    let mut values = BTreeMap::new();
    for (name, field) in row.get_column_iter() {
        match (name.as_str(), field) {
            (VEHICLE, Field::Str(text)) => vehicle = Some(text),
            (VEHICLE, other) => return Err(Issue::new(VEHICLE, other.to_string(), "text")),
            (TIME, field) => t_s = Some(number_in(name, field)?),
            // The index that pandas adds.
            (name, _) if name.starts_with("__index_level") => {}
            (_, Field::Str(word)) => {
                let number = known.word(name, word);
                let number = number.ok_or_else(|| Issue::new(name, format!("\"{word}\""), known.expectation(name)))?;
                values.insert(name.clone(), number);
            }
            (_, field) => drop(values.insert(name.clone(), number_in(name, field)?)),
        }
    }
    let vehicle = vehicle.ok_or_else(|| Issue::new(VEHICLE, "nothing", "a column with the vehicle's name"))?;
    let t_s = t_s.ok_or_else(|| Issue::new(TIME, "nothing", "a column with the time in s"))?;
    let table = document.table_of(vehicle, RowLocations::Rows(Vec::new()), values.keys().cloned());
    table.times_s.push(t_s);
    for (name, value) in values {
        table.columns.entry(name).or_default().push(value);
    }
    if let RowLocations::Rows(rows) = &mut table.locations {
        rows.push(number);
    }
    Ok(())
}

/// The number in a field. A missing value becomes NaN, which is rejected later together with its location.
fn number_in(name: &str, field: &Field) -> Result<f64, Issue> {
    match field {
        Field::Null => Ok(f64::NAN),
        Field::Double(value) => Ok(*value),
        Field::Float(value) => Ok(f64::from(*value)),
        Field::Long(value) => Ok(*value as f64),
        Field::Int(value) => Ok(f64::from(*value)),
        other => Err(Issue::new(name, other.to_string(), "a column of numbers")),
    }
}
