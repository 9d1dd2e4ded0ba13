//! Logs of ROS 2 and PX4 as plans and as flights: MCAP files, without ROS, and ULog.
//!
//! A message is decoded by the definition that the file carries. Position, velocity and time are where its type has them, or where
//! the user says (`--field`).

mod cdr;
mod mcap_file;
mod message;
mod ros2msg;
mod ulog;

use std::path::{Path, PathBuf};

use miette::Diagnostic;
use scenarios::Scenario;
use scenarios::plan_input::{ColumnTable, PlanDocument, RowLocations, Setpoints};
use thiserror::Error;

use message::Row;

/// What to read of a log.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Selection {
    /// Topics, each with the vehicle that it is of; without one, of the only vehicle.
    pub topics: Vec<Topic>,
    /// Topics of the setpoints, likewise.
    pub setpoints: Vec<Topic>,
    /// Names of quantities and the paths of their fields; empty: as the type of the message has them.
    pub fields: Vec<(String, String)>,
}

/// A topic, and the vehicle that it is of.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Topic {
    /// Name of the vehicle; `None`: the only one.
    pub vehicle: Option<String>,
    /// Name of the topic.
    pub name: String,
}

impl Topic {
    /// Reads `TOPIC` or `VEHICLE=TOPIC`.
    pub fn parse(text: &str) -> Self {
        match text.split_once('=') {
            Some((vehicle, name)) => Self { vehicle: Some(vehicle.trim().to_owned()), name: name.trim().to_owned() },
            None => Self { vehicle: None, name: text.trim().to_owned() },
        }
    }
}

/// Why a log cannot be read.
#[derive(Debug, Error, Diagnostic)]
pub enum LogError {
    /// The file cannot be read.
    #[error("{}: {reason}", path.display())]
    Read {
        /// The file.
        path: PathBuf,
        /// The error of the operating system.
        reason: std::io::Error,
    },
    /// The file is not a whole MCAP file.
    #[error("{}: found {reason}, expected a whole MCAP file", path.display())]
    #[diagnostic(help("`mcap recover` saves what a recorder that was stopped has written"))]
    NotMcap {
        /// The file.
        path: PathBuf,
        /// What is wrong.
        reason: String,
    },
    /// The file is a damaged ULog file.
    #[error("{}: found {reason}, expected a ULog file", path.display())]
    #[diagnostic(help("the log is damaged there: `ulog_info` of pyulog tells what is left of it"))]
    NotUlog {
        /// The file.
        path: PathBuf,
        /// What is wrong.
        reason: String,
    },
    /// The topic is missing, or none was named where there are several.
    #[error("{}: {found}, expected one of the topics: {topics}", path.display())]
    #[diagnostic(help("name it with `--topic TOPIC`, or `--topic VEHICLE=TOPIC` for every vehicle"))]
    NoTopic {
        /// The file.
        path: PathBuf,
        /// What was found.
        found: String,
        /// The topics of the file, with their types.
        topics: String,
    },
    /// A topic names no vehicle of the scenario, or there is none for a vehicle.
    #[error("--topic: found {found}, expected one topic for each of {vehicles}")]
    #[diagnostic(help("`--topic VEHICLE=TOPIC`, once per vehicle"))]
    NoVehicle {
        /// What was found.
        found: String,
        /// The vehicles of the scenario.
        vehicles: String,
    },
    /// The messages of a topic are not understood.
    #[error("{}: {topic}: found {found}, expected {expected}", path.display())]
    #[diagnostic(help("{remedy}"))]
    NotUnderstood {
        /// The file.
        path: PathBuf,
        /// The topic, and the number of the message from 1 where it is one of many.
        topic: String,
        /// What was found.
        found: String,
        /// What was expected.
        expected: String,
        /// How to correct it.
        remedy: String,
    },
    /// The logs of two vehicles do not begin together.
    #[error("{}: {vehicles} begin {apart_s} s apart, expected one first stamp for all vehicles", path.display())]
    #[diagnostic(help(
        "times count from the first stamp: cut or resample the log so that all vehicles have a sample then"
    ))]
    Apart {
        /// The file.
        path: PathBuf,
        /// Two vehicles.
        vehicles: String,
        /// Time between their first stamps, s.
        apart_s: f64,
    },
}

/// The error of messages that are not understood.
///
/// - `topic`: and the number of the message, where it is one of many
fn not_understood(path: &Path, topic: &str, found: &str, expected: &str, remedy: &str) -> LogError {
    let [topic, found, expected, remedy] = [topic, found, expected, remedy].map(str::to_owned);
    LogError::NotUnderstood { path: path.to_owned(), topic, found, expected, remedy }
}

/// What a log gives.
#[derive(Clone, Debug, PartialEq)]
pub struct Log {
    /// The tables of all vehicles.
    pub document: PlanDocument,
    /// The setpoints, in the order of the scenario's vehicles.
    pub setpoints: Vec<Option<Setpoints>>,
}

/// Reads a log. Times count from its first sample, which all vehicles must have.
///
/// # Errors
///
/// The file is not a log, a topic is missing, or its messages are not understood.
pub fn read(path: &Path, scenario: &Scenario, selection: &Selection) -> Result<Log, LogError> {
    let bytes = std::fs::read(path).map_err(|reason| LogError::Read { path: path.to_owned(), reason })?;
    parse(path, &bytes, scenario, selection)
}

