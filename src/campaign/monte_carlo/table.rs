//! The samples of a sweep as a Parquet file, one row per sample.
//!
//! The file's metadata hold what the samples have in common, so that only partitions of one sweep can be merged.

use std::fs::File;
use std::path::Path;
use std::sync::Arc;

use parquet::data_type::{ByteArray, ByteArrayType, DataType, DoubleType, Int64Type};
use parquet::errors::ParquetError;
use parquet::file::metadata::KeyValue;
use parquet::file::properties::WriterProperties;
use parquet::file::reader::{FileReader, SerializedFileReader};
use parquet::file::writer::{SerializedFileWriter, SerializedRowGroupWriter};
use parquet::record::{Field, Row, RowAccessor};
use parquet::schema::parser::parse_message_type;

use super::{Perturbation, Sample, Sweep};
use crate::campaign::trial::has_several_quantities;
use crate::error::Error;
use crate::output;
use crate::verdict::Outcome;

/// Key of the sweep in the file's metadata.
const SWEEP: &str = "sweep";
/// Types and names of the columns before those of the margins.
const COLUMNS: [&str; 10] = [
    "int64 sample",
    "int64 seed",
    "binary verdict (utf8)",
    "binary red (utf8)",
    "double wind_east_mps",
    "double wind_north_mps",
    "double mass_ratio",
    "double load_mass_ratio",
    "double position_noise_m",
    "double start_radius_m",
];
/// Verdicts and their names in the table.
const VERDICTS: [(&str, Outcome); 3] = [("pass", Outcome::Pass), ("fail", Outcome::Fail), ("no-plan", Outcome::NoPlan)];
/// Separator of the names of failed checks.
const LIST_SEPARATOR: &str = ", ";

/// Writes the samples of a sweep, all or nothing.
///
/// # Errors
///
/// [`Error::Write`] if the table cannot be written.
pub fn write(sweep: &Sweep, samples: &[Sample], path: &Path) -> Result<(), Error> {
    output::replace_file(path, |partial| Ok(write_table(sweep, samples, partial)?))
}

fn write_table(sweep: &Sweep, samples: &[Sample], path: &Path) -> Result<(), ParquetError> {
    let sweep_json = serde_json::to_string(sweep).map_err(|reason| ParquetError::External(reason.into()))?;
    let metadata = vec![KeyValue::new(SWEEP.to_owned(), sweep_json)];
    let properties = WriterProperties::builder().set_key_value_metadata(Some(metadata)).build();
    let schema = Arc::new(parse_message_type(&schema(sweep))?);
    let mut writer = SerializedFileWriter::new(File::create(path)?, schema, Arc::new(properties))?;
    let mut group = writer.next_row_group()?;
    let perturbations = || samples.iter().map(|sample| &sample.perturbation);
    column::<Int64Type>(&mut group, samples.iter().map(|sample| sample.number as i64))?;
    column::<Int64Type>(&mut group, perturbations().map(|perturbation| perturbation.seed.cast_signed()))?;
    column::<ByteArrayType>(&mut group, samples.iter().map(|sample| name_of(sample.verdict).into()))?;
    column::<ByteArrayType>(
        &mut group,
        samples.iter().map(|sample| ByteArray::from(sample.failed_checks.join(LIST_SEPARATOR).into_bytes())),
    )?;
    column::<DoubleType>(&mut group, perturbations().map(|perturbation| perturbation.wind_mps[0]))?;
    column::<DoubleType>(&mut group, perturbations().map(|perturbation| perturbation.wind_mps[1]))?;
    column::<DoubleType>(&mut group, perturbations().map(|perturbation| perturbation.mass_ratios[0]))?;
    column::<DoubleType>(&mut group, perturbations().map(|perturbation| perturbation.mass_ratios[1]))?;
    column::<DoubleType>(&mut group, perturbations().map(|perturbation| perturbation.noise_m))?;
    column::<DoubleType>(&mut group, perturbations().map(|perturbation| perturbation.start_m))?;
    for index in 0..sweep.checks.len() {
        optional_column(&mut group, samples.iter().map(|sample| sample.margins[index]))?;
        if has_several_quantities(&sweep.checks[index].0) {
            column::<ByteArrayType>(&mut group, samples.iter().map(|sample| sample.units[index].as_str().into()))?;
        }
    }
    group.close()?;
    writer.close()?;
    Ok(())
}

fn column<T: DataType>(
    group: &mut SerializedRowGroupWriter<'_, File>,
    values: impl Iterator<Item = T::T>,
) -> Result<(), ParquetError> {
    let mut column = group.next_column()?.expect("the schema has as many columns as are written");
    column.typed::<T>().write_batch(&values.collect::<Vec<_>>(), None, None)?;
    column.close()
}

