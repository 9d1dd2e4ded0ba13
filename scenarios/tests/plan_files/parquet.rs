//! Parquet files.

use std::path::Path;
use std::sync::Arc;

use parquet::data_type::{ByteArray, ByteArrayType, DoubleType};
use parquet::file::writer::SerializedFileWriter;
use parquet::schema::parser::parse_message_type;
use scenarios::plan_input::read;

use super::{complete, fixed_wings, scenario, trajectories};

/// Writes the rows of a CSV text as a Parquet file: names as text, numbers as doubles.
fn write(path: &Path, text: &str) {
    let columns: Vec<&str> = text.lines().next().unwrap().split(',').collect();
    let kind = |name: &&str| match **name == *"vehicle" {
        true => "required binary vehicle (utf8);".to_owned(),
        false => format!("required double {name};"),
    };
    let schema = format!("message plan {{ {} }}", columns.iter().map(kind).collect::<String>());
    let schema = Arc::new(parse_message_type(&schema).unwrap());
    let file = std::fs::File::create(path).unwrap();
    let mut writer = SerializedFileWriter::new(file, schema, Arc::default()).unwrap();
    let mut group = writer.next_row_group().unwrap();
    for (index, name) in columns.iter().enumerate() {
        let cells = || text.lines().skip(1).map(|line| line.split(',').nth(index).unwrap());
        let mut column = group.next_column().unwrap().unwrap();
        if *name == "vehicle" {
            let names: Vec<ByteArray> = cells().map(ByteArray::from).collect();
            column.typed::<ByteArrayType>().write_batch(&names, None, None).unwrap();
        } else {
            let numbers: Vec<f64> = cells().map(|cell| cell.parse().unwrap()).collect();
            column.typed::<DoubleType>().write_batch(&numbers, None, None).unwrap();
        }
        column.close().unwrap();
    }
    group.close().unwrap();
    writer.close().unwrap();
}

#[test]
fn parquet_and_csv_are_read_alike() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("plan.parquet");
    write(&path, &complete());
    assert_eq!(fixed_wings(read(&path, &scenario()).unwrap().1), trajectories(&complete()));
}

#[test]
fn issues_are_located_by_row() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("plan.parquet");
    write(&path, &complete().replace("uav-2,7,245,", "uav-2,7,nan,"));
    let lines = read(&path, &scenario()).unwrap_err().lines();
    assert_eq!(lines.len(), 1, "{lines:#?}");
    assert!(lines[0].contains("plan.parquet, row 38: x_m of uav-2: found NaN"), "{lines:#?}");
}

#[test]
fn two_columns_of_one_name_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("plan.parquet");
    let whole = complete();
    let doubled = whole.lines().enumerate().map(|(line, text)| {
        let x_m = if line == 0 { "x_m" } else { "7" };
        format!("{text},{x_m}")
    });
    write(&path, &doubled.collect::<Vec<_>>().join("\n"));
    let lines = read(&path, &scenario()).unwrap_err().lines();
    assert!(lines.len() == 1 && lines[0].contains("two columns named `x_m`"), "{lines:#?}");
}

/// Changed bytes and truncation never cause a panic, and what is accepted is finite.
#[test]
fn damaged_files_are_rejected_or_valid() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("plan.parquet");
    write(&path, &complete());
    let sound = std::fs::read(&path).unwrap();
    let mut rng = scenarios::stream(0, "damage");
    let mut below = |n: usize| (rand::Rng::next_u64(&mut rng) % n as u64) as usize;
    let mut rejected = 0;
    for round in 0..600 {
        let mut bytes = sound.clone();
        for _ in 0..=below(6) {
            let at = below(bytes.len());
            bytes[at] = below(256) as u8;
        }
        if round % 5 == 0 {
            bytes.truncate(below(sound.len()));
        }
        std::fs::write(&path, bytes).unwrap();
        match read(&path, &scenario()) {
            Err(error) => rejected += usize::from(!error.lines().is_empty()),
            Ok((_, trajectories)) => {
                let trajectories = fixed_wings(trajectories);
                assert!(trajectories.iter().flat_map(|trajectory| &trajectory.times_s).all(|t_s| t_s.is_finite()));
            }
        }
    }
    assert!(rejected > 200, "only {rejected} of 600 were rejected");
}
