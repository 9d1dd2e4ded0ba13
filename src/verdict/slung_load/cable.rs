//! The cable: its tension, its length, and the times at which it becomes taut or slack.

use scenarios::CheckSpec;
use scenarios::slung_load::{Cable, Model, Trajectory};
use sim::slung_load::MIN_PHASE_S;
use sim::{Event, EventKind, Flight, VehicleLog};

use super::planned::PlannedMotion;
use crate::number_format::quantity;
use crate::verdict::compare::{exceeds, is_larger, is_smaller};
use crate::verdict::evidence::{CheckResult, Decide, Measurement};
use crate::verdict::missing_evidence::MissingEvidence;
use crate::verdict::{Check, LimitKey};

/// The tension is averaged over this time, s: at an impact a stiff cable has an impulse and no finite peak.
pub const TENSION_WINDOW_S: f64 = 0.02;
/// Largest number of switches that a reason names.
const MAX_NAMED: usize = 8;
/// Times that differ by less than this, s, are equal up to rounding.
const SAME_TIME_S: f64 = 1e-9;
/// A planned tension may be this far below 0, N: the tolerance of a solver.
const PUSH_TOLERANCE_N: f64 = 1e-3;

/// The planned tension: at least 0 while the cable is taut, since a cable cannot push, and its mean, impacts included, at most
/// the cable's limit.
pub fn check_planned_tension(spec: &CheckSpec, model: &Model, vehicle: &str, planned: &PlannedMotion) -> CheckResult {
    if let Some(push) = push(spec, vehicle, planned.knots.iter().map(|knot| (knot.t_s, knot.tension_n))) {
        return Ok(push);
    }
    let mut impulses: Vec<(f64, f64)> = planned.impacts.clone();
    let pairs = planned.knots.windows(2).filter(|pair| pair[1].t_s > pair[0].t_s);
    impulses.extend(pairs.map(|pair| {
        let mean_n = f64::midpoint(pair[0].tension_n, pair[1].tension_n);
        (pair[1].t_s, mean_n * (pair[1].t_s - pair[0].t_s))
    }));
    highest_mean(spec, vehicle, impulses, model.limits.tension_n).map(|check| with_impact(check, &planned.impacts))
}

/// The flown tension: at least 0, and its mean at most the cable's limit.
pub fn check_flown_tension(spec: &CheckSpec, model: &Model, log: &VehicleLog, events: &[Event]) -> CheckResult {
    let tensions = log.samples.iter().zip(&log.loads).map(|(sample, load)| (sample.t_s, load.tension_n));
    if let Some(push) = push(spec, &log.vehicle, tensions) {
        return Ok(push);
    }
    let steps = log.samples.windows(2).zip(log.loads.iter().skip(1));
    let impulses = steps.map(|(pair, load)| (pair[1].t_s, load.tension_n * (pair[1].t_s - pair[0].t_s)));
    let impacts = events.iter().filter_map(|event| match event.kind {
        EventKind::CableTaut { impulse_ns } => Some((event.t_s, impulse_ns)),
        _ => None,
    });
    highest_mean(spec, &log.vehicle, impulses.collect(), model.limits.tension_n)
        .map(|check| with_impact(check, &impacts.collect::<Vec<_>>()))
}

/// The check with a remark on the largest impact, whose peak is not known.
///
/// - `impacts`: times, s, and impulses, N s
fn with_impact(check: Check, impacts: &[(f64, f64)]) -> Check {
    let largest = impacts.iter().reduce(|a, b| if is_larger(b.1, a.1) { b } else { a });
    let remark = largest.map(|(t_s, impulse_ns)| {
        let impulse = quantity(*impulse_ns, "N s");
        format!("impact of {impulse} at {t_s:.2} s: its peak depends on the cable's stiffness, and is not judged")
    });
    Check { reason: remark.or(check.reason.clone()), ..check }
}

/// The failed check of a taut cable with a negative tension; `None` if there is none.
///
/// - `tensions`: times, s, and tensions, N
fn push(spec: &CheckSpec, vehicle: &str, tensions: impl Iterator<Item = (f64, f64)>) -> Option<Check> {
    let (at_s, lowest_n) = tensions.reduce(|a, b| if is_smaller(b.1, a.1) { b } else { a })?;
    if !exceeds(-PUSH_TOLERANCE_N, lowest_n) {
        return None;
    }
    let measured = Measurement::value(lowest_n).at(at_s).with(vehicle);
    Some(spec.at_least(measured.with_reason("the taut cable would have to push"), -PUSH_TOLERANCE_N))
}

/// The check of the highest mean tension over the window.
///
/// - `impulses`: the ends of the intervals in which they acted, s, and the impulses, N s
fn highest_mean(spec: &CheckSpec, vehicle: &str, mut impulses: Vec<(f64, f64)>, limit_n: f64) -> CheckResult {
    impulses.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut highest: Option<(f64, f64)> = None;
    let mut first = 0;
    for (last, (t_s, _)) in impulses.iter().enumerate() {
        while impulses[first].0 <= t_s - TENSION_WINDOW_S {
            first += 1;
        }
        let mean_n = impulses[first..=last].iter().map(|(_, impulse_ns)| impulse_ns).sum::<f64>() / TENSION_WINDOW_S;
        if highest.is_none_or(|(so_far_n, _)| is_larger(mean_n, so_far_n)) {
            highest = Some((mean_n, *t_s));
        }
    }
    let (mean_n, at_s) = highest.ok_or(MissingEvidence::NoInterval)?;
    let measured = Measurement::value(mean_n).at(at_s).with(vehicle);
    Ok(Check { limit_key: Some(LimitKey::Limits("tension_n")), ..spec.at_most(measured, limit_n) })
}

