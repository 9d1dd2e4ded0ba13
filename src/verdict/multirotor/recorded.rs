//! Flights of multirotors that were flown elsewhere.
//!
//! A multirotor arrives where it stays within the tolerance of its goal until its log ends. It is judged over its whole log.

use scenarios::multirotor::Trajectory;
use scenarios::{CheckSpec, Family, Vehicle};

use super::between_nodes::BetweenNodes;
use super::{clearance, limits, rest};
use crate::verdict::case::{CheckTable, function_of};
use crate::verdict::end::End;
use crate::verdict::evidence::CheckResult;
use crate::verdict::missing_evidence::MissingEvidence;
use crate::verdict::motion::{Knot, Motion, Segment};
use crate::verdict::recorded::{FamilyRules, RecordedCase, RecordedFlight, RecordedMotion, without_wind};
use crate::verdict::tube::EndError;
use crate::verdict::{Check, EndVelocity, arrival, requirements};

const RULES: FamilyRules = FamilyRules { family: Family::Multirotor, entered_obstacle: clearance::entered_obstacle };

/// A log, and what its samples leave open.
struct Log<'a> {
    case: RecordedCase<'a>,
    between: Vec<BetweenNodes>,
}

const CHECKS: &CheckTable<fn(&CheckSpec, &Log<'_>) -> CheckResult> = &[
    ("flight.clearance", |spec, it| clearance::check(spec, it.case.log.scenario, it.case.judged()?)),
    ("flight.state_limits", |spec, it| {
        let scenario = it.case.log.scenario;
        let check = limits::check_planned_states(spec, scenario, it.case.judged()?, &it.between)?;
        Ok(without_wind(scenario, check))
    }),
    ("flight.control_limits", |spec, it| {
        limits::check_accelerations(spec, it.case.log.scenario, it.case.judged()?, &it.between)
    }),
    ("flight.rest", |spec, it| {
        let motions = it.case.judged()?;
        rest::check_fastest(spec, it.case.log.scenario, |index| {
            let last = motions.get(index)?.knots().last()?;
            let given = EndVelocity { velocity_mps: last.velocity_mps, error_mps: 0.0 };
            Some((it.case.log.provenance.end_velocity(index).unwrap_or(given), last.t_s))
        })
    }),
];

/// Every check of a flight of multirotors that was flown elsewhere, in the order of a verdict.
pub fn checks(log: &RecordedFlight<'_>) -> Vec<Check> {
    let vehicles = log.scenario.vehicles.iter().enumerate();
    let between = |(index, vehicle)| BetweenNodes::of(log.provenance, index, log.scenario.multirotor_model(vehicle));
    let between: Vec<BetweenNodes> = vehicles.map(between).collect();
    let case = RecordedCase::new(log, RULES, |index, vehicle| recorded(log, &between[index], index, vehicle));
    let log = Log { case, between };
    let mut checks = log.case.checks(|spec| Some(function_of(CHECKS, spec)?(spec, &log)));
    requirements::append_recorded(&mut checks, log.case.log.scenario, log.case.judged());
    checks
}

fn recorded(
    log: &RecordedFlight<'_>,
    between: &BetweenNodes,
    index: usize,
    vehicle: &Vehicle,
) -> Result<RecordedMotion, MissingEvidence> {
    let rows: &Trajectory = log.rows.trajectories[index].multirotor();
    let knots: Vec<Knot> = rows
        .nodes()
        .iter()
        .map(|node| Knot { t_s: node.t_s, position_m: node.position_m, velocity_mps: node.velocity_mps })
        .collect();
    let samples: Vec<(f64, [f64; 3])> = knots.iter().map(|knot| (knot.t_s, knot.position_m)).collect();
    let longest_s = knots.windows(2).map(|pair| pair[1].t_s - pair[0].t_s).fold(0.0, f64::max);
    let (last, rounding_m) = (knots[knots.len() - 1], log.provenance.rounding_m(index));
    let reached_s = arrival::reached_s(samples.into_iter(), vehicle, log.scenario.limits().goal_m);
    let motion = Motion::new(&vehicle.name, knots)?;
    Ok(RecordedMotion {
        motion: motion.within(|segment: &Segment| between.distance_m(segment) + rounding_m),
        arrival_s: reached_s.unwrap_or(last.t_s),
        arrival_error_s: longest_s,
        end: End::at(vehicle, &last, EndError { position_m: rounding_m, velocity_mps: 0.0 }),
    })
}
