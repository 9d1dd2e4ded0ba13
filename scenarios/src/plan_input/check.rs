//! Checks of a plan file against its scenario. Whether the motion can be flown is left to the judge.

use std::cmp::Ordering;

use super::columns::{Columns, Gaps};
use super::{ColumnTable, ImportedTrajectory, PlanDocument, PlanIssue, RowLocations, units};
use crate::curve::Curve;
use crate::{Issue, PlanStatus, Scenario, Vehicle, closest_name};

/// Tolerance of the first time, which must be 0, s.
const TIME_TOLERANCE_S: f64 = 1e-9;
/// Times beyond these are stamps since 1970, in s and in ns: the year 2001.
const EPOCH_S: f64 = 1e9;
const EPOCH_NS: f64 = 1e18;
/// Maximum interval, in median intervals of the table; a longer one is a gap.
const MAX_INTERVALS: f64 = 20.0;
/// Maximum end time, in maximum durations of the simulation; a longer plan is in another unit.
const MAX_DURATIONS: f64 = 10.0;

/// One trajectory per vehicle, in the order of the scenario, or all issues.
///
/// - `columns`: those of the kind of file
pub(super) fn trajectories(
    document: &PlanDocument,
    scenario: &Scenario,
    columns: &Columns,
) -> Result<Vec<ImportedTrajectory>, Vec<PlanIssue>> {
    let mut issues: Vec<PlanIssue> = other_scenario(document, scenario).into_iter().collect();
    if document.header.status == Some(PlanStatus::NoPlan) && document.tables.is_empty() && document.curves.is_empty() {
        return if issues.is_empty() { Ok(Vec::new()) } else { Err(issues) };
    }
    issues.extend(surplus(document, scenario));
    let mut trajectories = Vec::with_capacity(scenario.vehicles.len());
    for vehicle in &scenario.vehicles {
        let table = document.tables.iter().find(|table| table.vehicle == vehicle.name);
        let curve = document.curves.iter().find(|curve| curve.vehicle == vehicle.name);
        let trajectory = match (table, curve) {
            (Some(table), _) => trajectory(table, vehicle, scenario, columns),
            (None, Some(curve)) => of_curve(curve, vehicle, scenario),
            (None, None) => Err(vec![missing(vehicle)]),
        };
        match trajectory {
            Ok(trajectory) => trajectories.push(trajectory),
            Err(found) => issues.extend(found),
        }
    }
    if issues.is_empty() { Ok(trajectories) } else { Err(issues) }
}

fn other_scenario(document: &PlanDocument, scenario: &Scenario) -> Option<PlanIssue> {
    let named = document.header.scenario.as_ref().filter(|named| **named != scenario.name)?;
    let expected = format!("\"{}\", the scenario to check it against", scenario.name);
    Some(PlanIssue::new("", Issue::new("scenario", format!("\"{named}\""), expected).remedy("is it the right file?")))
}

/// Tables of unknown vehicles, and second tables of known ones.
fn surplus(document: &PlanDocument, scenario: &Scenario) -> Vec<PlanIssue> {
    let names: Vec<&str> = scenario.vehicles.iter().map(|vehicle| vehicle.name.as_str()).collect();
    let mut issues = Vec::new();
    let tables = document.tables.iter().map(|table| (table.vehicle.as_str(), table.locations.of(0)));
    let curves = document.curves.iter().map(|curve| (curve.vehicle.as_str(), String::new()));
    let given: Vec<(&str, String)> = tables.chain(curves).collect();
    for (index, (vehicle, place)) in given.iter().enumerate() {
        let found = format!("\"{vehicle}\"");
        if given[..index].iter().any(|(other, _)| other == vehicle) {
            let issue = Issue::new("vehicle", found, "one trajectory per vehicle");
            issues.push(PlanIssue::new(place, issue));
        } else if !names.contains(vehicle) {
            let is_missing = |name: &&str| given.iter().all(|(vehicle, _)| vehicle != name);
            let remedy = closest_name(vehicle, names.iter().copied().filter(is_missing));
            let remedy = remedy.map_or_else(String::new, |name| format!("did you mean \"{name}\"?"));
            let expected = format!("a vehicle of the scenario: {}", names.join(", "));
            issues.push(PlanIssue::new(place, Issue::new("vehicle", found, expected).remedy(remedy)));
        }
    }
    issues
}

