//! Limits tightened to just below the value reached. Their counterparts, just above it, are near misses.

use scenarios::check_spec;

use super::super::{Fault, ReferenceCase};
use crate::verdict::tolerance;

/// A limit of the scenario, and the checks that it bounds.
pub struct TightenedLimit {
    /// Description of the limit.
    pub name: &'static str,
    /// The checks, by their full names.
    pub checks: &'static [&'static str],
    /// Sets the limit, in the unit of the checks.
    pub set: fn(&mut ReferenceCase, f64),
}

/// What is tightened for one family.
pub struct FamilyLimits {
    /// Upper limits of its checks, besides those of all families.
    pub upper: &'static [TightenedLimit],
    /// Checks of the distance that `set_distance` sets.
    pub distance_checks: &'static [&'static str],
    /// Sets the smallest distance that is allowed, m.
    pub set_distance: fn(&mut ReferenceCase, f64),
}

/// Upper limits of all families.
const COMMON: &[TightenedLimit] = &[
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

/// The limit of the defects.
pub const DEFECTS: TightenedLimit =
    limit("the limit of the defects", &["plan.dynamics"], |it, limit| it.scenario.verdict.dynamics_m = Some(limit));

/// The limit of the distance from the goal.
pub const GOALS: TightenedLimit =
    limit("the limit of the distance from the goal", &["nodes.goal", "plan.goal", "flight.goal"], |it, limit| {
        it.scenario.verdict.goal_m = Some(limit);
    });

/// The checks of the distance between vehicles.
pub const SEPARATION_CHECKS: &[&str] = &["nodes.separation", "plan.separation", "flight.separation"];

/// Distance of a tightened limit from the value reached, as a fraction of it.
pub const RELATIVE_STEP: f64 = 1e-6;

/// One limit.
pub const fn limit(
    name: &'static str,
    checks: &'static [&'static str],
    set: fn(&mut ReferenceCase, f64),
) -> TightenedLimit {
    TightenedLimit { name, checks, set }
}

/// The upper limits of a family.
pub fn upper(limits: &FamilyLimits) -> impl Iterator<Item = &'static TightenedLimit> {
    COMMON.iter().chain(limits.upper)
}

/// The faults.
pub fn faults(limits: &'static FamilyLimits) -> Vec<Fault> {
    let mut all = Vec::new();
    for limit in upper(limits) {
        for check in limit.checks {
            all.push(Fault::new(check, limit.name, move |it| {
                let reached = it.value(check);
                (limit.set)(it, reached * (1.0 - RELATIVE_STEP) - beyond_tolerance(check, reached));
            }));
        }
    }
    all.extend(limits.distance_checks.iter().map(|check| {
        Fault::new(check, "the required distance is larger than the smallest one", move |it| {
            let reached_m = it.value(check);
            (limits.set_distance)(it, reached_m + 1e-6 + beyond_tolerance(check, reached_m));
        })
    }));
    all
}

/// A distance from the limit that is no longer at the limit, in the unit of the check.
fn beyond_tolerance(check: &str, reached: f64) -> f64 {
    1.01 * tolerance::limit_tolerance(check_spec(check).expect("a declared check"), reached)
}

/// Sets the required distance between vehicles, m.
pub fn set_separation(it: &mut ReferenceCase, limit_m: f64) {
    it.scenario.fleet.separation_m = Some(limit_m);
}

/// Sets the required distance between the envelope and obstacles, m.
pub fn set_envelope(it: &mut ReferenceCase, limit_m: f64) {
    it.scenario.verdict.envelope_m = Some(limit_m);
}
