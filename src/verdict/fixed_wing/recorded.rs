//! Flights of fixed wings that were flown elsewhere.
//!
//! A fixed wing arrives where it is closest to its goal. All are judged until the last one has arrived, so that their logs must
//! go on until then.

use scenarios::{CheckSpec, Family, Plan, Trajectory, Vehicle, fixed_wing};

use super::between_rows::RowTube;
use super::{clearance, limits, planned};
use crate::verdict::case::{CheckTable, function_of};
use crate::verdict::closest;
use crate::verdict::end::End;
use crate::verdict::evidence::CheckResult;
use crate::verdict::missing_evidence::MissingEvidence;
use crate::verdict::motion::{Knot, Motion};
use crate::verdict::recorded::{FamilyRules, RecordedCase, RecordedFlight, RecordedMotion, without_wind};
use crate::verdict::tube::EndError;
use crate::verdict::{Check, requirements};

const RULES: FamilyRules = FamilyRules { family: Family::FixedWing, entered_obstacle: clearance::entered_obstacle };

/// A log, and what its samples leave open.
struct Log<'a> {
    case: RecordedCase<'a>,
    tubes: Vec<RowTube>,
}

const CHECKS: &CheckTable<fn(&CheckSpec, &Log<'_>) -> CheckResult> = &[
    ("flight.clearance", |spec, it| clearance::check(spec, it.case.log.scenario, it.case.judged(), |_| Ok(&[]))),
    ("flight.state_limits", |spec, it| {
        let scenario = it.case.log.scenario;
        let check = limits::check_planned_states(spec, scenario, it.case.judged()?, &[], &it.tubes)?;
        Ok(without_wind(scenario, check))
    }),
    ("flight.control_limits", |spec, it| {
        it.case.judged()?;
        let rows = until(it.case.log.rows, it.case.mission_end_s());
        let mut check = limits::check_planned_controls(spec, it.case.log.scenario, &rows)?;
        it.case.log.provenance.mark_controls_undecided(&mut check);
        // Load factors are along and across the velocity through the air.
        Ok(without_wind(it.case.log.scenario, check))
    }),
];

/// Every check of a flight of fixed wings that was flown elsewhere, in the order of a verdict.
pub fn checks(log: &RecordedFlight<'_>) -> Vec<Check> {
    let case = RecordedCase::new(log, RULES, |index, vehicle| {
        let (motion, tube) = motion_in_tube(log, index, vehicle)?;
        recorded(vehicle, motion, &tube)
    });
    let tube = |(index, vehicle)| motion_in_tube(log, index, vehicle).map_or_else(|_| RowTube::default(), |it| it.1);
    let tubes = match case.judged() {
        Ok(_) => log.scenario.vehicles.iter().enumerate().map(tube).collect(),
        Err(_) => Vec::new(),
    };
    let log = Log { case, tubes };
    let mut checks = log.case.checks(|spec| Some(function_of(CHECKS, spec)?(spec, &log)));
    requirements::append_recorded(&mut checks, log.case.log.scenario, log.case.judged());
    checks
}

/// The motion between the samples, and what they leave open.
fn motion_in_tube(
    log: &RecordedFlight<'_>,
    index: usize,
    vehicle: &Vehicle,
) -> Result<(Motion, RowTube), MissingEvidence> {
    let rows = log.rows.trajectories[index].fixed_wing();
    let motion = planned::between_rows(rows)?;
    let (given, end_velocity) = (log.provenance.given(index), log.provenance.end_velocity(index));
    let (last, limits) = (rows.times_s.len() - 1, &log.scenario.fixed_wing_model(vehicle).limits);
    let tube = RowTube::around(&motion, rows, given, end_velocity, last, limits);
    let tube = tube.widened(log.provenance.rounding_m(index));
    Ok((tube.tube.surround(motion), tube))
}

fn recorded(vehicle: &Vehicle, motion: Motion, tube: &RowTube) -> Result<RecordedMotion, MissingEvidence> {
    let whole_s = [motion.knots()[0].t_s, motion.end_s()];
    let approach = closest::to_point(&motion, whole_s, vehicle.goal.position_m()).ok_or(MissingEvidence::NoInterval)?;
    let at_s = approach.at_s;
    let Knot { velocity_mps, .. } =
        motion.state(at_s).ok_or_else(|| MissingEvidence::EndsEarly { vehicle: vehicle.name.clone() })?;
    let error = EndError { position_m: tube.tube.distance_m([at_s, at_s]), velocity_mps: tube.tube.velocity_mps(at_s) };
    let speed_mps = velocity_mps.iter().map(|it| it * it).sum::<f64>().sqrt();
    Ok(RecordedMotion {
        motion,
        arrival_s: at_s,
        arrival_error_s: error.position_m / speed_mps.max(f64::MIN_POSITIVE),
        end: End { t_s: at_s, distance_m: [approach.lower_m, approach.upper_m], velocity_mps, error },
    })
}

/// The rows up to the first one at or beyond `t_s`.
fn until(rows: &Plan, t_s: f64) -> Plan {
    let cut = |trajectory: &Trajectory| {
        let rows = trajectory.fixed_wing();
        let count = (rows.times_s.partition_point(|row_s| *row_s < t_s) + 1).min(rows.times_s.len());
        let controls = rows.controls[..count].to_vec();
        let (times_s, states) = (rows.times_s[..count].to_vec(), rows.states[..count].to_vec());
        fixed_wing::Trajectory { times_s, states, controls, ..rows.clone() }.into()
    };
    Plan { trajectories: rows.trajectories.iter().map(cut).collect(), ..rows.clone() }
}