/// Largest difference between the cable's length and its planned state: a taut cable has its full length, a slack one is not
/// longer.
pub fn check_planned_cable(
    spec: &CheckSpec,
    model: &Model,
    trajectory: &Trajectory,
    planned: &PlannedMotion,
    limit_m: f64,
) -> CheckResult {
    let taut = trajectory.states.iter().enumerate().map(|(node, state)| {
        let beyond_m = state.cable_length_m() - model.cable_length_m;
        let is_taut = trajectory.cable[node] == Cable::Taut;
        (trajectory.times_s[node], if is_taut { beyond_m.abs() } else { beyond_m.max(0.0) })
    });
    let slack =
        planned.knots.iter().map(|knot| (knot.t_s, (knot.state.cable_m().norm() - model.cable_length_m).max(0.0)));
    let worst = taut.chain(slack).reduce(|worst, next| if is_larger(next.1, worst.1) { next } else { worst });
    let (at_s, beyond_m) = worst.ok_or(MissingEvidence::NoNode)?;
    Ok(spec.at_most(Measurement::value(beyond_m).at(at_s).with(&trajectory.vehicle), limit_m))
}

/// Largest difference between the times at which the planned and the flown cable become taut or slack. A switch without a
/// counterpart fails; that of a planned phase shorter than 10 ms has none, since no such phase is detected in flight.
pub fn check_flown_cable(spec: &CheckSpec, trajectory: &Trajectory, flight: &Flight, limit_s: f64) -> CheckResult {
    if let Some(contradiction) = flight.vehicles.iter().find_map(contradiction) {
        return Err(MissingEvidence::Contradiction(contradiction));
    }
    let planned = planned_switches(trajectory);
    let flown: Vec<(f64, Cable)> =
        flight.events.iter().filter_map(|event| Some((event.t_s, switch(&event.kind)?))).collect();
    let kinds = |switches: &[(f64, Cable)]| switches.iter().map(|(_, cable)| *cable).collect::<Vec<_>>();
    if kinds(&planned) != kinds(&flown) {
        let short = planned.windows(2).find(|pair| pair[1].0 - pair[0].0 < MIN_PHASE_S);
        let remark = short.map_or_else(String::new, |pair| {
            format!("; planned phases shorter than {MIN_PHASE_S} s, as the one at {:.3} s, are not detected", pair[0].0)
        });
        return Ok(spec.fail(format!("planned: {}; flown: {}{remark}", in_words(&planned), in_words(&flown))));
    }
    let differences =
        planned.iter().zip(&flown).map(|((planned_s, _), (flown_s, _))| (*planned_s, (planned_s - flown_s).abs()));
    let measured = match differences.reduce(|worst, next| if is_larger(next.1, worst.1) { next } else { worst }) {
        None => Measurement::value(0.0),
        Some((at_s, late_s)) => Measurement::value(late_s).at(at_s),
    };
    Ok(spec.at_most(measured.with(&trajectory.vehicle), limit_s))
}

/// Where the logged state of the cable contradicts its tension for longer than the detection of a switch takes, in words.
fn contradiction(log: &VehicleLog) -> Option<String> {
    let mut since_s: Option<f64> = None;
    for (pair, load) in log.samples.windows(2).zip(log.loads.iter().skip(1)) {
        let is_pulling = load.tension_n > 0.0;
        if is_pulling == (load.cable == Cable::Taut) {
            since_s = None;
            continue;
        }
        let began_s = *since_s.get_or_insert(pair[0].t_s);
        if pair[1].t_s - began_s > 2.0 * MIN_PHASE_S + (pair[1].t_s - pair[0].t_s) {
            let (called, does) = if is_pulling { ("slack", "pulls") } else { ("taut", "does not pull") };
            return Some(format!("from {began_s:.3} s on the log calls the cable {called}, but it {does}"));
        }
    }
    None
}

fn switch(kind: &EventKind) -> Option<Cable> {
    match kind {
        EventKind::CableTaut { .. } => Some(Cable::Taut),
        EventKind::CableSlack => Some(Cable::Slack),
        _ => None,
    }
}

/// Times at which the planned cable becomes taut or slack, without phases that last no time.
fn planned_switches(trajectory: &Trajectory) -> Vec<(f64, Cable)> {
    let mut switches: Vec<(f64, Cable)> = Vec::new();
    for (node, pair) in trajectory.cable.windows(2).enumerate() {
        if pair[0] == pair[1] {
            continue;
        }
        let t_s = trajectory.times_s[node + 1];
        match switches.last() {
            Some((began_s, _)) if t_s - began_s < SAME_TIME_S => {
                switches.pop();
            }
            _ => switches.push((t_s, pair[1])),
        }
    }
    // A phase that begins at the end of the plan is not part of it.
    let end_s = trajectory.times_s.last().copied().unwrap_or(0.0);
    switches.retain(|(t_s, _)| *t_s < end_s);
    switches
}

fn in_words(switches: &[(f64, Cable)]) -> String {
    let words = switches.iter().map(|(t_s, cable)| match cable {
        Cable::Taut => format!("taut at {t_s:.3} s"),
        Cable::Slack => format!("slack at {t_s:.3} s"),
    });
    let words: Vec<String> = words.take(MAX_NAMED).collect();
    let more = switches.len() - words.len();
    match (words.is_empty(), more) {
        (true, _) => "no switch".to_owned(),
        (false, 0) => words.join(", "),
        (false, more) => format!("{} and {more} more", words.join(", ")),
    }
}
