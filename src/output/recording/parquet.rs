//! The whole flight log as a Parquet file, without rounding: for `harness diverge`, pandas, and other tools.
//!
//! One row per vehicle and step, in row groups of one vehicle each, so that only one group is in memory beside the flight.

use std::fs::File;
use std::ops::Range;
use std::path::Path;
use std::sync::Arc;

use parquet::data_type::{ByteArray, ByteArrayType, DoubleType};
use parquet::errors::ParquetError;
use parquet::file::metadata::KeyValue;
use parquet::file::properties::WriterProperties;
use parquet::file::reader::{FileReader, SerializedFileReader};
use parquet::file::writer::SerializedFileWriter;
use parquet::record::RowAccessor;
use parquet::schema::parser::parse_message_type;
use sim::{Flight, VehicleLog};

use super::{Recorder, Run};
use crate::error::Error;
use crate::output::flight_table::{columns, values};

/// Writes `flight.parquet`.
pub struct Parquet;

/// A flight log that was read from a file.
#[derive(Clone, Debug, PartialEq)]
pub struct Table {
    /// Name of the scenario.
    pub scenario: String,
    /// Names of the columns, the time first.
    pub columns: Vec<String>,
    /// One per vehicle.
    pub vehicles: Vec<VehicleTable>,
}

/// The rows of one vehicle.
#[derive(Clone, Debug, PartialEq)]
pub struct VehicleTable {
    /// Its name.
    pub vehicle: String,
    /// One row per step, in the order of time; one number per column.
    pub rows: Vec<Vec<f64>>,
}

/// Largest number of rows of a group: some megabytes.
const GROUP_ROWS: usize = 1 << 14;
/// Key of the scenario's name in the file's metadata.
const SCENARIO: &str = "scenario";
/// The column with the vehicle's name.
const VEHICLE: &str = "vehicle";

impl Recorder for Parquet {
    fn file_name(&self) -> &'static str {
        "flight.parquet"
    }

    fn write(&self, run: &Run<'_>, path: &Path) -> Result<(), Box<dyn std::error::Error + Send + Sync>> {
        let empty = Flight {
            step_s: 0.0,
            plan_end_s: 0.0,
            vehicles: Vec::new(),
            events: Vec::new(),
            planning: None,
            wall_s: 0.0,
        };
        write(&run.scenario.name, run.flight.unwrap_or(&empty), path)
    }
}

/// Writes the log of a flight to `path`.
///
/// # Errors
///
/// The file cannot be written.
pub fn write(scenario: &str, flight: &Flight, path: &Path) -> Result<(), Box<dyn std::error::Error + Send + Sync>> {
    let names = columns(flight);
    let fields: String = names.iter().map(|name| format!("required double {name};")).collect();
    let schema = format!("message flight {{ required binary {VEHICLE} (utf8); {fields} }}");
    let about = vec![KeyValue::new(SCENARIO.to_owned(), scenario.to_owned())];
    let properties = WriterProperties::builder().set_key_value_metadata(Some(about)).build();
    let schema = Arc::new(parse_message_type(&schema)?);
    let mut writer = SerializedFileWriter::new(File::create(path)?, schema, Arc::new(properties))?;
    for log in &flight.vehicles {
        for first in (0..log.samples.len()).step_by(GROUP_ROWS) {
            write_group(&mut writer, log, first..(first + GROUP_ROWS).min(log.samples.len()), names.len())?;
        }
    }
    writer.close()?;
    Ok(())
}

/// One group of rows of a vehicle.
fn write_group(
    writer: &mut SerializedFileWriter<File>,
    log: &VehicleLog,
    steps: Range<usize>,
    width: usize,
) -> Result<(), ParquetError> {
    let rows: Vec<Vec<f64>> = steps.map(|step| values(log, step, width)).collect();
    let mut group = writer.next_row_group()?;
    let mut index = 0;
    while let Some(mut column) = group.next_column()? {
        if index == 0 {
            let name = ByteArray::from(log.vehicle.as_str());
            column.typed::<ByteArrayType>().write_batch(&vec![name; rows.len()], None, None)?;
        } else {
            let numbers: Vec<f64> = rows.iter().map(|row| row[index - 1]).collect();
            column.typed::<DoubleType>().write_batch(&numbers, None, None)?;
        }
        column.close()?;
        index += 1;
    }
    group.close()?;
    Ok(())
}

/// Reads a log that [`write()`] wrote.
///
/// # Errors
///
/// [`Error::Results`] if the file cannot be read or is not such a log.
pub fn read(path: &Path) -> Result<Table, Error> {
    read_table(path).map_err(|reason| Error::results(path, reason.to_string()))
}

fn read_table(path: &Path) -> Result<Table, ParquetError> {
    let reader = SerializedFileReader::new(File::open(path)?)?;
    let file = reader.metadata().file_metadata();
    let about = file.key_value_metadata().into_iter().flatten().find(|pair| pair.key == SCENARIO);
    let scenario = about.and_then(|pair| pair.value.clone()).unwrap_or_default();
    let columns: Vec<String> =
        file.schema_descr().columns().iter().skip(1).map(|column| column.name().to_owned()).collect();
    let mut table = Table { scenario, columns, vehicles: Vec::new() };
    for row in reader.get_row_iter(None)? {
        let row = row?;
        let vehicle = row.get_string(0)?;
        if table.vehicles.last().is_none_or(|last| last.vehicle != *vehicle) {
            table.vehicles.push(VehicleTable { vehicle: vehicle.clone(), rows: Vec::new() });
        }
        let numbers = (0..table.columns.len()).map(|index| row.get_double(index + 1)).collect::<Result<_, _>>()?;
        if let Some(last) = table.vehicles.last_mut() {
            last.rows.push(numbers);
        }
    }
    Ok(table)
}