fn missing(vehicle: &Vehicle) -> PlanIssue {
    let issue = Issue::new("vehicle", format!("no row of `{}`", vehicle.name), "every vehicle of the scenario");
    PlanIssue::new("", issue.remedy("a plan is judged as a whole: include all vehicles"))
}

/// The trajectory in one table. Each group of rules assumes that the previous ones hold.
fn trajectory(
    table: &ColumnTable,
    vehicle: &Vehicle,
    scenario: &Scenario,
    columns: &Columns,
) -> Result<ImportedTrajectory, Vec<PlanIssue>> {
    let table = &from_time_zero(table);
    let mut issues = column_issues(table, columns);
    issues.extend(too_short(table));
    if issues.is_empty() {
        issues.extend(not_finite(table));
    }
    if issues.is_empty() {
        let max_end_s = MAX_DURATIONS * scenario.simulation.max_duration_s;
        issues.extend(time_issue(table, columns).or_else(|| too_long(table, max_end_s)));
    }
    if !issues.is_empty() {
        return Err(issues);
    }
    let trajectory = (scenario.family().spec().import)(&converted(table, columns));
    let suspicions = units::suspicions(&trajectory, vehicle);
    let located = |(row, issue)| PlanIssue::new(table.locations.of(row), issue);
    if suspicions.is_empty() { Ok(trajectory) } else { Err(suspicions.into_iter().map(located).collect()) }
}

/// A curve, of a vehicle whose motion it determines.
fn of_curve(curve: &Curve, vehicle: &Vehicle, scenario: &Scenario) -> Result<ImportedTrajectory, Vec<PlanIssue>> {
    let issue = |found: String, expected: String, remedy: &str| {
        let field = format!("curve of {}", curve.vehicle);
        Err(vec![PlanIssue::new("", Issue::new(field, found, expected).remedy(remedy))])
    };
    let max_end_s = MAX_DURATIONS * scenario.simulation.max_duration_s;
    if scenario.family().carries_load() {
        let remedy = "give the states and controls in a table";
        return issue("polynomial pieces".into(), "the motion of quadrotor and load".into(), remedy);
    }
    if curve.pieces.iter().flat_map(|piece| &piece.points_m).flatten().any(|value| !value.is_finite()) {
        return issue("a number that is not finite".into(), "finite numbers".into(), "");
    }
    let [begin_s, end_s] = [curve.pieces.first().map_or(f64::NAN, |piece| piece.t_s[0]), curve.end_s()];
    if begin_s.abs() > TIME_TOLERANCE_S || begin_s.is_nan() {
        return issue(
            format!("{begin_s} s at the beginning"),
            "0 s".into(),
            "measure the time from the start of the scenario",
        );
    }
    if end_s > max_end_s {
        let expected = format!("at most {max_end_s} s, ten times simulation.max_duration_s");
        return issue(format!("{end_s} s at the end"), expected, "are the durations in milliseconds?");
    }
    if !scenario.family().hovers()
        && let Some(jump) = curve.joints().find(|joint| !joint.is_rounding)
    {
        let found = format!("a jump by {} m and {} m/s at {} s", jump.position_m, jump.velocity_mps, jump.t_s);
        return issue(found, "pieces that continue each other in position and velocity".into(), "");
    }
    let trajectory = ImportedTrajectory::Curve(curve.clone());
    let suspicions = units::suspicions(&trajectory, vehicle);
    let located = |(_, issue)| PlanIssue::new("", issue);
    if suspicions.is_empty() { Ok(trajectory) } else { Err(suspicions.into_iter().map(located).collect()) }
}

/// The table with a first time that is 0 but for rounding set to 0.
fn from_time_zero(table: &ColumnTable) -> ColumnTable {
    let mut table = table.clone();
    if let Some(first_s) = table.times_s.first_mut().filter(|first_s| first_s.abs() <= TIME_TOLERANCE_S) {
        *first_s = 0.0;
    }
    table
}

