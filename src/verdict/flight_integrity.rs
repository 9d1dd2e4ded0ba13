//! Flight log integrity: the logs are whole, every number in them is finite, and no vehicle crashed.

use scenarios::{CheckSpec, Plan, Scenario, Vehicle};
use sim::{Event, EventKind, Flight, LoadSample, Sample, VehicleLog};

use crate::verdict::Check;
use crate::verdict::compare::exceeds;
use crate::verdict::evidence::{Decide, Measurement};
use crate::verdict::flown_reference::ReferenceDefect;
use crate::verdict::in_loop_planning;
use crate::verdict::integrity::none_of;
use crate::verdict::trajectory_defect::{TIME_TOLERANCE_S, start_defect};

/// Largest time between two samples, in simulator steps; the excess over 1 is rounding.
const MAX_GAP_STEPS: f64 = 1.001;

/// Number of values in the log that are not finite.
pub fn check_finite(spec: &CheckSpec, flight: &Flight) -> Check {
    let times = flight.events.iter().map(|event| event.t_s).chain([flight.step_s, flight.plan_end_s, flight.wall_s]);
    let amounts = flight.events.iter().filter_map(|event| amount(&event.kind));
    let replans = flight.planning.iter().flat_map(in_loop_planning::numbers);
    let mut count = times.chain(amounts).chain(replans).filter(|value| !value.is_finite()).count();
    let mut concerned = Vec::new();
    for log in &flight.vehicles {
        let numbers =
            log.samples.iter().flat_map(Sample::numbers).chain(log.loads.iter().flat_map(LoadSample::numbers));
        let own = numbers.filter(|value| !value.is_finite()).count();
        if own > 0 {
            concerned.push(log.vehicle.as_str());
        }
        count += own;
    }
    none_of(spec, count, &concerned, None)
}

/// Number of vehicles whose log is missing, misnamed or empty, has gaps or decreasing times, does not begin at the vehicle's
/// start, ends before the plan, or has another reference than the plan; and of logs without a vehicle. A start may be off
/// by the tracking limit, or by the radius within which the scenario draws it if that is larger.
///
/// - `plan`: flyable
/// - `reference_defect`: the family's comparison of logged and planned references
pub fn check_complete(
    spec: &CheckSpec,
    scenario: &Scenario,
    plan: &Plan,
    flight: &Flight,
    reference_defect: ReferenceDefect,
) -> Check {
    let of_vehicle = |(index, vehicle): (usize, &Vehicle)| {
        let trajectory = &plan.trajectories[index];
        let planned_end_s = trajectory.end_s().unwrap_or(f64::NAN);
        let defect = match flight.vehicles.get(index) {
            None => Some("there is no log".to_owned()),
            Some(log) => log_defect(scenario, vehicle, planned_end_s, log)
                .or_else(|| reference_defect(scenario, vehicle, trajectory, log)),
        };
        defect.map(|defect| format!("{}: {defect}", vehicle.name))
    };
    let surplus = flight.vehicles.iter().skip(scenario.vehicles.len());
    let no_vehicle = surplus.map(|log| format!("{}: there is no such vehicle, or its log is there twice", log.vehicle));
    let defects: Vec<String> = scenario.vehicles.iter().enumerate().filter_map(of_vehicle).chain(no_vehicle).collect();
    none_of(spec, defects.len(), &[], defects.first())
}

/// Number of crashes until the mission's end. A contact that the log has no event of counts as one. Crashes while all
/// vehicles coast are told, and do not decide.
///
/// - `mission_end_s`: end of the mission, s
/// - `contact`: the deepest contact in the logged motion; called if the log has no crash
pub fn check_crash(
    spec: &CheckSpec,
    flight: &Flight,
    mission_end_s: f64,
    contact: impl FnOnce() -> Option<Measurement>,
) -> Check {
    let decides = |t_s: f64| !exceeds(t_s, mission_end_s + flight.step_s);
    let mut crashes = flight.events.iter().filter_map(crash).filter(|(t_s, _)| decides(*t_s));
    let Some((t_s, concerned)) = crashes.next() else {
        return match contact() {
            None => spec.at_most(later_crash(flight), 0.0),
            Some(contact) => spec.at_most(contact.with_reason("a contact that the log has no crash for"), 0.0),
        };
    };
    let count = 1 + crashes.count();
    let measured = concerned.fold(Measurement::value(count as f64).at(t_s), |measured, name| measured.with(name));
    spec.at_most(measured, 0.0)
}

/// The first crash into an obstacle or the ground until the mission's end: its time, s, and the names of the vehicle and the
/// obstacle.
pub fn obstacle_crash(flight: &Flight, mission_end_s: f64) -> Option<(f64, [&str; 2])> {
    flight.events.iter().find_map(|event| match (&event.kind, event.vehicles.as_slice()) {
        (EventKind::Crash { obstacle: Some(obstacle) }, [vehicle, ..])
            if !exceeds(event.t_s, mission_end_s + flight.step_s) =>
        {
            Some((event.t_s, [vehicle.as_str(), obstacle.as_str()]))
        }
        _ => None,
    })
}

/// No crash, with a word on the first one after the mission's end, if there is one.
fn later_crash(flight: &Flight) -> Measurement {
    let Some((t_s, concerned)) = flight.events.iter().find_map(crash) else { return Measurement::value(0.0) };
    let names: Vec<&str> = concerned.map(String::as_str).collect();
    Measurement::value(0.0).with_reason(format!(
        "after the mission's end, while coasting: {} at {t_s:.2} s, which does not decide",
        names.join(" and ")
    ))
}

/// The number that an event carries, if any.
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
        | EventKind::ReplanFailed { .. }
        | EventKind::PlannerRemark { .. }
        | EventKind::Arrived => None,
    }
}

/// Time of a crash, s, and the names of vehicles and obstacle; `None` for any other event.
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
        | EventKind::ReplanFailed { .. }
        | EventKind::PlannerRemark { .. }
        | EventKind::Arrived => None,
    }
}

fn log_defect(scenario: &Scenario, vehicle: &Vehicle, planned_end_s: f64, log: &VehicleLog) -> Option<String> {
    if log.vehicle != vehicle.name {
        return Some(format!("the log of {} is in its place", log.vehicle));
    }
    let step_s = scenario.simulation.step_s;
    let (Some(first), Some(last)) = (log.samples.first(), log.samples.last()) else {
        return Some("the log is empty".to_owned());
    };
    if exceeds(first.t_s.abs(), TIME_TOLERANCE_S) {
        return Some(format!("the log begins at {} s, it should begin at 0 s", first.t_s));
    }
    let is_step = |pair: &[Sample]| {
        let gap_s = pair[1].t_s - pair[0].t_s;
        gap_s > 0.0 && gap_s <= MAX_GAP_STEPS * step_s
    };
    if let Some(pair) = log.samples.windows(2).find(|pair| !is_step(pair)) {
        return Some(format!("the sample at {} s is followed by one at {} s", pair[0].t_s, pair[1].t_s));
    }
    if exceeds(planned_end_s, last.t_s + step_s) {
        return Some(format!("the log ends at {:.3} s, before the plan ends at {planned_end_s:.3} s", last.t_s));
    }
    let tolerance_m = scenario.limits().tracking_max_m.max(scenario.simulation.mismatch.start_radius_m);
    start_defect("m", first.position_m, vehicle.start.position_m(), tolerance_m).map(|defect| defect.to_string())
}
