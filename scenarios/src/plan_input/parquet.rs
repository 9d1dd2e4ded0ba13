//! Parquet files: the columns of the CSV format, with numbers as numbers and names as text.

use std::collections::BTreeMap;
use std::fs::File;

use parquet::errors::ParquetError;
use parquet::file::reader::{FileReader, SerializedFileReader};
use parquet::record::{Field, Row};

use super::columns::{Columns, TIME, VEHICLE};
use super::names::{ColumnMap, Meaning};
use super::{PlanDocument, PlanIssue, RowLocations};
use crate::{Issue, Scenario};

/// Beginning of the name of the index that pandas adds.
const PANDAS_INDEX: &str = "__index_level";

/// Reads the file. The column `vehicle` is optional if the scenario has a single vehicle.
///
/// - `known`: the columns of the kind of file
pub(super) fn read(
    file: File,
    scenario: &Scenario,
    known: &Columns,
    map: &ColumnMap,
) -> Result<PlanDocument, Vec<PlanIssue>> {
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
    let names: Vec<String> = names.into_iter().map(str::to_owned).collect();
    let missing = map.missing(&names);
    let meanings: Result<Vec<Meaning>, Issue> = names.iter().map(|name| map.meaning(name, known)).collect();
    let meanings = meanings.map_err(|issue| vec![PlanIssue::new("", issue)])?;
    if !missing.is_empty() {
        return Err(missing.into_iter().map(|issue| PlanIssue::new("", issue)).collect());
    }
    let only_vehicle = (scenario.vehicles.len() == 1).then(|| scenario.vehicles[0].name.as_str());
    let mut document = PlanDocument::default();
    let mut issues = Vec::new();
    for (index, row) in reader.get_row_iter(None).map_err(broken)?.enumerate() {
        let row = row.map_err(broken)?;
        if let Err(issue) = add(&row, &meanings, index + 1, only_vehicle, known, &mut document) {
            issues.push(PlanIssue::new(format!(", row {}", index + 1), issue));
        }
    }
    let is_unused =
        |(name, meaning): &(&String, &Meaning)| **meaning == Meaning::Unused && !name.starts_with(PANDAS_INDEX);
    let unused: Vec<&str> = names.iter().zip(&meanings).filter(is_unused).map(|(name, _)| name.as_str()).collect();
    if !unused.is_empty() {
        document.header.remarks.push(format!("columns not used: {}", unused.join(", ")));
    }
    if issues.is_empty() { Ok(document) } else { Err(issues) }
}

/// Adds a row to the table of its vehicle.
fn add(
    row: &Row,
    meanings: &[Meaning],
    number: usize,
    only_vehicle: Option<&str>,
    known: &Columns,
    document: &mut PlanDocument,
) -> Result<(), Issue> {
    let mut vehicle = only_vehicle;
    let mut t_s = None;
    let mut values = BTreeMap::new();
    for ((theirs, field), meaning) in row.get_column_iter().zip(meanings) {
        let Meaning::Column(name, factor) = meaning else { continue };
        let number = match (name.as_str(), field) {
            (VEHICLE, Field::Str(text)) => {
                vehicle = Some(text);
                continue;
            }
            (VEHICLE, other) => return Err(Issue::new(VEHICLE, other.to_string(), "text")),
            (_, Field::Str(word)) => {
                let number = known.word(name, word);
                number.ok_or_else(|| Issue::new(theirs, format!("\"{word}\""), known.expectation(name)))?
            }
            (_, field) => number_in(theirs, field)?,
        };
        let number = if *factor == 1.0 { number } else { number * factor };
        let is_second =
            if name == TIME { t_s.replace(number).is_some() } else { values.insert(name.clone(), number).is_some() };
        if is_second {
            let remedy = "name the one to use with --columns 'theirs=ours', or remove one";
            return Err(
                Issue::new(theirs, format!("a second column for `{name}`"), "each quantity once").remedy(remedy)
            );
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
