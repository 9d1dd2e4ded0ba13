//! Text tables: a header with the names of the columns, then one line per vehicle and time.

use csv::StringRecord;

use super::columns::{Columns, TIME, VEHICLE};
use super::layout::Layout;
use super::names::{ColumnMap, Meaning};
use super::{PlanDocument, PlanIssue, RowLocations, polynomial};
use crate::{Issue, Scenario};

/// Reads the text. The column `vehicle` is optional if the scenario has a single vehicle.
///
/// - `known`: the columns of the kind of file
pub(super) fn read(
    text: &str,
    scenario: &Scenario,
    known: &'static Columns,
    map: &ColumnMap,
) -> Result<PlanDocument, Vec<PlanIssue>> {
    let layout = Layout::of(text)?;
    if polynomial::is_header(&layout.names) {
        return polynomial::read(&layout, scenario);
    }
    let header = Header::read(&layout, scenario, known, map)?;
    let mut document = PlanDocument::default();
    let mut issues = Vec::new();
    for record in layout.records() {
        match record {
            Ok((line, record)) => header.add(line, &record, &mut document, &mut issues),
            Err(error) => {
                issues.push(PlanIssue::new("", Issue::new("CSV syntax", error.to_string(), "valid CSV")));
                break;
            }
        }
    }
    if !issues.is_empty() {
        return Err(issues);
    }
    document.header.remarks = header.remarks();
    if layout.is_tum {
        from_first_time(&mut document);
    }
    Ok(document)
}

/// Measures the times of every table from its first one.
fn from_first_time(document: &mut PlanDocument) {
    for table in &mut document.tables {
        let Some(first_s) = table.times_s.first().copied().filter(|first_s| *first_s != 0.0) else { continue };
        table.times_s.iter_mut().for_each(|t_s| *t_s -= first_s);
        let remark = format!("times of {} counted from the first stamp of the TUM file, {first_s} s", table.vehicle);
        document.header.remarks.push(remark);
    }
}

/// The columns of the file.
struct Header {
    /// Names as the file gives them.
    theirs: Vec<String>,
    /// What they mean.
    columns: Vec<Meaning>,
    vehicle: Option<usize>,
    only_vehicle: Option<String>,
    known: &'static Columns,
}

impl Header {
    fn read(
        layout: &Layout,
        scenario: &Scenario,
        known: &'static Columns,
        map: &ColumnMap,
    ) -> Result<Self, Vec<PlanIssue>> {
        let place = format!(":{}", layout.header_line);
        let located = |issue: Issue| PlanIssue::new(place.clone(), issue);
        let theirs = layout.names.clone();
        let issue = |found: String, expected: &str, remedy: &str| {
            vec![located(Issue::new("header", found, expected).remedy(remedy))]
        };
        if let [line] = theirs.as_slice() {
            let expected = "a first line with the names of the columns: vehicle,t_s,x_m,y_m,z_m,...";
            return Err(issue(format!("\"{line}\""), expected, "`harness check --help` lists the columns"));
        }
        let is_twice = |index: usize| !theirs[index].is_empty() && theirs[..index].contains(&theirs[index]);
        if let Some(index) = (0..theirs.len()).find(|index| is_twice(*index)) {
            let found = format!("two columns named `{}`", theirs[index]);
            return Err(issue(found, "each name once", "rename or remove one of them"));
        }
        let missing: Vec<PlanIssue> = map.missing(&theirs).into_iter().map(located).collect();
        if !missing.is_empty() {
            return Err(missing);
        }
        let meanings: Result<Vec<Meaning>, Issue> = theirs.iter().map(|name| map.meaning(name, known)).collect();
        let columns = meanings.map_err(|issue| vec![located(issue)])?;
        if let Some((a, b)) = same_meaning(&columns) {
            let found = format!("`{}` and `{}`, which mean the same", theirs[a], theirs[b]);
            return Err(issue(
                found,
                "each quantity once",
                "name the one to use with --columns 'theirs=ours', or remove one",
            ));
        }
        let place_of = |wanted: &str| columns.iter().position(|column| is_column(column, wanted));
        let found = || format!("the columns {}", theirs.join(", "));
        if place_of(TIME).is_none() {
            let remedy = "name the file's own with --columns 'theirs[unit]=t_s'";
            return Err(issue(found(), "a column `t_s` with the time in s", remedy));
        }
        let only_vehicle = (scenario.vehicles.len() == 1).then(|| scenario.vehicles[0].name.clone());
        let vehicle = place_of(VEHICLE);
        if vehicle.is_none() && only_vehicle.is_none() {
            let expected = "a column `vehicle` with the vehicle's name: the scenario has several";
            return Err(issue(found(), expected, ""));
        }
        Ok(Self { vehicle, only_vehicle, known, columns, theirs })
    }

    /// What the user is told about the columns.
    fn remarks(&self) -> Vec<String> {
        let is_unused = |(name, column): &(&String, &Meaning)| **column == Meaning::Unused && !name.is_empty();
        let unused: Vec<&str> =
            self.theirs.iter().zip(&self.columns).filter(is_unused).map(|(name, _)| name.as_str()).collect();
        if unused.is_empty() { Vec::new() } else { vec![format!("columns not used: {}", unused.join(", "))] }
    }

    /// Adds a line to the table of its vehicle.
    fn add(&self, line: usize, record: &StringRecord, document: &mut PlanDocument, issues: &mut Vec<PlanIssue>) {
        let mut issue = |issue: Issue| issues.push(PlanIssue::new(format!(":{line}"), issue));
        if record.len() != self.columns.len() {
            let found = format!("{} values", record.len());
            issue(Issue::new("line", found, format!("{}, one per column", self.columns.len())));
            return;
        }
        let named = self.vehicle.map_or_else(|| self.only_vehicle.as_deref(), |index| record.get(index));
        let values = self.columns.iter().filter_map(|column| match column {
            Meaning::Column(name, _) if name != TIME && name != VEHICLE => Some(name.clone()),
            Meaning::Column(..) | Meaning::Unused => None,
        });
        let table = document.table_of(named.unwrap_or_default(), RowLocations::Lines(Vec::new()), values);
        for (index, (column, cell)) in self.columns.iter().zip(record).enumerate() {
            let Meaning::Column(name, factor) = column else { continue };
            if name == VEHICLE {
                continue;
            }
            let number = || cell.parse::<f64>().ok().map(|value| scaled(value, *factor));
            let value = self.known.word(name, cell).or_else(number).unwrap_or_else(|| {
                let found = if cell.is_empty() { "nothing".to_owned() } else { format!("\"{cell}\"") };
                issue(Issue::new(&self.theirs[index], found, self.known.expectation(name)));
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

/// The product; numbers in the format's own units stay as they are.
fn scaled(value: f64, factor: f64) -> f64 {
    if factor == 1.0 { value } else { value * factor }
}

fn is_column(column: &Meaning, wanted: &str) -> bool {
    matches!(column, Meaning::Column(name, _) if name == wanted)
}

/// Two columns of one meaning.
fn same_meaning(columns: &[Meaning]) -> Option<(usize, usize)> {
    columns.iter().enumerate().find_map(|(index, column)| {
        let Meaning::Column(name, _) = column else { return None };
        Some((columns[..index].iter().position(|other| is_column(other, name))?, index))
    })
}
