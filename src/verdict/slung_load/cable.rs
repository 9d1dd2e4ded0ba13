//! What does the cable do, and does the flight's cable do what the plan's does?

use scenarios::slung_load::{Cable, Model, Trajectory};
use sim::slung_load::MIN_PHASE_S;
use sim::{EventKind, Flight, VehicleLog};

use super::planned::PlannedMotion;
use crate::verdict::compare::{exceeds, is_larger, is_smaller};
use crate::verdict::evidence::{Decide, Evidence, Measurement};
use crate::verdict::{Check, LimitKey};
use scenarios::CheckSpec;

/// Tension is judged by its mean over this time, s: a stiff cable has no finite peak at an impact, but an impulse.
pub const TENSION_WINDOW_S: f64 = 0.02;
/// A plan's tension may fall below 0 by this much, N: what a solver's tolerance leaves.
const PUSH_N: f64 = 1e-3;

/// The plan's tension: never below 0 in a taut cable, which cannot push, and its mean, impacts included, below what the
/// cable bears.
pub fn check_planned_tension(
    spec: &CheckSpec,
    model: &Model,
    vehicle: &str,
    planned: Evidence<'_, PlannedMotion>,
) -> Check {
    let planned = match planned {
        Err(reason) => return spec.fail(reason),
        Ok(planned) => planned,
    };
    if let Some(push) = push(spec, vehicle, planned.knots.iter().map(|knot| (knot.t_s, knot.tension_n))) {
        return push;
    }
    let mut impulses: Vec<(f64, f64)> = planned.impacts.clone();
    let pairs = planned.knots.windows(2).filter(|pair| pair[1].t_s > pair[0].t_s);
    impulses.extend(pairs.map(|pair| {
        let mean_n = f64::midpoint(pair[0].tension_n, pair[1].tension_n);
        (pair[1].t_s, mean_n * (pair[1].t_s - pair[0].t_s))
    }));
    highest_mean(spec, vehicle, impulses, model.limits.tension_n)
}

/// The flown tension: never below 0 either, and its mean below what the cable bears.
pub fn check_flown_tension(spec: &CheckSpec, model: &Model, log: Evidence<'_, VehicleLog>) -> Check {
    match log {
        Err(reason) => spec.fail(reason),
        Ok(log) => {
            let tensions = log.samples.iter().zip(&log.loads).map(|(sample, load)| (sample.t_s, load.tension_n));
            if let Some(push) = push(spec, &log.vehicle, tensions) {
                return push;
            }
            let steps = log.samples.windows(2).zip(log.loads.iter().skip(1));
            let impulses = steps.map(|(pair, load)| (pair[1].t_s, load.tension_n * (pair[1].t_s - pair[0].t_s)));
            highest_mean(spec, &log.vehicle, impulses.collect(), model.limits.tension_n)
        }
    }
}

/// The failed check of a cable that would have to push, by tensions, N, at their times, s; `None` if it never does.
fn push(spec: &CheckSpec, vehicle: &str, tensions: impl Iterator<Item = (f64, f64)>) -> Option<Check> {
    let (at_s, lowest_n) = tensions.reduce(|a, b| if is_smaller(b.1, a.1) { b } else { a })?;
    if !exceeds(-PUSH_N, lowest_n) {
        return None;
    }
    let measured = Measurement::value(lowest_n).at(at_s).with(vehicle);
    Some(spec.at_least(measured.with_reason("a cable that is taut would have to push"), -PUSH_N))
}

/// The highest mean over the window, of impulses, N s, and the times until which they came, s.
fn highest_mean(spec: &CheckSpec, vehicle: &str, mut impulses: Vec<(f64, f64)>, limit_n: f64) -> Check {
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
    match highest {
        None => spec.fail("there is no motion"),
        Some((mean_n, at_s)) => {
            let measured = Measurement::value(mean_n).at(at_s).with(vehicle);
            Check { limit_key: Some(LimitKey::Limits("tension_n")), ..spec.at_most(measured, limit_n) }
        }
    }
}

