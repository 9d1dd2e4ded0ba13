//! Limits that are tightened to just below the value reached. Their counterparts, just above it, are near misses.

use scenarios::Family;

use super::super::{Fault, ReferenceCase};

/// A limit of the scenario, and the checks that it decides.
pub struct TightenedLimit {
    /// What the limit is, for a person to read.
    pub name: &'static str,
    /// The checks, by their full names.
    pub checks: &'static [&'static str],
    /// Sets the limit.
    pub set: fn(&mut ReferenceCase, f64),
}

/// Limits that a value may not exceed, in the unit of the check.
const OF_ALL: &[TightenedLimit] = &[
    limit("the longest duration", &["plan.duration", "flight.duration"], |it, limit| {
        it.scenario.simulation.max_duration_s = limit;
    }),
    limit("the limit of the tracking error", &["flight.tracking_max"], |it, limit| {
        it.scenario.verdict.tracking_max_m = Some(limit);
    }),
    limit("the limit of the mean tracking error", &["flight.tracking_rms"], |it, limit| {
        it.scenario.verdict.tracking_rms_m = Some(limit);
    }),
];

const OF_FIXED_WINGS: &[TightenedLimit] = &[
    DEFECTS,
    GOALS,
    limit("the limit of the open-loop error", &["plan.rollout"], |it, limit| {
        it.scenario.verdict.rollout_m = Some(limit);
    }),
    limit("the limit of the spread of arrivals", &["flight.arrival"], |it, limit| {
        it.scenario.verdict.arrival_spread_s = Some(limit);
    }),
];

const OF_SLUNG_LOADS: &[TightenedLimit] = &[
    DEFECTS,
    GOALS,
    limit("the limit of the speed at the end", &["plan.rest", "flight.rest"], |it, limit| {
        it.scenario.verdict.rest_mps = Some(limit);
    }),
    limit("what the cable bears", &["plan.tension", "flight.tension"], |it, limit| {
        it.slung_load_model().limits.tension_n = limit;
    }),
    limit("the limit of the time between planned and flown switches", &["flight.slack"], |it, limit| {
        it.scenario.verdict.switch_s = Some(limit);
    }),
];

// A multirotor's plan ends in its goal to the last bit: below that there is no limit.
const OF_MULTIROTORS: &[TightenedLimit] = &[
    limit("the limit of the distance from the goal", &["flight.goal"], |it, limit| {
        it.scenario.verdict.goal_m = Some(limit);
    }),
    limit("the limit of the speed at the end", &["flight.rest"], |it, limit| {
        it.scenario.verdict.rest_mps = Some(limit);
    }),
];

const DEFECTS: TightenedLimit =
    limit("the limit of the defects", &["plan.dynamics"], |it, limit| it.scenario.verdict.dynamics_m = Some(limit));
const GOALS: TightenedLimit =
    limit("the limit of the distance from the goal", &["nodes.goal", "plan.goal", "flight.goal"], |it, limit| {
        it.scenario.verdict.goal_m = Some(limit);
    });

/// How far a limit is from what was reached, as a share of it.
pub const SHARE: f64 = 1e-6;

const fn limit(
    name: &'static str,
    checks: &'static [&'static str],
    set: fn(&mut ReferenceCase, f64),
) -> TightenedLimit {
    TightenedLimit { name, checks, set }
}

/// The limits that a value of this family may not exceed.
pub fn at_most(family: Family) -> impl Iterator<Item = &'static TightenedLimit> {
    let of_family = match family {
        Family::FixedWing => OF_FIXED_WINGS,
        Family::SlungLoad => OF_SLUNG_LOADS,
        Family::Multirotor => OF_MULTIROTORS,
    };
    OF_ALL.iter().chain(of_family)
}

/// The faults.
pub fn faults(family: Family) -> Vec<Fault> {
    let mut all = Vec::new();
    for limit in at_most(family) {
        for check in limit.checks {
            let name: &'static str = limit.name;
            all.push(Fault::new(check, name, move |it| {
                let reached = it.value(check);
                (limit.set)(it, reached * (1.0 - SHARE));
            }));
        }
    }
    let distances: &[&'static str] = match family {
        Family::FixedWing | Family::Multirotor => &["nodes.separation", "plan.separation", "flight.separation"],
        Family::SlungLoad => &["nodes.envelope", "plan.envelope"],
    };
    all.extend(distances.iter().map(|check| {
        Fault::new(check, "a distance that is to be kept is longer than the smallest one", move |it| {
            let reached_m = it.value(check);
            keep_apart(it, reached_m + 1e-6);
        })
    }));
    all
}

/// Sets the distance to keep: between vehicles, or of the envelope from obstacles.
pub fn keep_apart(it: &mut ReferenceCase, limit_m: f64) {
    match it.family() {
        Family::FixedWing | Family::Multirotor => it.scenario.fleet.separation_m = Some(limit_m),
        Family::SlungLoad => it.scenario.verdict.envelope_m = Some(limit_m),
    }
}
