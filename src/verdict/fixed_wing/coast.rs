//! The flight of fixed wings after they have arrived, until the last one has: straight on, at the velocity of the arrival.
//!
//! An aircraft does not vanish at its goal. Until the mission ends for all, it has to stay clear of obstacles and of the others,
//! on the map, and on the right side of geofences.

use sim::Flight;

use crate::verdict::flown::{FlownMotions, knot};
use crate::verdict::missing_evidence::MissingEvidence;
use crate::verdict::motion::{Knot, Motion};
use crate::verdict::tube::EndError;

/// Samples before the first arrival with which a logged coast begins, so that its error of interpolation is known.
const LEAD_SAMPLES: usize = 3;

/// The planned motions from the first arrival until the last, those that have arrived flying on. Empty if all arrive at
/// once.
///
/// - `end_error`: how far the true end of a vehicle's plan may be from this one
pub fn planned(motions: &[Motion], end_error: impl Fn(usize) -> EndError) -> Vec<Motion> {
    let Some(span_s) = first_and_last(motions.iter().map(Motion::end_s)) else { return Vec::new() };
    planned_during(span_s, motions, end_error)
}

/// The planned motions from their beginning until the last arrival, those that have arrived flying on.
///
/// - `end_error`: how far the true end of a vehicle's plan may be from this one
pub fn planned_mission(motions: &[Motion], end_error: impl Fn(usize) -> EndError) -> Vec<Motion> {
    let last_s = motions.iter().map(Motion::end_s).fold(0.0, f64::max);
    planned_during([0.0, last_s], motions, end_error)
}

fn planned_during([from_s, to_s]: [f64; 2], motions: &[Motion], end_error: impl Fn(usize) -> EndError) -> Vec<Motion> {
    let coast = |(index, motion): (usize, &Motion)| motion.coasting(from_s, to_s, end_error(index).velocity_mps);
    motions.iter().enumerate().map(coast).collect()
}

/// The flown motions from the first arrival until the last, those that have arrived flying on. Empty if all arrive at once.
///
/// - `surround`: the motion of a vehicle in the tube in which it would have flown
///
/// # Errors
///
/// A log holds values there that cannot be judged.
pub fn flown(
    flight: &Flight,
    flown: &FlownMotions<'_>,
    surround: impl Fn(usize, Motion) -> Motion,
) -> Result<Vec<Motion>, MissingEvidence> {
    match first_and_last(flown.vehicles.iter().map(|vehicle| vehicle.judged_end_s)) {
        Some(span_s) => flown_during(span_s, flight, flown, surround),
        None => Ok(Vec::new()),
    }
}

/// The flown motions from their beginning until the last arrival, those that have arrived flying on.
///
/// - `surround`: the motion of a vehicle in the tube in which it would have flown
///
/// # Errors
///
/// A log holds values that cannot be judged.
pub fn flown_mission(
    flight: &Flight,
    flown: &FlownMotions<'_>,
    surround: impl Fn(usize, Motion) -> Motion,
) -> Result<Vec<Motion>, MissingEvidence> {
    let last_s = flown.vehicles.iter().map(|vehicle| vehicle.judged_end_s).fold(0.0, f64::max);
    flown_during([0.0, last_s], flight, flown, surround)
}

fn flown_during(
    [from_s, to_s]: [f64; 2],
    flight: &Flight,
    flown: &FlownMotions<'_>,
    surround: impl Fn(usize, Motion) -> Motion,
) -> Result<Vec<Motion>, MissingEvidence> {
    let coast = |(index, motion): (usize, &Motion)| {
        let samples = &flight.vehicles[index].samples;
        let end = (samples.partition_point(|sample| sample.t_s < to_s) + 1).min(samples.len());
        let begin = samples[..end].partition_point(|sample| sample.t_s < from_s).saturating_sub(LEAD_SAMPLES);
        let knots: Vec<Knot> = samples[begin.min(end.saturating_sub(LEAD_SAMPLES))..end].iter().map(knot).collect();
        Ok(surround(index, Motion::new(motion.vehicle(), knots)?.sampled()))
    };
    flown.motions.iter().enumerate().map(coast).collect()
}

/// The smallest and the largest of the times, if they differ, s.
fn first_and_last(ends_s: impl Iterator<Item = f64> + Clone) -> Option<[f64; 2]> {
    let [first_s, last_s] = [ends_s.clone().fold(f64::INFINITY, f64::min), ends_s.fold(0.0, f64::max)];
    (first_s < last_s).then_some([first_s, last_s])
}
