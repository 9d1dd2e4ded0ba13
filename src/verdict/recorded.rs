//! Flights that were flown elsewhere, judged by their logs alone.
//!
//! A log gives samples of position, perhaps of velocity, and perhaps where the vehicle was told to be. What it may have done
//! between two samples is unknown within its limits, so that the [law](crate::verdict::reconstruction) for plans without controls
//! holds for it, too: every motion is judged with the tube that the law allows. Whether the limits are kept, on which the law
//! rests, is asked of the same samples.

mod tracking;

use rayon::prelude::*;
use scenarios::plan_input::Setpoints;
use scenarios::{CheckSpec, Family, Group, Plan, Scenario, Vehicle, checks_of};

use crate::verdict::case::{CheckTable, function_of};
use crate::verdict::end::End;
use crate::verdict::evidence::{CheckResult, Decide, Evidence, Measurement};
use crate::verdict::integrity::none_of;
use crate::verdict::missing_evidence::MissingEvidence;
use crate::verdict::motion::Motion;
use crate::verdict::trajectory_defect::{self, TrajectoryDefect, start_defect};
use crate::verdict::{Check, GivenRows, Provenance, Status, arrival, collision, goal, separation};

/// Why the groups `nodes` and `plan` are skipped.
const NO_PLAN: &str = "a flight is judged, there is no plan";
/// Why the simulated conditions are skipped.
const NO_CONDITIONS: &str = "it was not flown in the simulator, whose wind and noise the scenario gives";
/// Why the log is not integrated again.
const NO_CONTROLS: &str = "the log gives no controls: flight.control_limits asks what the motion needs";
/// Why a speed through the air is undecided.
const NO_WIND: &str = "speeds are over ground: the log does not give the wind, and the scenario has some";

/// The log of a flight that was flown elsewhere.
#[derive(Clone, Copy, Debug)]
pub struct RecordedFlight<'a> {
    /// The scenario.
    pub scenario: &'a Scenario,
    /// The samples of every vehicle.
    pub rows: &'a Plan,
    /// What the samples give.
    pub provenance: &'a Provenance,
    /// Where the vehicles were told to be, in the order of the scenario.
    pub setpoints: &'a [Option<Setpoints>],
}

/// One vehicle's log, as its family understands it.
pub struct RecordedMotion {
    /// The motion over the whole log, in its tube.
    pub motion: Motion,
    /// When it arrived, s; the end of its log if it did not.
    pub arrival_s: f64,
    /// How far the true time of arrival may be from that, s.
    pub arrival_error_s: f64,
    /// Where and how fast it arrived.
    pub end: End,
}

/// What differs between the families in checks that they share.
#[derive(Clone, Copy)]
pub struct FamilyRules {
    /// The family.
    pub family: Family,
    /// Finds a contact with an obstacle.
    pub entered_obstacle: fn(&Scenario, &[Motion]) -> Option<Measurement>,
}

/// A log, and the evidence that all families share.
pub struct RecordedCase<'a> {
    /// The log.
    pub log: &'a RecordedFlight<'a>,
    rules: FamilyRules,
    flown: Result<Vec<RecordedMotion>, MissingEvidence>,
    /// The motions while they are judged: of vehicles that hover, whole; of others, until the last arrival.
    judged: Result<Vec<Motion>, MissingEvidence>,
}

const SHARED_CHECKS: &CheckTable<fn(&CheckSpec, &RecordedCase<'_>) -> CheckResult> = &[
    ("flight.finite", |spec, it| Ok(check_finite(spec, it.log))),
    ("flight.complete", |spec, it| Ok(check_complete(spec, it.log.scenario, it.flown()?))),
    ("flight.crash", |spec, it| {
        let contact = collision::deepest(it.log.scenario, it.judged()?, it.rules.entered_obstacle);
        Ok(spec.at_most(contact.unwrap_or_else(|| Measurement::value(0.0)), 0.0))
    }),
    ("flight.conditions", |spec, _| Ok(spec.skip(NO_CONDITIONS))),
    ("flight.planner", |spec, _| Ok(spec.skip("no planner was asked"))),
    ("flight.separation", |spec, it| separation::check(spec, it.log.scenario, it.judged())),
    ("flight.dynamics", |spec, _| Ok(spec.skip(NO_CONTROLS))),
    ("flight.goal", |spec, it| goal::check_worst(spec, it.log.scenario, |index| Ok(it.flown()?[index].end.clone()))),
    ("flight.arrival", |spec, it| check_arrival(spec, it.log.scenario, it.flown())),
    ("flight.duration", |spec, it| {
        let duration_s = last_arrival_s(it.flown()?);
        Ok(spec.at_most(Measurement::value(duration_s), it.log.scenario.simulation.max_duration_s))
    }),
    ("flight.tracking_rms", |spec, it| tracking::check_root_mean_square(spec, it.log, it.judged()?)),
    ("flight.tracking_max", |spec, it| tracking::check_largest(spec, it.log, it.judged()?)),
    ("flight.saturation", |spec, _| Ok(spec.skip("the log gives no commands"))),
    ("flight.tension", no_load),
    ("flight.slack", no_load),
    ("flight.swing", no_load),
];

