//! Units and frames that cannot be meant: a plan in feet is a mistake of the file, and no finding about the plan.
//!
//! A suspicion needs two things: the numbers make no sense as they stand, and make sense to a hair under a mistake that
//! people do make. Whatever else is odd about a motion is left to the judge.

use std::f64::consts::{FRAC_PI_2, TAU};

use super::ImportedTrajectory;
use crate::fixed_wing::PartialTrajectory;
use crate::{Issue, Vehicle};

/// Relative difference within which two quantities count as the same.
const SAME: f64 = 1e-3;
/// Position away from the start below which nothing is suspected, m.
const NEAR_M: f64 = 1.0;
/// Ratios of two means over a whole track agree to this.
const SAME_MEAN: f64 = 0.02;

/// Lengths by their number per metre.
const LENGTHS: [(&str, f64); 3] = [("kilometres", 1e-3), ("feet", 1.0 / 0.3048), ("millimetres", 1e3)];
/// Speeds by their number per m/s.
const SPEEDS: [(&str, f64); 4] = [
    ("km/h", 3.6),
    ("knots", 3600.0 / 1852.0),
    ("feet per second", 1.0 / 0.3048),
    ("miles per hour", 3600.0 / 1609.344),
];

/// What is suspected, with the row that shows it.
pub(super) fn suspicions(track: &ImportedTrajectory, vehicle: &Vehicle) -> Vec<(usize, Issue)> {
    let named =
        |(row, issue): (usize, Issue)| (row, Issue { field: format!("{} of {}", issue.field, vehicle.name), ..issue });
    let of_motion = match track {
        ImportedTrajectory::Partial(track) => [angles(track), heading(track), speed(track)],
        ImportedTrajectory::Complete(_) => [None, None, None],
    };
    [position(track, vehicle)].into_iter().chain(of_motion).flatten().map(named).collect()
}

/// Is the first position the vehicle's start in another unit or another frame?
fn position(track: &ImportedTrajectory, vehicle: &Vehicle) -> Option<(usize, Issue)> {
    let (first, start) = (track.first_position_m(), vehicle.start.position_m());
    if distance(first, start) <= NEAR_M {
        return None;
    }
    let [x, y, z] = start;
    let frames = [("north-east-down", [y, x, -z]), ("with z downwards", [x, y, -z]), ("north-east-up", [y, x, z])];
    let lengths = LENGTHS.map(|(unit, per_metre)| (format!("in {unit}"), start.map(|value| value * per_metre)));
    let candidates = frames.into_iter().map(|(frame, position)| (frame.to_owned(), position)).chain(lengths);
    let size = |position: [f64; 3]| position.iter().map(|value| value * value).sum::<f64>().sqrt();
    let (guess, _) = candidates.into_iter().find(|(_, position)| {
        size(*position) > 0.0 && distance(first, *position) <= SAME * size(*position).max(f64::MIN_POSITIVE)
    })?;
    let found = format!("({}, {}, {}), which is the vehicle's start {guess}", first[0], first[1], first[2]);
    Some((0, Issue::new("position", found, format!("({x}, {y}, {z}): x east, y north, z up, in m"))))
}

/// No aircraft climbs more steeply than straight up.
fn angles(track: &PartialTrajectory) -> Option<(usize, Issue)> {
    let states = track.states.as_ref()?;
    let row = states.iter().position(|state| state.flight_path_rad.abs() > FRAC_PI_2)?;
    let found = states[row].flight_path_rad.to_string();
    let issue = Issue::new("flight_path_rad", found, "a value between -π/2 and π/2");
    Some((row, issue.remedy("if it is in degrees, name the column `flight_path_deg`")))
}

/// Does the track move where its headings point only if these are degrees, or compass bearings?
fn heading(track: &PartialTrajectory) -> Option<(usize, Issue)> {
    let states = track.states.as_ref()?;
    let mean_error = |meant: fn(f64) -> f64| {
        let pairs = states.windows(2).filter_map(|pair| {
            let moved = [pair[1].x_m - pair[0].x_m, pair[1].y_m - pair[0].y_m];
            let course = (moved[0] != 0.0 || moved[1] != 0.0).then(|| moved[1].atan2(moved[0]))?;
            let off =
                |heading: f64| (meant(heading) - course).rem_euclid(TAU).min((course - meant(heading)).rem_euclid(TAU));
            Some(off(pair[0].heading_rad).min(off(pair[1].heading_rad)))
        });
        mean(pairs)
    };
    let as_given = mean_error(|heading| heading)?;
    if as_given < 0.3 {
        return None;
    }
    let errors = [
        (mean_error(f64::to_radians), "degrees", "name the column `heading_deg`"),
        (mean_error(|heading| FRAC_PI_2 - heading), "compass bearings", "count headings counterclockwise from east"),
    ];
    let errors = errors.into_iter().filter_map(|(error, guess, remedy)| Some((error?, guess, remedy)));
    let (error, guess, remedy) = errors.min_by(|a, b| a.0.total_cmp(&b.0))?;
    if error > 0.05 {
        return None;
    }
    let found = format!("{}, ...: the track moves elsewhere, but fits if these are {guess}", states[0].heading_rad);
    Some((0, Issue::new("heading_rad", found, "radians, counterclockwise from east").remedy(remedy)))
}

/// Does the track move as fast as it says only in other units?
fn speed(track: &PartialTrajectory) -> Option<(usize, Issue)> {
    let states = track.states.as_ref()?;
    let said = mean(states.windows(2).map(|pair| f64::midpoint(pair[0].speed_mps, pair[1].speed_mps)))?;
    let moved_m: f64 = states.windows(2).map(|pair| distance(pair[0].position_m(), pair[1].position_m())).sum();
    let moved_mps = moved_m / (track.times_s[track.times_s.len() - 1] - track.times_s[0]);
    let ratio = said / moved_mps;
    let is = |factor: f64| (ratio / factor - 1.0).abs() < SAME_MEAN;
    let guess = match SPEEDS.iter().find(|(_, per_mps)| is(*per_mps)) {
        Some((unit, _)) => format!("speeds in {unit}"),
        None if is(1e3) => "times in milliseconds, or positions in kilometres".to_owned(),
        None => return None,
    };
    let found = format!("{said:.3} on average, where positions move by {moved_mps:.3} m per s: it looks like {guess}");
    Some((0, Issue::new("speed_mps", found, "times in s, positions in m and speeds in m/s")))
}

fn mean(values: impl Iterator<Item = f64>) -> Option<f64> {
    let (count, sum) = values.fold((0.0, 0.0), |(count, sum), value| (count + 1.0, sum + value));
    (count > 0.0).then(|| sum / count)
}

fn distance(a: [f64; 3], b: [f64; 3]) -> f64 {
    (0..3).map(|axis| (a[axis] - b[axis]).powi(2)).sum::<f64>().sqrt()
}