fn column_issues(table: &ColumnTable, columns: &Columns) -> Vec<PlanIssue> {
    let header = if matches!(table.locations, RowLocations::Trajectory(_)) { "" } else { ":1" };
    let issue = |issue: Issue| PlanIssue::new(header, of_vehicle(table, issue));
    let known = columns.names();
    let mut issues = Vec::new();
    for name in table.columns.keys().filter(|name| !known.contains(&name.as_str())) {
        let remedy = closest_name(name, known.iter().copied());
        let remedy = remedy.map_or_else(|| "remove or rename it".into(), |known| format!("did you mean `{known}`?"));
        let expected = format!("one of {} for the family {}", known.join(", "), columns.family.key());
        issues.push(issue(Issue::new(name, "an unknown column", expected).remedy(remedy)));
    }
    let meant: Vec<&str> = table.columns.keys().map(|name| columns.meaning(name).0).collect();
    for name in columns.required.iter().filter(|name| !meant.contains(name)) {
        issues.push(issue(Issue::new(*name, "nothing", "a column of this name")));
    }
    for (index, name) in meant.iter().enumerate().filter(|(index, name)| meant[..*index].contains(name)) {
        let found = format!("the column `{name}` twice, in different units");
        issues.push(issue(Issue::new(meant[index], found, "one of them")));
    }
    let is_given = |form: &[&str]| form.iter().any(|name| meant.contains(name));
    for form in columns.velocity.iter().copied().chain([columns.controls]).filter(|form| is_given(form)) {
        for name in form.iter().filter(|name| !meant.contains(name)) {
            let expected = format!("{} together, or none of them", form.join(", "));
            issues.push(issue(Issue::new(*name, "nothing", expected)));
        }
    }
    if columns.velocity.iter().filter(|form| is_given(form)).count() > 1 {
        let found = "the velocity in two forms";
        issues.push(issue(Issue::new("velocity", found, "one of them").remedy("remove the columns of the other")));
    }
    issues
}

fn too_short(table: &ColumnTable) -> Option<PlanIssue> {
    let rows = table.times_s.len();
    (rows < 2).then(|| {
        let issue = Issue::new("rows", format!("{rows}"), "2 or more: at least the start and the end");
        PlanIssue::new(table.locations.of(0), of_vehicle(table, issue))
    })
}

fn not_finite(table: &ColumnTable) -> Vec<PlanIssue> {
    let times = std::iter::once(("t_s", &table.times_s));
    let columns = times.chain(table.columns.iter().map(|(name, values)| (name.as_str(), values)));
    columns
        .flat_map(|(name, values)| values.iter().enumerate().map(move |(row, value)| (name, row, *value)))
        .filter(|(_, _, value)| !value.is_finite())
        .map(|(name, row, value)| {
            PlanIssue::new(
                table.locations.of(row),
                of_vehicle(table, Issue::new(name, value.to_string(), "a finite number")),
            )
        })
        .collect()
}

/// The first violation of: times start at 0, increase, and have no gap where that matters.
fn time_issue(table: &ColumnTable, columns: &Columns) -> Option<PlanIssue> {
    let times_s = &table.times_s;
    let issue = |row: usize, found: String, expected: &str, remedy: &str| {
        let issue = Issue::new("t_s", found, expected).remedy(remedy);
        Some(PlanIssue::new(table.locations.of(row), of_vehicle(table, issue)))
    };
    if times_s[0].abs() > TIME_TOLERANCE_S {
        let remedy = match times_s[0] {
            stamp if stamp > EPOCH_NS => {
                "these are nanoseconds since 1970: subtract the first stamp, and name the unit"
            }
            stamp if stamp > EPOCH_S => "these are seconds since 1970: subtract the first stamp",
            _ => "measure the time from the start of the scenario, and include the start as the first row",
        };
        return issue(0, format!("{} s in the first row", times_s[0]), "0 s", remedy);
    }
    // Positions alone say nothing of a velocity before and after a jump.
    let has_velocity = |form: &&[&str]| form.iter().all(|name| table.columns.contains_key(*name));
    let may_jump =
        columns.allows_discontinuity && (columns.velocity.is_empty() || columns.velocity.iter().any(has_velocity));
    let mut intervals_s = Vec::with_capacity(times_s.len());
    for (row, pair) in times_s.windows(2).enumerate() {
        let found = format!("{} s after {} s", pair[1], pair[0]);
        match pair[0].partial_cmp(&pair[1]) {
            Some(Ordering::Less) => intervals_s.push(pair[1] - pair[0]),
            Some(Ordering::Equal) if may_jump && intervals_s.last() != Some(&0.0) => {
                intervals_s.push(0.0);
            }
            Some(Ordering::Equal) => {
                return issue(row + 1, found, "each time once per vehicle", "remove one of the rows");
            }
            _ => return issue(row + 1, found, "rows in the order of time", "sort the rows of each vehicle by t_s"),
        }
    }
    match columns.gaps {
        Gaps::Judged => None,
        Gaps::Refused | Gaps::RefusedAlways => gap_issue(table, columns, &intervals_s),
    }
}

