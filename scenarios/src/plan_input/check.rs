//! A table against the scenario that it is for. What is refused here is a fault of the file; whether the motion can be
//! flown is for the judge to say.

use std::cmp::Ordering;

use super::columns::Columns;
use super::{GivenTrack, PlanFault, PlanTable, Track, units};
use crate::{Family, PlanStatus, Problem, Scenario, Vehicle, nearest};

/// The first time may differ from 0 by this much, s.
const TIME_TOLERANCE_S: f64 = 1e-9;
/// An interval longer than this many median intervals of its track is a gap: no row is meant to be missing there.
const GAP: f64 = 20.0;
/// A plan that lasts this many times as long as is simulated at most is in another unit.
const TOO_LONG: f64 = 10.0;

/// One track per vehicle, in the order of the scenario, or everything that is wrong.
pub(super) fn tracks(table: &PlanTable, scenario: &Scenario) -> Result<Vec<GivenTrack>, Vec<PlanFault>> {
    let mut faults: Vec<PlanFault> = other_scenario(table, scenario).into_iter().collect();
    if table.header.status == Some(PlanStatus::NoPlan) && table.tracks.is_empty() {
        return if faults.is_empty() { Ok(Vec::new()) } else { Err(faults) };
    }
    faults.extend(surplus(table, scenario));
    let family = scenario.family();
    let mut given = Vec::with_capacity(scenario.vehicles.len());
    for vehicle in &scenario.vehicles {
        match table.tracks.iter().find(|track| track.vehicle == vehicle.name) {
            None => faults.push(missing(vehicle)),
            Some(track) => {
                let found = track_faults(track, vehicle, family, TOO_LONG * scenario.simulation.max_duration_s);
                if found.is_empty() {
                    given.push(GivenTrack::of(&converted(track, Columns::of(family)), family));
                }
                faults.extend(found);
            }
        }
    }
    if faults.is_empty() { Ok(given) } else { Err(faults) }
}

fn other_scenario(table: &PlanTable, scenario: &Scenario) -> Option<PlanFault> {
    let named = table.header.scenario.as_ref().filter(|named| **named != scenario.name)?;
    let expected = format!("\"{}\", the scenario that it is held against", scenario.name);
    Some(PlanFault::new("", Problem::new("scenario", format!("\"{named}\""), expected).remedy("is it the right file?")))
}

/// Tracks of no vehicle, and second tracks of one.
fn surplus(table: &PlanTable, scenario: &Scenario) -> Vec<PlanFault> {
    let names: Vec<&str> = scenario.vehicles.iter().map(|vehicle| vehicle.name.as_str()).collect();
    let mut faults = Vec::new();
    for (index, track) in table.tracks.iter().enumerate() {
        let found = format!("\"{}\"", track.vehicle);
        if table.tracks[..index].iter().any(|other| other.vehicle == track.vehicle) {
            let problem = Problem::new("vehicle", found, "one trajectory per vehicle; it has one already");
            faults.push(PlanFault::new(track.places.of(0), problem));
        } else if !names.contains(&track.vehicle.as_str()) {
            let has_no_track = |name: &&str| table.tracks.iter().all(|track| track.vehicle != **name);
            let remedy = nearest(&track.vehicle, names.iter().copied().filter(has_no_track));
            let remedy = remedy.map_or_else(String::new, |name| format!("did you mean \"{name}\"?"));
            let expected = format!("a vehicle of the scenario: {}", names.join(", "));
            faults.push(PlanFault::new(track.places.of(0), Problem::new("vehicle", found, expected).remedy(remedy)));
        }
    }
    faults
}

fn missing(vehicle: &Vehicle) -> PlanFault {
    let problem = Problem::new("vehicle", format!("no row of `{}`", vehicle.name), "every vehicle of the scenario");
    PlanFault::new("", problem.remedy("a plan is judged as a whole: give all vehicles"))
}

/// What is wrong with one track; later questions are asked only if earlier ones leave something to ask about.
fn track_faults(track: &Track, vehicle: &Vehicle, family: Family, longest_s: f64) -> Vec<PlanFault> {
    let columns = Columns::of(family);
    let mut faults = column_faults(track, columns);
    faults.extend(too_short(track));
    if faults.is_empty() {
        faults.extend(not_finite(track));
    }
    if faults.is_empty() {
        faults.extend(time_fault(track, columns.allows_discontinuity).or_else(|| too_long(track, longest_s)));
    }
    if faults.is_empty() {
        let place = |row: usize| track.places.of(row);
        faults = units::suspicions(&GivenTrack::of(&converted(track, columns), family), vehicle)
            .into_iter()
            .map(|(row, problem)| PlanFault::new(place(row), problem))
            .collect();
    }
    faults
}