fn no_load(spec: &CheckSpec, _: &RecordedCase<'_>) -> CheckResult {
    Ok(spec.skip("no vehicle carries a load"))
}

impl<'a> RecordedCase<'a> {
    /// - `of_vehicle`: the family's reading of the log of a vehicle, by its index
    pub fn new(
        log: &'a RecordedFlight<'a>,
        rules: FamilyRules,
        of_vehicle: impl Fn(usize, &Vehicle) -> Result<RecordedMotion, MissingEvidence> + Sync,
    ) -> Self {
        let vehicles = &log.scenario.vehicles;
        let read = || vehicles.par_iter().enumerate().map(|(index, vehicle)| of_vehicle(index, vehicle)).collect();
        let flown: Result<Vec<RecordedMotion>, MissingEvidence> = usable(log, rules.family).and_then(|()| read());
        let judged = flown.as_ref().map_err(MissingEvidence::from).map(|flown| judged(rules.family, flown));
        Self { log, rules, flown, judged }
    }

    /// The motions over the whole logs, with their arrivals.
    pub fn flown(&self) -> Evidence<'_, [RecordedMotion]> {
        self.flown.as_deref()
    }

    /// The motions while they are judged.
    pub fn judged(&self) -> Evidence<'_, [Motion]> {
        self.judged.as_deref()
    }

    /// Time at which the last vehicle arrives, s; infinite if the logs cannot be used.
    pub fn mission_end_s(&self) -> f64 {
        self.flown().map_or(f64::INFINITY, last_arrival_s)
    }

    /// Makes every check of the family, in the order of a verdict, on all threads.
    ///
    /// - `own`: the family's function for a check, applied; `None` if the check is one that all families share
    ///
    /// # Panics
    ///
    /// If a check has no function, which is a bug.
    pub fn checks(&self, own: impl Fn(&CheckSpec) -> Option<CheckResult> + Sync) -> Vec<Check> {
        let check = |spec: &&CheckSpec| match spec.group {
            Group::Nodes | Group::Plan => spec.skip(NO_PLAN),
            Group::Flight => {
                let shared = || Some(function_of(SHARED_CHECKS, spec)?(spec, self));
                let made = own(spec).or_else(shared).expect("every check of a flight has a function");
                made.unwrap_or_else(|missing| spec.fail(missing))
            }
        };
        let specs: Vec<&CheckSpec> = checks_of(self.rules.family).collect();
        specs.par_iter().map(check).collect()
    }
}

/// Speeds are limited relative to the air. Where the scenario has wind, speeds over ground do not show that they are kept.
pub fn without_wind(scenario: &Scenario, check: Check) -> Check {
    if scenario.simulation.wind.is_none() || check.status != Status::Pass {
        return check;
    }
    Check { status: Status::Undecided, reason: Some(NO_WIND.to_owned()), ..check }
}

