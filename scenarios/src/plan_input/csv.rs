//! A table as text: a line with the names of the columns, then one line per vehicle and time, separated by commas.

use csv::{Reader, ReaderBuilder, StringRecord};

use super::columns::{Columns, TIME, VEHICLE};
use super::{ColumnTable, PlanDocument, PlanIssue, RowLocations};
use crate::{Issue, Scenario};

/// Separators that other programs write.
const OTHER_SEPARATORS: [(char, &str); 3] = [(';', "semicolons"), ('\t', "tabs"), (' ', "spaces")];

/// Reads the whole text. In a scenario with a single vehicle the column `vehicle` may be missing.
pub(super) fn read(text: &str, scenario: &Scenario) -> Result<PlanDocument, Vec<PlanIssue>> {
    let mut reader = ReaderBuilder::new().flexible(true).trim(csv::Trim::All).from_reader(text.as_bytes());
    let header = Header::read(&mut reader, scenario)?;
    let mut table = PlanDocument::default();
    let mut issues = Vec::new();
    let mut record = StringRecord::new();
    loop {
        match reader.read_record(&mut record) {
            Ok(false) => break,
            Ok(true) => header.add(&record, &mut table, &mut issues),
            Err(error) => {
                issues.push(PlanIssue::new("", Issue::new("CSV syntax", error.to_string(), "valid CSV")));
                break;
            }
        }
    }
    if issues.is_empty() { Ok(table) } else { Err(issues) }
}

/// Which column is what.
struct Header {
    names: Vec<String>,
    time: usize,
    vehicle: Option<usize>,
    only_vehicle: Option<String>,
    columns: &'static Columns,
}

impl Header {
    fn read(reader: &mut Reader<&[u8]>, scenario: &Scenario) -> Result<Self, Vec<PlanIssue>> {
        let issue = |found: String, expected: &str, remedy: &str| {
            vec![PlanIssue::new(":1", Issue::new("header", found, expected).remedy(remedy))]
        };
        let expected = "a first line with the names of the columns: vehicle,t_s,x_m,y_m,z_m,...";
        let names: Vec<String> = match reader.headers() {
            Ok(names) => names.iter().map(str::to_owned).collect(),
            Err(error) => return Err(issue(error.to_string(), expected, "")),
        };
        let mut names = names;
        if let Some(first) = names.first_mut() {
            // NumPy's savetxt puts this before a header.
            *first = first.trim_start_matches('#').trim_start().to_owned();
        }
        if let [line] = names.as_slice() {
            if let Some((_, what)) = OTHER_SEPARATORS.iter().find(|(separator, _)| line.contains(*separator)) {
                return Err(issue(format!("names separated by {what}"), "commas between them", "write commas"));
            }
            return Err(issue(format!("\"{line}\""), expected, "`harness check --help` lists the columns"));
        }
        if let Some(name) = names.iter().enumerate().find(|(i, name)| names[..*i].contains(name)).map(|(_, name)| name)
        {
            return Err(issue(format!("two columns named `{name}`"), "each name once", "rename or remove one of them"));
        }
        let place = |wanted: &str| names.iter().position(|name| name == wanted);
        let Some(time) = place(TIME) else {
            return Err(issue(format!("the columns {}", names.join(", ")), "a column `t_s` with the time in s", ""));
        };
        let only_vehicle = (scenario.vehicles.len() == 1).then(|| scenario.vehicles[0].name.clone());
        let vehicle = place(VEHICLE);
        if vehicle.is_none() && only_vehicle.is_none() {
            let expected = "a column `vehicle` with the vehicle's name: the scenario has several";
            return Err(issue(format!("the columns {}", names.join(", ")), expected, ""));
        }
        Ok(Self { time, vehicle, only_vehicle, columns: super::columns_of(scenario), names })
    }

    /// Adds one line to the track of its vehicle.
    fn add(&self, record: &StringRecord, table: &mut PlanDocument, issues: &mut Vec<PlanIssue>) {
        let line = record.position().map_or(0, |position| position.line() as usize);
        let mut issue = |issue: Issue| issues.push(PlanIssue::new(format!(":{line}"), issue));
        if record.len() != self.names.len() {
            let found = format!("{} values", record.len());
            issue(Issue::new("line", found, format!("{}, one per column", self.names.len())));
            return;
        }
        let named = self.vehicle.map_or_else(|| self.only_vehicle.as_deref(), |index| record.get(index));
        let track =
            track_of(table, named.unwrap_or_default(), &self.names, [self.time, self.vehicle.unwrap_or(self.time)]);
        for (index, (name, cell)) in self.names.iter().zip(record).enumerate() {
            if Some(index) == self.vehicle {
                continue;
            }
            let value = self.columns.word(name, cell).or_else(|| cell.parse().ok()).unwrap_or_else(|| {
                let found = if cell.is_empty() { "nothing".to_owned() } else { format!("\"{cell}\"") };
                issue(Issue::new(name, found, self.columns.expectation(name)));
                0.0
            });
            match track.columns.get_mut(name) {
                Some(column) => column.push(value),
                None => track.times_s.push(value),
            }
        }
        if let RowLocations::Lines(lines) = &mut track.places {
            lines.push(line);
        }
    }
}

/// The track of `vehicle`, new and empty if this is its first row.
///
/// - `apart`: columns that are not values of the track: time and vehicle
fn track_of<'t>(
    table: &'t mut PlanDocument,
    vehicle: &str,
    names: &[String],
    apart: [usize; 2],
) -> &'t mut ColumnTable {
    let index = table.tracks.iter().rposition(|track| track.vehicle == vehicle).unwrap_or_else(|| {
        let values = names.iter().enumerate().filter(|(index, _)| !apart.contains(index));
        let columns = values.map(|(_, name)| (name.clone(), Vec::new())).collect();
        table.tracks.push(ColumnTable {
            vehicle: vehicle.to_owned(),
            places: RowLocations::Lines(Vec::new()),
            times_s: Vec::new(),
            columns,
            planner_nodes: Vec::new(),
        });
        table.tracks.len() - 1
    });
    &mut table.tracks[index]
}
