//! Detection of wrong units and frames, which are errors of the file rather than findings about the plan.
//!
//! An error is reported only if the numbers are inconsistent as given, and consistent within a tight tolerance under a
//! common mistake. Everything else is left to the judge.

use std::f64::consts::{FRAC_PI_2, TAU};

use super::ImportedTrajectory;
use crate::fixed_wing::PartialTrajectory;
use crate::{Issue, Vehicle};

/// Relative tolerance of equal positions.
const POSITION_TOLERANCE: f64 = 1e-3;
/// Distance from the start up to which the first position is accepted, m.
const MAX_START_OFFSET_M: f64 = 1.0;
/// Horizontal distance between start and goal from which degrees can be told from metres, m.
const MIN_FLIGHT_M: f64 = 10.0;
/// Relative tolerance of the ratio of two means over a trajectory.
const MEAN_TOLERANCE: f64 = 0.02;

/// Units of length: name and number per metre.
const LENGTHS: [(&str, f64); 4] =
    [("kilometres", 1e-3), ("feet", 1.0 / 0.3048), ("centimetres", 1e2), ("millimetres", 1e3)];
/// Units of speed: name and number per m/s.
const SPEEDS: [(&str, f64); 4] = [
    ("km/h", 3.6),
    ("knots", 3600.0 / 1852.0),
    ("feet per second", 1.0 / 0.3048),
    ("miles per hour", 3600.0 / 1609.344),
];

/// The suspected errors, each with the row that shows it.
pub(super) fn suspicions(trajectory: &ImportedTrajectory, vehicle: &Vehicle) -> Vec<(usize, Issue)> {
    let named =
        |(row, issue): (usize, Issue)| (row, Issue { field: format!("{} of {}", issue.field, vehicle.name), ..issue });
    let of_motion = match trajectory {
        ImportedTrajectory::Partial(trajectory) => [angles(trajectory), heading(trajectory), speed(trajectory)],
        ImportedTrajectory::Complete(_) | ImportedTrajectory::Positions(_) | ImportedTrajectory::Curve(_) => {
            [None, None, None]
        }
    };
    [position(trajectory, vehicle).or_else(|| degrees(trajectory, vehicle))]
        .into_iter()
        .chain(of_motion)
        .flatten()
        .map(named)
        .collect()
}

/// A first position that is the vehicle's start in another unit or frame.
fn position(trajectory: &ImportedTrajectory, vehicle: &Vehicle) -> Option<(usize, Issue)> {
    let (first, start) = (trajectory.first_position_m(), vehicle.start.position_m());
    if distance(first, start) <= MAX_START_OFFSET_M {
        return None;
    }
    let [x, y, z] = start;
    let frames = [("north-east-down", [y, x, -z]), ("with z downwards", [x, y, -z]), ("north-east-up", [y, x, z])];
    let lengths = LENGTHS.map(|(unit, per_metre)| (format!("in {unit}"), start.map(|value| value * per_metre)));
    let candidates = frames.into_iter().map(|(frame, position)| (frame.to_owned(), position)).chain(lengths);
    let size = |position: [f64; 3]| position.iter().map(|value| value * value).sum::<f64>().sqrt();
    let (guess, _) = candidates.into_iter().find(|(_, position)| {
        size(*position) > 0.0
            && distance(first, *position) <= POSITION_TOLERANCE * size(*position).max(f64::MIN_POSITIVE)
    })?;
    let found = format!("({}, {}, {}), which is the vehicle's start {guess}", first[0], first[1], first[2]);
    Some((0, Issue::new("position", found, format!("({x}, {y}, {z}): x east, y north, z up, in m"))))
}