/// NaN is written as null.
fn optional_column(
    group: &mut SerializedRowGroupWriter<'_, File>,
    values: impl Iterator<Item = f64>,
) -> Result<(), ParquetError> {
    let mut column = group.next_column()?.expect("the schema has as many columns as are written");
    let (mut present, mut levels) = (Vec::new(), Vec::new());
    for value in values {
        levels.push(i16::from(!value.is_nan()));
        present.extend(Some(value).filter(|value| !value.is_nan()));
    }
    column.typed::<DoubleType>().write_batch(&present, Some(&levels), None)?;
    column.close()
}

fn schema(sweep: &Sweep) -> String {
    let margins = sweep.checks.iter().flat_map(|(check, unit)| {
        let margin = format!("optional double {};", margin_column(check, unit));
        let unit = has_several_quantities(check).then(|| format!("required binary {} (utf8);", unit_column(check)));
        [Some(margin), unit].into_iter().flatten()
    });
    let fields: String = COLUMNS.iter().map(|column| format!("required {column};")).chain(margins).collect();
    format!("message sweep {{ {fields} }}")
}

/// `separation_margin_m` for `flight.separation` in m.
fn margin_column(check: &str, unit: &str) -> String {
    let name = check.split_once('.').map_or(check, |(_, name)| name);
    let unit: String = unit.replace('/', "p").chars().filter(char::is_ascii_alphanumeric).collect();
    let unit = if unit.is_empty() { unit } else { format!("_{unit}") };
    format!("{name}_margin{unit}")
}

/// `state_limits_margin_unit` for `flight.state_limits`.
fn unit_column(check: &str) -> String {
    format!("{}_unit", margin_column(check, ""))
}

fn name_of(verdict: Outcome) -> &'static str {
    VERDICTS.iter().find(|(_, outcome)| *outcome == verdict).map_or("fail", |(name, _)| name)
}

/// Reads a table that [`write()`] wrote.
///
/// # Errors
///
/// [`Error::Samples`] if the file cannot be read or is not such a table.
pub fn read(path: &Path) -> Result<(Sweep, Vec<Sample>), Error> {
    read_table(path).map_err(|reason| Error::Samples { path: path.to_owned(), reason: reason.to_string() })
}

fn read_table(path: &Path) -> Result<(Sweep, Vec<Sample>), ParquetError> {
    let reader = SerializedFileReader::new(File::open(path)?)?;
    let metadata = reader.metadata().file_metadata().key_value_metadata();
    let sweep_json = metadata.into_iter().flatten().find(|pair| pair.key == SWEEP).and_then(|pair| pair.value.clone());
    let sweep_json =
        sweep_json.ok_or_else(|| ParquetError::General("the file is not a table of `harness sweep`".to_owned()))?;
    let sweep: Sweep = serde_json::from_str(&sweep_json).map_err(|reason| ParquetError::External(reason.into()))?;
    let samples = reader.get_row_iter(None)?.map(|row| sample(&row?, &sweep.checks)).collect::<Result<_, _>>()?;
    Ok((sweep, samples))
}

fn is_null(row: &Row, column: usize) -> bool {
    row.get_column_iter().nth(column).is_some_and(|(_, field)| matches!(field, Field::Null))
}

fn sample(row: &Row, checks: &[(String, String)]) -> Result<Sample, ParquetError> {
    let (mut margins, mut units, mut column) = (Vec::new(), Vec::new(), COLUMNS.len());
    for (check, unit) in checks {
        margins.push(if is_null(row, column) { f64::NAN } else { row.get_double(column)? });
        column += 1;
        if has_several_quantities(check) {
            units.push(row.get_string(column)?.clone());
            column += 1;
        } else {
            units.push(unit.clone());
        }
    }
    let verdict = row.get_string(2)?;
    let outcome = VERDICTS.iter().find(|(name, _)| name == verdict).map(|(_, outcome)| *outcome);
    Ok(Sample {
        number: usize::try_from(row.get_long(0)?).map_err(|reason| ParquetError::External(reason.into()))?,
        perturbation: Perturbation {
            seed: row.get_long(1)?.cast_unsigned(),
            wind_mps: [row.get_double(4)?, row.get_double(5)?],
            mass_ratios: [row.get_double(6)?, row.get_double(7)?],
            noise_m: row.get_double(8)?,
            start_m: row.get_double(9)?,
        },
        verdict: outcome.ok_or_else(|| ParquetError::General(format!("unknown verdict `{verdict}`")))?,
        failed_checks: row
            .get_string(3)?
            .split(LIST_SEPARATOR)
            .filter(|name| !name.is_empty())
            .map(str::to_owned)
            .collect(),
        margins,
        units,
    })
}
