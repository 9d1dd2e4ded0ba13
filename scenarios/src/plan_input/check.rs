//! A table against the scenario that it is for. What is refused here is an issue of the file; whether the motion can be
//! flown is for the judge to say.

use std::cmp::Ordering;

use super::columns::Columns;
use super::{ColumnTable, ImportedTrajectory, PlanDocument, PlanIssue, units};
use crate::{Family, Issue, PlanStatus, Scenario, Vehicle, closest_name};

/// The first time may differ from 0 by this much, s.
const TIME_TOLERANCE_S: f64 = 1e-9;
/// An interval longer than this many median intervals of its track is a gap: no row is meant to be missing there.
const GAP: f64 = 20.0;
/// A plan that lasts this many times as long as is simulated at most is in another unit.
const TOO_LONG: f64 = 10.0;

/// One track per vehicle, in the order of the scenario, or everything that is wrong.
pub(super) fn tracks(table: &PlanDocument, scenario: &Scenario) -> Result<Vec<ImportedTrajectory>, Vec<PlanIssue>> {
    let mut issues: Vec<PlanIssue> = other_scenario(table, scenario).into_iter().collect();
    if table.header.status == Some(PlanStatus::NoPlan) && table.tracks.is_empty() {
        return if issues.is_empty() { Ok(Vec::new()) } else { Err(issues) };
    }
    issues.extend(surplus(table, scenario));
    let family = scenario.family();
    let mut given = Vec::with_capacity(scenario.vehicles.len());
    for vehicle in &scenario.vehicles {
        match table.tracks.iter().find(|track| track.vehicle == vehicle.name) {
            None => issues.push(missing(vehicle)),
            Some(track) => {
                let found = track_issues(track, vehicle, family, TOO_LONG * scenario.simulation.max_duration_s);
                if found.is_empty() {
                    given.push((family.spec().import)(&converted(track, family.spec().columns)));
                }
                issues.extend(found);
            }
        }
    }
    if issues.is_empty() { Ok(given) } else { Err(issues) }
}

fn other_scenario(table: &PlanDocument, scenario: &Scenario) -> Option<PlanIssue> {
    let named = table.header.scenario.as_ref().filter(|named| **named != scenario.name)?;
    let expected = format!("\"{}\", the scenario that it is held against", scenario.name);
    Some(PlanIssue::new("", Issue::new("scenario", format!("\"{named}\""), expected).remedy("is it the right file?")))
}

/// Tracks of no vehicle, and second tracks of one.
fn surplus(table: &PlanDocument, scenario: &Scenario) -> Vec<PlanIssue> {
    let names: Vec<&str> = scenario.vehicles.iter().map(|vehicle| vehicle.name.as_str()).collect();
    let mut issues = Vec::new();
    for (index, track) in table.tracks.iter().enumerate() {
        let found = format!("\"{}\"", track.vehicle);
        if table.tracks[..index].iter().any(|other| other.vehicle == track.vehicle) {
            let issue = Issue::new("vehicle", found, "one trajectory per vehicle; it has one already");
            issues.push(PlanIssue::new(track.places.of(0), issue));
        } else if !names.contains(&track.vehicle.as_str()) {
            let has_no_track = |name: &&str| table.tracks.iter().all(|track| track.vehicle != **name);
            let remedy = closest_name(&track.vehicle, names.iter().copied().filter(has_no_track));
            let remedy = remedy.map_or_else(String::new, |name| format!("did you mean \"{name}\"?"));
            let expected = format!("a vehicle of the scenario: {}", names.join(", "));
            issues.push(PlanIssue::new(track.places.of(0), Issue::new("vehicle", found, expected).remedy(remedy)));
        }
    }
    issues
}

fn missing(vehicle: &Vehicle) -> PlanIssue {
    let issue = Issue::new("vehicle", format!("no row of `{}`", vehicle.name), "every vehicle of the scenario");
    PlanIssue::new("", issue.remedy("a plan is judged as a whole: give all vehicles"))
}

/// What is wrong with one track; later questions are asked only if earlier ones leave something to ask about.
fn track_issues(track: &ColumnTable, vehicle: &Vehicle, family: Family, longest_s: f64) -> Vec<PlanIssue> {
    let columns = family.spec().columns;
    let mut issues = column_issues(track, columns);
    issues.extend(too_short(track));
    if issues.is_empty() {
        issues.extend(not_finite(track));
    }
    if issues.is_empty() {
        issues.extend(time_issue(track, columns.allows_discontinuity).or_else(|| too_long(track, longest_s)));
    }
    if issues.is_empty() {
        let place = |row: usize| track.places.of(row);
        issues = units::suspicions(&(family.spec().import)(&converted(track, columns)), vehicle)
            .into_iter()
            .map(|(row, issue)| PlanIssue::new(place(row), issue))
            .collect();
    }
    issues
}

