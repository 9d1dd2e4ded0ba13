use std::path::Path;

use clap::Args;
use scenarios::Scenario;
use scenarios::plan_input::names::ColumnMap;
use scenarios::plan_input::{self, ImportedTrajectory, PlanHeader, RecordedRows};

use crate::error::Error;
#[cfg(feature = "mcap")]
use crate::plan_source::logs::{self, Selection, Topic};

/// What to read of a log of ROS 2 or PX4.
#[derive(Args, Debug)]
pub struct LogOptions {
    /// Topic of an MCAP or ULog file; of several vehicles VEHICLE=TOPIC, once for each [default: the only one of a known type]
    #[arg(long, value_name = "[VEHICLE=]TOPIC")]
    topic: Vec<String>,
    /// Field of the messages, of types that are not known: t (in s; t[ms], t[us], t[ns]), x, y, z, vx, vy or vz; a minus sign
    /// before the path turns an axis around
    #[arg(long, value_name = "NAME=PATH", value_parser = field)]
    field: Vec<(String, String)>,
}

fn field(text: &str) -> Result<(String, String), String> {
    let (name, path) = text.split_once('=').ok_or("expected NAME=PATH, as in x=pose.pose.position.x")?;
    Ok((name.trim().to_owned(), path.trim().to_owned()))
}

/// Whether a file is a log of ROS 2 or PX4.
fn is_log(path: &Path) -> bool {
    path.extension().is_some_and(|extension| extension == "mcap" || extension == "ulg")
}

impl LogOptions {
    /// Reads a plan from a table, a JSON file or a log.
    pub fn read_plan(
        &self,
        path: &Path,
        scenario: &Scenario,
        columns: &ColumnMap,
    ) -> Result<(PlanHeader, Vec<ImportedTrajectory>), Error> {
        if is_log(path) {
            return self.read_logged_plan(path, scenario);
        }
        Ok(plan_input::read_with(path, scenario, columns)?)
    }

    /// Reads a flight from a table or a log.
    ///
    /// - `setpoints`: topics of the setpoints
    pub fn read_flight(
        &self,
        path: &Path,
        scenario: &Scenario,
        columns: &ColumnMap,
        setpoints: &[String],
    ) -> Result<RecordedRows, Error> {
        if is_log(path) {
            return self.read_logged_flight(path, scenario, setpoints);
        }
        Ok(plan_input::read_flight(path, scenario, columns)?)
    }

    #[cfg(feature = "mcap")]
    fn selection(&self, setpoints: &[String]) -> Selection {
        let topics = |texts: &[String]| texts.iter().map(|text| Topic::parse(text)).collect();
        Selection { topics: topics(&self.topic), setpoints: topics(setpoints), fields: self.field.clone() }
    }

    #[cfg(feature = "mcap")]
    fn read_logged_plan(
        &self,
        path: &Path,
        scenario: &Scenario,
    ) -> Result<(PlanHeader, Vec<ImportedTrajectory>), Error> {
        let log = logs::read(path, scenario, &self.selection(&[]))?;
        Ok(plan_input::from_tables(&path.display().to_string(), log.document, scenario)?)
    }

    #[cfg(feature = "mcap")]
    fn read_logged_flight(
        &self,
        path: &Path,
        scenario: &Scenario,
        setpoints: &[String],
    ) -> Result<RecordedRows, Error> {
        let log = logs::read(path, scenario, &self.selection(setpoints))?;
        let mut rows = plan_input::flight_from_tables(path, log.document, scenario)?;
        for (track, setpoints) in rows.tracks.iter_mut().zip(log.setpoints) {
            track.setpoints = setpoints;
        }
        Ok(rows)
    }

    #[cfg(not(feature = "mcap"))]
    fn read_logged_plan(&self, path: &Path, _: &Scenario) -> Result<(PlanHeader, Vec<ImportedTrajectory>), Error> {
        Err(Error::McapNotBuilt { path: path.to_owned() })
    }

    #[cfg(not(feature = "mcap"))]
    fn read_logged_flight(&self, path: &Path, _: &Scenario, _: &[String]) -> Result<RecordedRows, Error> {
        Err(Error::McapNotBuilt { path: path.to_owned() })
    }
}
