//! CSV files: a header with the names of the columns, then one line per vehicle and time.

use csv::{Reader, ReaderBuilder, StringRecord};

use super::columns::{Columns, TIME, VEHICLE};
use super::{PlanDocument, PlanIssue, RowLocations};
use crate::{Issue, Scenario};

/// Separators that are recognised in order to suggest commas.
const OTHER_SEPARATORS: [(char, &str); 3] = [(';', "semicolons"), ('\t', "tabs"), (' ', "spaces")];

/// Reads the text. The column `vehicle` is optional if the scenario has a single vehicle.
pub(super) fn read(text: &str, scenario: &Scenario) -> Result<PlanDocument, Vec<PlanIssue>> {
    let mut reader = ReaderBuilder::new().flexible(true).trim(csv::Trim::All).from_reader(text.as_bytes());
    let header = Header::read(&mut reader, scenario)?;
    let mut document = PlanDocument::default();
    let mut issues = Vec::new();
    let mut record = StringRecord::new();
    loop {
        match reader.read_record(&mut record) {
            Ok(false) => break,
            Ok(true) => header.add(&record, &mut document, &mut issues),
            Err(error) => {
                issues.push(PlanIssue::new("", Issue::new("CSV syntax", error.to_string(), "valid CSV")));
                break;
            }
        }
    }
    if issues.is_empty() { Ok(document) } else { Err(issues) }
}

/// The columns of the file.
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

    /// Adds a line to the table of its vehicle.
    fn add(&self, record: &StringRecord, document: &mut PlanDocument, issues: &mut Vec<PlanIssue>) {
        let line = record.position().map_or(0, |position| position.line() as usize);
        let mut issue = |issue: Issue| issues.push(PlanIssue::new(format!(":{line}"), issue));
        if record.len() != self.names.len() {
            let found = format!("{} values", record.len());
            issue(Issue::new("line", found, format!("{}, one per column", self.names.len())));
            return;
        }
        let named = self.vehicle.map_or_else(|| self.only_vehicle.as_deref(), |index| record.get(index));
        let is_value = |index: &usize| *index != self.time && Some(*index) != self.vehicle;
        let values = self.names.iter().enumerate().filter(|(index, _)| is_value(index)).map(|(_, name)| name.clone());
        let table = document.table_of(named.unwrap_or_default(), RowLocations::Lines(Vec::new()), values);
        for (index, (name, cell)) in self.names.iter().zip(record).enumerate() {
            if Some(index) == self.vehicle {
                continue;
            }
            let value = self.columns.word(name, cell).or_else(|| cell.parse().ok()).unwrap_or_else(|| {
                let found = if cell.is_empty() { "nothing".to_owned() } else { format!("\"{cell}\"") };
                issue(Issue::new(name, found, self.columns.expectation(name)));
                0.0
            });
            match table.columns.get_mut(name) {
                Some(column) => column.push(value),
                None => table.times_s.push(value),
            }
        }
        if let RowLocations::Lines(lines) = &mut table.locations {
            lines.push(line);
        }
    }
}