/// Whether the logs can be judged: one of every vehicle, of its family, with two samples or more, all finite, at times that
/// increase from 0.
fn usable(log: &RecordedFlight<'_>, family: Family) -> Result<(), MissingEvidence> {
    let (logs, vehicles) = (log.rows.trajectories.len(), log.scenario.vehicles.len());
    if logs != vehicles {
        return Err(MissingEvidence::LogCount { logs, vehicles });
    }
    for (index, (vehicle, rows)) in log.scenario.vehicles.iter().zip(&log.rows.trajectories).enumerate() {
        let not_flyable = |defect| Err(MissingEvidence::NotFlyable { vehicle: vehicle.name.clone(), defect });
        match trajectory_defect::find(log.scenario, vehicle, rows) {
            // The start has a tolerance of its own.
            None | Some(TrajectoryDefect::Start { .. }) => {}
            Some(defect) => return not_flyable(defect),
        }
        if rows.family() != family || rows.nodes().numbers().iter().any(|value| !value.is_finite()) {
            return not_flyable(TrajectoryDefect::NotFinite);
        }
        if let Some(pair) = rows.times_s().windows(2).find(|pair| pair[0] >= pair[1]) {
            return not_flyable(TrajectoryDefect::TimeOrder { before_s: pair[0], after_s: pair[1] });
        }
        if *log.provenance.given(index) == GivenRows::Everything {
            let contradiction = format!("samples of {} cannot be its whole motion", vehicle.name);
            return Err(MissingEvidence::Contradiction(contradiction));
        }
    }
    Ok(())
}

/// The motions while they are judged.
fn judged(family: Family, flown: &[RecordedMotion]) -> Vec<Motion> {
    let mission_end_s = last_arrival_s(flown);
    let until_end = |flown: &RecordedMotion| {
        let mut motion = flown.motion.clone();
        if !family.hovers() {
            motion.end_at(mission_end_s);
        }
        motion
    };
    flown.iter().map(until_end).collect()
}

fn last_arrival_s(flown: &[RecordedMotion]) -> f64 {
    flown.iter().map(|vehicle| vehicle.arrival_s).fold(0.0, f64::max)
}

fn check_finite(spec: &CheckSpec, log: &RecordedFlight<'_>) -> Check {
    let samples = log.rows.trajectories.iter().flat_map(|rows| rows.nodes().numbers());
    let setpoints = log.setpoints.iter().flatten();
    let setpoints = setpoints.flat_map(|it| it.times_s.iter().chain(it.positions_m.iter().flatten()).copied());
    let count = samples.chain(setpoints).filter(|value| !value.is_finite()).count();
    none_of(spec, count, &[], None)
}

/// Number of vehicles whose log begins elsewhere than at the start, or ends before the last vehicle has arrived. A start may be
/// off by the tracking limit, or by the radius within which the scenario draws it if that is larger.
fn check_complete(spec: &CheckSpec, scenario: &Scenario, flown: &[RecordedMotion]) -> Check {
    let mission_end_s = last_arrival_s(flown);
    let tolerance_m = scenario.limits().tracking_max_m.max(scenario.simulation.mismatch.start_radius_m);
    let defect = |(vehicle, flown): (&Vehicle, &RecordedMotion)| {
        let first_m = flown.motion.knots()[0].position_m;
        let start = start_defect("m", first_m, vehicle.start.position_m(), tolerance_m).map(|it| it.to_string());
        let log_end_s = flown.motion.end_s();
        let early = || {
            let what =
                format!("the log ends at {log_end_s:.3} s, before the last vehicle arrives at {mission_end_s:.3} s");
            (log_end_s < mission_end_s).then_some(what)
        };
        start.or_else(early).map(|defect| format!("{}: {defect}", vehicle.name))
    };
    let defects: Vec<String> = scenario.vehicles.iter().zip(flown).filter_map(defect).collect();
    none_of(spec, defects.len(), &[], defects.first())
}

/// Time between the first and the last arrival, as well as the samples tell.
fn check_arrival(spec: &CheckSpec, scenario: &Scenario, flown: Evidence<'_, [RecordedMotion]>) -> CheckResult {
    if !scenario.fleet.simultaneous_arrival {
        return Ok(arrival::any_time(spec));
    }
    let named = || flown.map(|flown| flown.iter().zip(&scenario.vehicles));
    let by_time =
        |a: &(&RecordedMotion, &Vehicle), b: &(&RecordedMotion, &Vehicle)| a.0.arrival_s.total_cmp(&b.0.arrival_s);
    let (first, one) = named()?.min_by(by_time).ok_or(MissingEvidence::NoVehicle)?;
    let (last, other) = named()?.max_by(by_time).ok_or(MissingEvidence::NoVehicle)?;
    let spread_s = last.arrival_s - first.arrival_s;
    let error_s = 2.0 * flown?.iter().map(|vehicle| vehicle.arrival_error_s).fold(0.0, f64::max);
    let measured = Measurement::bounds((spread_s - error_s).max(0.0), spread_s + error_s).at(last.arrival_s);
    Ok(spec.at_most(measured.with(&one.name).with(&other.name), scenario.limits().arrival_spread_s))
}