/// Largest difference between the cable's length and what the plan says of it: a taut one has its full length, a slack one
/// is not longer.
pub fn check_planned_cable(
    spec: &CheckSpec,
    model: &Model,
    trajectory: Evidence<'_, Trajectory>,
    planned: Evidence<'_, PlannedMotion>,
    limit_m: f64,
) -> Check {
    let (trajectory, planned) = match trajectory.and_then(|trajectory| Ok((trajectory, planned?))) {
        Err(reason) => return spec.fail(reason),
        Ok(both) => both,
    };
    let taut = trajectory.states.iter().enumerate().map(|(node, state)| {
        let beyond_m = state.cable_length_m() - model.cable_length_m;
        let is_taut = trajectory.cable[node] == Cable::Taut;
        (trajectory.times_s[node], if is_taut { beyond_m.abs() } else { beyond_m.max(0.0) })
    });
    let slack =
        planned.knots.iter().map(|knot| (knot.t_s, (knot.body.cable_m().norm() - model.cable_length_m).max(0.0)));
    match taut.chain(slack).reduce(|worst, next| if is_larger(next.1, worst.1) { next } else { worst }) {
        None => spec.fail("the plan has no node"),
        Some((at_s, beyond_m)) => {
            spec.at_most(Measurement::value(beyond_m).at(at_s).with(&trajectory.vehicle), limit_m)
        }
    }
}

/// Largest difference between the samples at which the planned and the flown cable become taut or slack. Phases shorter
/// than 10 ms do not count; one that has no counterpart fails.
pub fn check_flown_cable(
    spec: &CheckSpec,
    trajectory: Evidence<'_, Trajectory>,
    flight: Evidence<'_, Flight>,
    limit_s: f64,
) -> Check {
    let (trajectory, flight) = match trajectory.and_then(|trajectory| Ok((trajectory, flight?))) {
        Err(reason) => return spec.fail(reason),
        Ok(both) => both,
    };
    if let Some(contradiction) = flight.vehicles.iter().find_map(contradiction) {
        return spec.fail(contradiction);
    }
    let planned = planned_switches(trajectory);
    let flown: Vec<(f64, Cable)> =
        flight.events.iter().filter_map(|event| Some((event.t_s, switch(&event.kind)?))).collect();
    let kinds = |switches: &[(f64, Cable)]| switches.iter().map(|(_, cable)| *cable).collect::<Vec<_>>();
    if kinds(&planned) != kinds(&flown) {
        let reason = format!("planned: {}; flown: {}", in_words(&planned), in_words(&flown));
        return spec.fail(reason);
    }
    let differences =
        planned.iter().zip(&flown).map(|((planned_s, _), (flown_s, _))| (*planned_s, (planned_s - flown_s).abs()));
    match differences.reduce(|worst, next| if is_larger(next.1, worst.1) { next } else { worst }) {
        None => spec.at_most(Measurement::value(0.0).with(&trajectory.vehicle), limit_s),
        Some((at_s, late_s)) => spec.at_most(Measurement::value(late_s).at(at_s).with(&trajectory.vehicle), limit_s),
    }
}

/// Where a log calls the cable taut and it does not pull, or slack and it does, for too long to be a matter of when exactly
/// it switched, in words.
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

/// When the planned cable becomes what, phases that are too short to count left out.
fn planned_switches(trajectory: &Trajectory) -> Vec<(f64, Cable)> {
    let mut switches: Vec<(f64, Cable)> = Vec::new();
    for (node, pair) in trajectory.cable.windows(2).enumerate() {
        if pair[0] == pair[1] {
            continue;
        }
        let t_s = trajectory.times_s[node + 1];
        match switches.last() {
            Some((began_s, _)) if t_s - began_s < MIN_PHASE_S => {
                switches.pop();
            }
            _ => switches.push((t_s, pair[1])),
        }
    }
    // A phase that begins as the plan ends is that of what comes after.
    let end_s = trajectory.times_s.last().copied().unwrap_or(0.0);
    switches.retain(|(t_s, _)| *t_s < end_s);
    switches
}

fn in_words(switches: &[(f64, Cable)]) -> String {
    let words = switches.iter().map(|(t_s, cable)| match cable {
        Cable::Taut => format!("taut at {t_s:.3} s"),
        Cable::Slack => format!("slack at {t_s:.3} s"),
    });
    let words: Vec<String> = words.collect();
    if words.is_empty() { "no switch".to_owned() } else { words.join(", ") }
}