fn column_issues(track: &ColumnTable, columns: &Columns) -> Vec<PlanIssue> {
    let place =
        || if matches!(track.places, super::RowLocations::Trajectory(_)) { String::new() } else { ":1".to_owned() };
    let issue = |issue: Issue| PlanIssue::new(place(), of(track, issue));
    let known = columns.names();
    let mut issues = Vec::new();
    for name in track.columns.keys().filter(|name| !known.contains(&name.as_str())) {
        let remedy = closest_name(name, known.iter().copied());
        let remedy =
            remedy.map_or_else(|| "remove it, or rename it".into(), |known| format!("did you mean `{known}`?"));
        let expected = format!("one of {} for a vehicle of the family {}", known.join(", "), columns.family.key());
        issues.push(issue(Issue::new(name, "an unknown column", expected).remedy(remedy)));
    }
    let meant: Vec<&str> = track.columns.keys().map(|name| columns.meaning(name).0).collect();
    for name in columns.required.iter().filter(|name| !meant.contains(name)) {
        issues.push(issue(Issue::new(*name, "nothing", "a column of this name")));
    }
    for (index, name) in meant.iter().enumerate().filter(|(index, name)| meant[..*index].contains(name)) {
        let found = format!("the column `{name}` twice, in two units");
        issues.push(issue(Issue::new(meant[index], found, "one of the two")));
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

fn too_short(track: &ColumnTable) -> Option<PlanIssue> {
    let rows = track.times_s.len();
    (rows < 2).then(|| {
        let issue = Issue::new("rows", format!("{rows}"), "2 or more: a motion has a beginning and an end");
        PlanIssue::new(track.places.of(0), of(track, issue))
    })
}

fn not_finite(track: &ColumnTable) -> Vec<PlanIssue> {
    let times = std::iter::once(("t_s", &track.times_s));
    let columns = times.chain(track.columns.iter().map(|(name, values)| (name.as_str(), values)));
    columns
        .flat_map(|(name, values)| values.iter().enumerate().map(move |(row, value)| (name, row, *value)))
        .filter(|(_, _, value)| !value.is_finite())
        .map(|(name, row, value)| {
            PlanIssue::new(track.places.of(row), of(track, Issue::new(name, value.to_string(), "a finite number")))
        })
        .collect()
}

/// Times from 0, increasing, without a gap: the first issue.
///
/// - `allows_discontinuity`: may two rows in a row share a time?
fn time_issue(track: &ColumnTable, allows_discontinuity: bool) -> Option<PlanIssue> {
    let times_s = &track.times_s;
    let issue = |row: usize, found: String, expected: &str, remedy: &str| {
        let issue = Issue::new("t_s", found, expected).remedy(remedy);
        Some(PlanIssue::new(track.places.of(row), of(track, issue)))
    };
    if times_s[0].abs() > TIME_TOLERANCE_S {
        let remedy = "count the time from the start of the scenario, and give the start as the first row";
        return issue(0, format!("{} s in the first row", times_s[0]), "0 s", remedy);
    }
    let mut intervals_s = Vec::with_capacity(times_s.len());
    for (row, pair) in times_s.windows(2).enumerate() {
        let found = format!("{} s after {} s", pair[1], pair[0]);
        match pair[0].partial_cmp(&pair[1]) {
            Some(Ordering::Less) => intervals_s.push(pair[1] - pair[0]),
            Some(Ordering::Equal) if allows_discontinuity && intervals_s.last() != Some(&0.0) => intervals_s.push(0.0),
            Some(Ordering::Equal) => {
                return issue(row + 1, found, "each time once per vehicle", "remove one of the rows");
            }
            _ => return issue(row + 1, found, "rows in the order of time", "sort the rows of each vehicle by t_s"),
        }
    }
    let mut sorted: Vec<f64> = intervals_s.iter().copied().filter(|interval_s| *interval_s > 0.0).collect();
    sorted.sort_by(f64::total_cmp);
    let median_s = *sorted.get(sorted.len() / 2)?;
    let gap = intervals_s.iter().position(|interval_s| *interval_s > GAP * median_s)?;
    let found = format!("a gap from {} s to {} s, where rows are {median_s} s apart", times_s[gap], times_s[gap + 1]);
    issue(gap + 1, found, "no interval longer than 20 times the median", "add the missing rows, or resample the plan")
}

/// Does it last so long that the times must be in another unit?
fn too_long(track: &ColumnTable, longest_s: f64) -> Option<PlanIssue> {
    let last = track.times_s.len() - 1;
    (track.times_s[last] > longest_s).then(|| {
        let found = format!("{} s at the end", track.times_s[last]);
        let expected = format!("{longest_s} s at most, ten times what is simulated (simulation.max_duration_s)");
        let issue = Issue::new("t_s", found, expected).remedy("are the times in milliseconds?");
        PlanIssue::new(track.places.of(last), of(track, issue))
    })
}

/// The track with every column in the unit and under the name in which it is read on.
fn converted(track: &ColumnTable, columns: &Columns) -> ColumnTable {
    let column = |(name, values): (&String, &Vec<f64>)| {
        let (meant, factor) = columns.meaning(name);
        let values = if factor == 1.0 { values.clone() } else { values.iter().map(|value| value * factor).collect() };
        (meant.to_owned(), values)
    };
    ColumnTable { columns: track.columns.iter().map(column).collect(), ..track.clone() }
}

/// The issue, with the vehicle that it is about.
fn of(track: &ColumnTable, issue: Issue) -> Issue {
    Issue { field: format!("{} of {}", issue.field, track.vehicle), ..issue }
}