/// Latitude and longitude: numbers in their ranges that hardly change over a flight of many metres.
fn degrees(trajectory: &ImportedTrajectory, vehicle: &Vehicle) -> Option<(usize, Issue)> {
    let (start, goal) = (vehicle.start.position_m(), vehicle.goal.position_m());
    let [first, last] = trajectory.end_positions_m()?;
    let is_angle = |[x, y, _]: [f64; 3]| (x.abs() <= 90.0 && y.abs() <= 180.0) || (y.abs() <= 90.0 && x.abs() <= 180.0);
    let horizontal_m = |a: [f64; 3], b: [f64; 3]| (a[0] - b[0]).hypot(a[1] - b[1]);
    // A degree is 111 km.
    let moved_deg = horizontal_m(first, last);
    let asked_deg = horizontal_m(start, goal) / 111_000.0;
    let is_suspect = horizontal_m(start, goal) > MIN_FLIGHT_M
        && horizontal_m(first, start) > MAX_START_OFFSET_M
        && is_angle(first)
        && is_angle(last)
        && moved_deg > 0.3 * asked_deg
        && moved_deg < 3.0 * asked_deg;
    is_suspect.then(|| {
        let found = format!("({}, {}), which looks like latitude and longitude in degrees", first[0], first[1]);
        let issue = Issue::new("position", found, "x east, y north, z up, in m from the origin of the scenario");
        (0, issue.remedy("project the positions onto the plane, with the origin of the scenario's map"))
    })
}

/// A flight-path angle beyond vertical.
fn angles(trajectory: &PartialTrajectory) -> Option<(usize, Issue)> {
    let states = trajectory.states.as_ref()?;
    let row = states.iter().position(|state| state.flight_path_rad.abs() > FRAC_PI_2)?;
    let found = states[row].flight_path_rad.to_string();
    let issue = Issue::new("flight_path_rad", found, "a value between -π/2 and π/2");
    Some((row, issue.remedy("if it is in degrees, name the column `flight_path_deg`")))
}

/// Headings that match the direction of motion only as degrees or compass bearings.
fn heading(trajectory: &PartialTrajectory) -> Option<(usize, Issue)> {
    let states = trajectory.states.as_ref()?;
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
        (mean_error(|heading| FRAC_PI_2 - heading), "compass bearings", "give headings counterclockwise from east"),
    ];
    let errors = errors.into_iter().filter_map(|(error, guess, remedy)| Some((error?, guess, remedy)));
    let (error, guess, remedy) = errors.min_by(|a, b| a.0.total_cmp(&b.0))?;
    if error > 0.05 {
        return None;
    }
    let found = format!(
        "{}, ...: this matches the direction of motion only if the headings are {guess}",
        states[0].heading_rad
    );
    Some((0, Issue::new("heading_rad", found, "radians, counterclockwise from east").remedy(remedy)))
}

/// Speeds that match the motion only in other units.
fn speed(trajectory: &PartialTrajectory) -> Option<(usize, Issue)> {
    let states = trajectory.states.as_ref()?;
    let stated = mean(states.windows(2).map(|pair| f64::midpoint(pair[0].speed_mps, pair[1].speed_mps)))?;
    let moved_m: f64 = states.windows(2).map(|pair| distance(pair[0].position_m(), pair[1].position_m())).sum();
    let moved_mps = moved_m / (trajectory.times_s[trajectory.times_s.len() - 1] - trajectory.times_s[0]);
    let ratio = stated / moved_mps;
    let is = |factor: f64| (ratio / factor - 1.0).abs() < MEAN_TOLERANCE;
    let guess = match SPEEDS.iter().find(|(_, per_mps)| is(*per_mps)) {
        Some((unit, _)) => format!("speeds in {unit}"),
        None if is(1e3) => "times in milliseconds, or positions in kilometres".to_owned(),
        None => return None,
    };
    let found =
        format!("{stated:.3} on average, where positions change by {moved_mps:.3} m per s: this looks like {guess}");
    Some((0, Issue::new("speed_mps", found, "times in s, positions in m and speeds in m/s")))
}

fn mean(values: impl Iterator<Item = f64>) -> Option<f64> {
    let (count, sum) = values.fold((0.0, 0.0), |(count, sum), value| (count + 1.0, sum + value));
    (count > 0.0).then(|| sum / count)
}

fn distance(a: [f64; 3], b: [f64; 3]) -> f64 {
    (0..3).map(|axis| (a[axis] - b[axis]).powi(2)).sum::<f64>().sqrt()
}