/// Like [`read`], from the bytes of a file. `path` is its name in messages.
///
/// # Errors
///
/// As of [`read`].
pub fn parse(path: &Path, bytes: &[u8], scenario: &Scenario, selection: &Selection) -> Result<Log, LogError> {
    let read = |topic: Option<&str>, fields: &[(String, String)]| {
        if bytes.starts_with(&ulog::MAGIC) {
            ulog::File { path, bytes }.rows(topic, fields)
        } else {
            mcap_file::File { path, bytes }.rows(topic, fields)
        }
    };
    let topics = per_vehicle(scenario, &selection.topics)?;
    let mut remarks = Vec::new();
    let mut rows: Vec<Vec<Row>> = Vec::new();
    for topic in &topics {
        let found = read(topic.as_deref(), &selection.fields)?;
        remarks.extend(found.remarks);
        rows.push(found.rows);
    }
    let start_ns = common_start_ns(path, scenario, &rows)?;
    let (seconds, rest_ns) = (start_ns.div_euclid(1_000_000_000), start_ns.rem_euclid(1_000_000_000));
    remarks.push(format!("times count from the first stamp, {seconds}.{rest_ns:09} s"));
    let mut setpoints = vec![None; scenario.vehicles.len()];
    if !selection.setpoints.is_empty() {
        for (index, topic) in per_vehicle(scenario, &selection.setpoints)?.iter().enumerate() {
            let found = read(topic.as_deref(), &[])?;
            remarks.extend(found.remarks);
            let times_s = found.rows.iter().map(|row| seconds_since(start_ns, row)).collect();
            let positions_m = found.rows.iter().map(|row| row.position_m).collect();
            setpoints[index] = Some(Setpoints { times_s, positions_m });
        }
    }
    let tables = scenario.vehicles.iter().zip(&rows).map(|(vehicle, rows)| table(&vehicle.name, rows, start_ns));
    let mut document = PlanDocument { tables: tables.collect(), ..PlanDocument::default() };
    document.header.remarks = remarks;
    Ok(Log { document, setpoints })
}

/// The topic of every vehicle; `None`: the only one of the file that is understood.
fn per_vehicle(scenario: &Scenario, topics: &[Topic]) -> Result<Vec<Option<String>>, LogError> {
    let names: Vec<&str> = scenario.vehicles.iter().map(|vehicle| vehicle.name.as_str()).collect();
    let wrong = |found: String| LogError::NoVehicle { found, vehicles: names.join(", ") };
    let is_known = |topic: &&Topic| topic.vehicle.as_deref().is_none_or(|vehicle| names.contains(&vehicle));
    if let Some(stray) = topics.iter().find(|topic| !is_known(topic)) {
        return Err(wrong(format!("`{}`", stray.vehicle.as_deref().unwrap_or_default())));
    }
    if topics.len() > names.len() {
        return Err(wrong(format!("{} topics", topics.len())));
    }
    if let [_] = names.as_slice() {
        return Ok(vec![topics.first().map(|topic| topic.name.clone())]);
    }
    let of = |name: &&str| {
        let topic = topics.iter().find(|topic| topic.vehicle.as_deref() == Some(*name));
        topic.map(|topic| Some(topic.name.clone())).ok_or_else(|| wrong(format!("none for {name}")))
    };
    names.iter().map(of).collect()
}

fn common_start_ns(path: &Path, scenario: &Scenario, rows: &[Vec<Row>]) -> Result<i128, LogError> {
    let starts: Vec<i128> = rows.iter().map(|rows| rows.first().map_or(0, |row| row.t_ns)).collect();
    let start_ns = starts.iter().copied().min().unwrap_or(0);
    let Some(late) = starts.iter().position(|other| *other != start_ns) else { return Ok(start_ns) };
    let first = starts.iter().position(|other| *other == start_ns).unwrap_or(0);
    let vehicles = format!("{} and {}", scenario.vehicles[first].name, scenario.vehicles[late].name);
    Err(LogError::Apart {
        path: path.to_owned(),
        vehicles,
        apart_s: starts[late].saturating_sub(start_ns) as f64 * 1e-9,
    })
}

fn seconds_since(start_ns: i128, row: &Row) -> f64 {
    row.t_ns.saturating_sub(start_ns) as f64 * 1e-9
}

fn table(vehicle: &str, rows: &[Row], start_ns: i128) -> ColumnTable {
    let axis = |axis: usize| rows.iter().map(|row| row.position_m[axis]).collect();
    let mut columns: Vec<(&str, Vec<f64>)> = vec![("x_m", axis(0)), ("y_m", axis(1)), ("z_m", axis(2))];
    if rows.iter().all(|row| row.velocity_mps.is_some()) {
        let axis = |axis: usize| rows.iter().filter_map(|row| Some(row.velocity_mps?[axis])).collect();
        columns.extend([("vx_mps", axis(0)), ("vy_mps", axis(1)), ("vz_mps", axis(2))]);
    }
    ColumnTable {
        vehicle: vehicle.to_owned(),
        locations: RowLocations::Rows((1..=rows.len()).collect()),
        times_s: rows.iter().map(|row| seconds_since(start_ns, row)).collect(),
        columns: columns.into_iter().map(|(name, values)| (name.to_owned(), values)).collect(),
        planner_nodes: Vec::new(),
    }
}