/// The first interval that is much longer than the others, and not a hover.
fn gap_issue(table: &ColumnTable, columns: &Columns, intervals_s: &[f64]) -> Option<PlanIssue> {
    let mut sorted: Vec<f64> = intervals_s.iter().copied().filter(|interval_s| *interval_s > 0.0).collect();
    sorted.sort_by(f64::total_cmp);
    let median_s = *sorted.get(sorted.len() / 2)?;
    let may_hover = |row| columns.gaps == Gaps::Refused && is_hover(table, columns, row);
    let is_gap = |row: &usize| intervals_s[*row] > MAX_INTERVALS * median_s && !may_hover(*row);
    let gap = (0..intervals_s.len()).find(is_gap)?;
    let [from_s, to_s] = [table.times_s[gap], table.times_s[gap + 1]];
    let found = format!("a gap from {from_s} s to {to_s} s, where rows are {median_s:.3} s apart");
    let issue = Issue::new("t_s", found, "no interval longer than 20 times the median");
    let issue = issue.remedy(match columns.gaps {
        Gaps::RefusedAlways => "what the vehicle did meanwhile is not known: give a log without the gap",
        Gaps::Refused | Gaps::Judged => {
            "add the missing rows, or resample the plan; two rows at rest at one place are a hover"
        }
    });
    Some(PlanIssue::new(table.locations.of(gap + 1), of_vehicle(table, issue)))
}

/// Whether a row and the next say that the vehicle stays: at one place, and at rest.
fn is_hover(table: &ColumnTable, columns: &Columns, row: usize) -> bool {
    let values = |meant: &str| table.columns.iter().find(|(name, _)| columns.meaning(name).0 == meant).map(|it| it.1);
    let stays = |name: &&str| values(name).is_some_and(|values| values[row] == values[row + 1]);
    let rests = |name: &&str| values(name).is_some_and(|values| values[row] == 0.0 && values[row + 1] == 0.0);
    ["x_m", "y_m", "z_m"].iter().all(stays) && ["vx_mps", "vy_mps", "vz_mps"].iter().all(rests)
}

/// An end so late that the times must be in another unit.
fn too_long(table: &ColumnTable, max_end_s: f64) -> Option<PlanIssue> {
    let last = table.times_s.len() - 1;
    (table.times_s[last] > max_end_s).then(|| {
        let found = format!("{} s at the end", table.times_s[last]);
        let expected = format!("at most {max_end_s} s, ten times simulation.max_duration_s");
        let issue = Issue::new("t_s", found, expected).remedy("are the times in milliseconds?");
        PlanIssue::new(table.locations.of(last), of_vehicle(table, issue))
    })
}

/// The table with all columns converted to their standard units and names.
fn converted(table: &ColumnTable, columns: &Columns) -> ColumnTable {
    let column = |(name, values): (&String, &Vec<f64>)| {
        let (meant, factor) = columns.meaning(name);
        let values = if factor == 1.0 { values.clone() } else { values.iter().map(|value| value * factor).collect() };
        (meant.to_owned(), values)
    };
    ColumnTable { columns: table.columns.iter().map(column).collect(), ..table.clone() }
}

/// The issue with the name of the vehicle.
fn of_vehicle(table: &ColumnTable, issue: Issue) -> Issue {
    Issue { field: format!("{} of {}", issue.field, table.vehicle), ..issue }
}
