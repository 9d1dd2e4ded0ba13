//! Limits that are tightened to just below the value reached. Their counterparts, just above it, are near misses.

use super::super::family::FamilySelftest;
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

/// The limit of `plan.dynamics`.
pub const DEFECTS: TightenedLimit =
    limit("the limit of the defects", &["plan.dynamics"], |it, limit| it.scenario.verdict.dynamics_m = Some(limit));
/// The limit of the distance from the goal.
pub const GOALS: TightenedLimit =
    limit("the limit of the distance from the goal", &["nodes.goal", "plan.goal", "flight.goal"], |it, limit| {
        it.scenario.verdict.goal_m = Some(limit);
    });

/// Distance of a limit from the value reached, relative to it.
pub const SHARE: f64 = 1e-6;

/// A limit that `set` sets, and the checks that it decides.
pub const fn limit(
    name: &'static str,
    checks: &'static [&'static str],
    set: fn(&mut ReferenceCase, f64),
) -> TightenedLimit {
    TightenedLimit { name, checks, set }
}

/// The limits of a family, those of all families first.
pub fn all(family: &'static FamilySelftest) -> impl Iterator<Item = &'static TightenedLimit> {
    OF_ALL.iter().chain(family.limits)
}

/// One fault for every limit and every check that it decides.
pub fn faults(family: &'static FamilySelftest) -> Vec<Fault> {
    let mut faults = Vec::new();
    for limit in all(family) {
        for check in limit.checks {
            faults.push(Fault::new(check, limit.name, move |it| {
                let reached = it.value(check);
                (limit.set)(it, reached * (1.0 - SHARE));
            }));
        }
    }
    faults.extend(family.distances.iter().map(|check| {
        Fault::new(check, "a distance that is to be kept is longer than the smallest one", move |it| {
            let reached_m = it.value(check);
            (family.keep_apart)(it, reached_m + 1e-6);
        })
    }));
    faults
}
