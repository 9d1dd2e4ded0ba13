//! Is the flight log whole, is everything in it a number, and did nobody crash?

use scenarios::{CheckSpec, Plan, Scenario, Vehicle};
use sim::{Event, EventKind, Flight, LoadSample, Sample, VehicleLog};

use crate::verdict::Check;
use crate::verdict::collision;
use crate::verdict::compare::exceeds;
use crate::verdict::evidence::{Decide, Evidence, Measurement};
use crate::verdict::flown::FlownMotions;
use crate::verdict::flown_reference;
use crate::verdict::integrity::{TIME_TOLERANCE_S, none_of, start_defect};
use crate::verdict::multirotor::planning;

/// Longest distance between two samples, in steps of the simulator: what rounding leaves above 1.
const LONGEST_GAP_STEPS: f64 = 1.001;

/// Number of numbers in the log that are not finite.
pub fn check_finite(spec: &CheckSpec, flight: &Flight) -> Check {
    let times = flight.events.iter().map(|event| event.t_s).chain([flight.step_s, flight.plan_end_s, flight.wall_s]);
    let amounts = flight.events.iter().filter_map(|event| amount(&event.kind));
    let planning = flight.planning.iter().flat_map(planning::numbers);
    let mut count = times.chain(amounts).chain(planning).filter(|value| !value.is_finite()).count();
    let mut odd = Vec::new();
    for log in &flight.vehicles {
        let numbers =
            log.samples.iter().flat_map(Sample::numbers).chain(log.loads.iter().flat_map(LoadSample::numbers));
        let here = numbers.filter(|value| !value.is_finite()).count();
        if here > 0 {
            odd.push(log.vehicle.as_str());
        }
        count += here;
    }
    none_of(spec, count, &odd, None)
}

/// Number of vehicles whose log is missing, misnamed, empty, with gaps, out of order in time, not from the vehicle's
/// start, shorter than the plan, or with another reference than the plan's; and of logs without a vehicle. A start may be
/// off by as much as the tracking: a disturbed start is a matter for the tracker.
///
/// - `plan`: one that is flyable
pub fn check_complete(spec: &CheckSpec, scenario: &Scenario, plan: &Plan, flight: &Flight) -> Check {
    let of_vehicle = |(index, vehicle): (usize, &Vehicle)| {
        let trajectory = &plan.trajectories[index];
        let planned_end_s = trajectory.end_s().unwrap_or(f64::NAN);
        let defect = match flight.vehicles.get(index) {
            None => Some("there is no log".to_owned()),
            Some(log) => log_defect(scenario, vehicle, planned_end_s, log)
                .or_else(|| flown_reference::defect(scenario, vehicle, trajectory, log)),
        };
        defect.map(|defect| format!("{}: {defect}", vehicle.name))
    };
    let surplus = flight.vehicles.iter().skip(scenario.vehicles.len());
    let no_vehicle = surplus.map(|log| format!("{}: no such vehicle, or twice", log.vehicle));
    let defects: Vec<String> = scenario.vehicles.iter().enumerate().filter_map(of_vehicle).chain(no_vehicle).collect();
    none_of(spec, defects.len(), &[], defects.first())
}

/// Number of crashes. A flight that goes through something without a word of it in its log has crashed too.
///
/// `flown`: the same flight, to look for oneself
pub fn check_crash(
    spec: &CheckSpec,
    scenario: &Scenario,
    flight: &Flight,
    flown: Evidence<'_, FlownMotions<'_>>,
) -> Check {
    let mut crashes = flight.events.iter().filter_map(crash);
    let Some((t_s, concerned)) = crashes.next() else {
        let unlogged = flown.ok().and_then(|flown| collision::deepest(scenario, &flown.motions));
        return match unlogged {
            None => spec.at_most(Measurement::value(0.0), 0.0),
            Some(touch) => spec.at_most(touch.with_reason("they touch, although the log tells of no crash"), 0.0),
        };
    };
    let count = 1 + crashes.count();
    let measured = concerned.fold(Measurement::value(count as f64).at(t_s), |measured, name| measured.with(name));
    spec.at_most(measured, 0.0)
}

/// The number that an event tells of, if it tells of one.
fn amount(kind: &EventKind) -> Option<f64> {
    match kind {
        EventKind::CableTaut { impulse_ns } => Some(*impulse_ns),
        EventKind::ReplanLate { by_s } => Some(*by_s),
        EventKind::Crash { .. }
        | EventKind::SaturationBegan
        | EventKind::SaturationEnded
        | EventKind::CableSlack
        | EventKind::Discovered { .. }
        | EventKind::ReplanRejected { .. }
        | EventKind::Arrived => None,
    }
}

/// When, and who is concerned, if an event is a crash.
fn crash(event: &Event) -> Option<(f64, impl Iterator<Item = &String>)> {
    match &event.kind {
        EventKind::Crash { obstacle } => Some((event.t_s, event.vehicles.iter().chain(obstacle))),
        EventKind::SaturationBegan
        | EventKind::SaturationEnded
        | EventKind::CableTaut { .. }
        | EventKind::CableSlack
        | EventKind::Discovered { .. }
        | EventKind::ReplanLate { .. }
        | EventKind::ReplanRejected { .. }
        | EventKind::Arrived => None,
    }
}

fn log_defect(scenario: &Scenario, vehicle: &Vehicle, planned_end_s: f64, log: &VehicleLog) -> Option<String> {
    if log.vehicle != vehicle.name {
        return Some(format!("the log of {} stands in its place", log.vehicle));
    }
    let step_s = scenario.simulation.step_s;
    let (Some(first), Some(last)) = (log.samples.first(), log.samples.last()) else {
        return Some("the log is empty".to_owned());
    };
    if exceeds(first.t_s.abs(), TIME_TOLERANCE_S) {
        return Some(format!("the log begins at {} s, which should be 0 s", first.t_s));
    }
    let is_step = |pair: &[Sample]| {
        let gap_s = pair[1].t_s - pair[0].t_s;
        gap_s > 0.0 && gap_s <= LONGEST_GAP_STEPS * step_s
    };
    if let Some(pair) = log.samples.windows(2).find(|pair| !is_step(pair)) {
        return Some(format!("after the sample at {} s comes one at {} s", pair[0].t_s, pair[1].t_s));
    }
    if exceeds(planned_end_s, last.t_s + step_s) {
        return Some(format!("the log ends at {:.3} s, before the plan, which ends at {planned_end_s:.3} s", last.t_s));
    }
    start_defect("m", first.position_m, vehicle.start.position_m(), scenario.limits().tracking_max_m)
}