fn column_faults(track: &Track, columns: &Columns) -> Vec<PlanFault> {
    let place = || if matches!(track.places, super::Places::Trajectory(_)) { String::new() } else { ":1".to_owned() };
    let fault = |problem: Problem| PlanFault::new(place(), of(track, problem));
    let known = columns.names();
    let mut faults = Vec::new();
    for name in track.columns.keys().filter(|name| !known.contains(&name.as_str())) {
        let remedy = nearest(name, known.iter().copied());
        let remedy =
            remedy.map_or_else(|| "remove it, or rename it".into(), |known| format!("did you mean `{known}`?"));
        let expected = format!("one of {} for a vehicle of the family {}", known.join(", "), columns.family);
        faults.push(fault(Problem::new(name, "an unknown column", expected).remedy(remedy)));
    }
    let meant: Vec<&str> = track.columns.keys().map(|name| columns.meaning(name).0).collect();
    for name in columns.required.iter().filter(|name| !meant.contains(name)) {
        faults.push(fault(Problem::new(*name, "nothing", "a column of this name")));
    }
    for (index, name) in meant.iter().enumerate().filter(|(index, name)| meant[..*index].contains(name)) {
        let found = format!("the column `{name}` twice, in two units");
        faults.push(fault(Problem::new(meant[index], found, "one of the two")));
    }
    let is_given = |form: &[&str]| form.iter().any(|name| meant.contains(name));
    for form in columns.velocity.iter().copied().chain([columns.controls]).filter(|form| is_given(form)) {
        for name in form.iter().filter(|name| !meant.contains(name)) {
            let expected = format!("{} together, or none of them", form.join(", "));
            faults.push(fault(Problem::new(*name, "nothing", expected)));
        }
    }
    if columns.velocity.iter().filter(|form| is_given(form)).count() > 1 {
        let found = "the velocity in two forms";
        faults.push(fault(Problem::new("velocity", found, "one of them").remedy("remove the columns of the other")));
    }
    faults
}

fn too_short(track: &Track) -> Option<PlanFault> {
    let rows = track.times_s.len();
    (rows < 2).then(|| {
        let problem = Problem::new("rows", format!("{rows}"), "2 or more: a motion has a beginning and an end");
        PlanFault::new(track.places.of(0), of(track, problem))
    })
}

fn not_finite(track: &Track) -> Vec<PlanFault> {
    let times = std::iter::once(("t_s", &track.times_s));
    let columns = times.chain(track.columns.iter().map(|(name, values)| (name.as_str(), values)));
    columns
        .flat_map(|(name, values)| values.iter().enumerate().map(move |(row, value)| (name, row, *value)))
        .filter(|(_, _, value)| !value.is_finite())
        .map(|(name, row, value)| {
            PlanFault::new(track.places.of(row), of(track, Problem::new(name, value.to_string(), "a finite number")))
        })
        .collect()
}

/// Times from 0, increasing, without a gap: the first fault.
///
/// - `allows_discontinuity`: may two rows in a row share a time?
fn time_fault(track: &Track, allows_discontinuity: bool) -> Option<PlanFault> {
    let times_s = &track.times_s;
    let fault = |row: usize, found: String, expected: &str, remedy: &str| {
        let problem = Problem::new("t_s", found, expected).remedy(remedy);
        Some(PlanFault::new(track.places.of(row), of(track, problem)))
    };
    if times_s[0].abs() > TIME_TOLERANCE_S {
        let remedy = "count the time from the start of the scenario, and give the start as the first row";
        return fault(0, format!("{} s in the first row", times_s[0]), "0 s", remedy);
    }
    let mut intervals_s = Vec::with_capacity(times_s.len());
    for (row, pair) in times_s.windows(2).enumerate() {
        let found = format!("{} s after {} s", pair[1], pair[0]);
        match pair[0].partial_cmp(&pair[1]) {
            Some(Ordering::Less) => intervals_s.push(pair[1] - pair[0]),
            Some(Ordering::Equal) if allows_discontinuity && intervals_s.last() != Some(&0.0) => intervals_s.push(0.0),
            Some(Ordering::Equal) => {
                return fault(row + 1, found, "each time once per vehicle", "remove one of the rows");
            }
            _ => return fault(row + 1, found, "rows in the order of time", "sort the rows of each vehicle by t_s"),
        }
    }
    let mut sorted: Vec<f64> = intervals_s.iter().copied().filter(|interval_s| *interval_s > 0.0).collect();
    sorted.sort_by(f64::total_cmp);
    let median_s = *sorted.get(sorted.len() / 2)?;
    let gap = intervals_s.iter().position(|interval_s| *interval_s > GAP * median_s)?;
    let found = format!("a gap from {} s to {} s, where rows are {median_s} s apart", times_s[gap], times_s[gap + 1]);
    fault(gap + 1, found, "no interval longer than 20 times the median", "add the missing rows, or resample the plan")
}

/// Does it last so long that the times must be in another unit?
fn too_long(track: &Track, longest_s: f64) -> Option<PlanFault> {
    let last = track.times_s.len() - 1;
    (track.times_s[last] > longest_s).then(|| {
        let found = format!("{} s at the end", track.times_s[last]);
        let expected = format!("{longest_s} s at most, ten times what is simulated (simulation.max_duration_s)");
        let problem = Problem::new("t_s", found, expected).remedy("are the times in milliseconds?");
        PlanFault::new(track.places.of(last), of(track, problem))
    })
}

/// The track with every column in the unit and under the name in which it is read on.
fn converted(track: &Track, columns: &Columns) -> Track {
    let column = |(name, values): (&String, &Vec<f64>)| {
        let (meant, factor) = columns.meaning(name);
        let values = if factor == 1.0 { values.clone() } else { values.iter().map(|value| value * factor).collect() };
        (meant.to_owned(), values)
    };
    Track { columns: track.columns.iter().map(column).collect(), ..track.clone() }
}

/// The problem, with the vehicle that it is about.
fn of(track: &Track, problem: Problem) -> Problem {
    Problem { field: format!("{} of {}", problem.field, track.vehicle), ..problem }
}
