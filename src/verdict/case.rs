//! A plan and its flight as the judge sees them, and the checks that all families share.

use rayon::prelude::*;
use scenarios::{CheckSpec, Family, Group, Plan, Scenario, checks_of};
use sim::Flight;

use crate::verdict::evidence::{CheckResult, Decide, Evidence};
use crate::verdict::flown::FlownMotions;
use crate::verdict::missing_evidence::MissingEvidence;
use crate::verdict::motion::Motion;
use crate::verdict::{Check, Provenance, arrival, conditions, flight_integrity, integrity, tracking};

/// Why the groups `nodes` and `plan` are skipped for a plan that came into being during the flight.
pub const PLANNED_IN_LOOP: &str = "planned in the loop: there was no plan before the flight";

/// A plan, its flight, and the evidence that all families share.
pub struct Case<'a> {
    /// The scenario.
    pub scenario: &'a Scenario,
    /// The plan, flyable or not.
    pub plan: &'a Plan,
    /// What the plan gives.
    pub provenance: &'a Provenance,
    flyable: Result<(), MissingEvidence>,
    flight: Result<&'a Flight, MissingEvidence>,
    flown: Result<FlownMotions<'a>, MissingEvidence>,
}

/// The rows of a table of checks: the name of a check, and the function that makes it from a case of type `C`.
pub type CheckTable<F> = [(&'static str, F)];

/// The checks that are made alike for all families.
const SHARED_CHECKS: &CheckTable<fn(&CheckSpec, &Case<'_>) -> CheckResult> = &[
    ("plan.finite", |spec, it| Ok(integrity::check_plan_finite(spec, it.plan))),
    ("plan.complete", |spec, it| Ok(integrity::check_plan_complete(spec, it.scenario, it.plan))),
    ("plan.arrival", |spec, it| arrival::check_planned_arrival(spec, it.scenario, it.flyable())),
    ("plan.duration", |spec, it| arrival::check_planned_duration(spec, it.scenario, it.flyable()?)),
    ("flight.finite", |spec, it| Ok(flight_integrity::check_finite(spec, it.flight()?))),
    ("flight.conditions", |spec, it| Ok(conditions::check(spec, it.scenario, it.plan, it.flight()?))),
    ("flight.arrival", |spec, it| {
        let is_planned_in_loop = it.flight().is_ok_and(|flight| flight.planning.is_some());
        arrival::check_flown_arrival(spec, it.scenario, it.plan, it.flown(), is_planned_in_loop)
    }),
    ("flight.duration", |spec, it| Ok(arrival::check_flown_duration(spec, it.scenario, it.flown()?))),
    ("flight.tracking_rms", |spec, it| tracking::check_root_mean_square(spec, it.scenario, it.flown()?)),
    ("flight.tracking_max", |spec, it| tracking::check_largest(spec, it.scenario, it.flown()?)),
    ("flight.saturation", |spec, it| tracking::check_saturation(spec, it.scenario, it.flown()?)),
];

impl<'a> Case<'a> {
    /// - `flight`: `None` when the plan was not flown
    pub fn new(scenario: &'a Scenario, plan: &'a Plan, provenance: &'a Provenance, flight: Option<&'a Flight>) -> Self {
        let flyable = integrity::is_flyable(scenario, plan);
        let flight = flyable.clone().and_then(|()| flight.ok_or(MissingEvidence::NotFlown));
        let flown = flight.clone().and_then(|flight| FlownMotions::new(scenario, plan, flight));
        Self { scenario, plan, provenance, flyable, flight, flown }
    }

    /// The plan, if it is flyable.
    pub fn flyable(&self) -> Evidence<'_, Plan> {
        self.flyable.as_ref().map(|()| self.plan)
    }

    /// The flight of a flyable plan.
    pub fn flight(&self) -> Evidence<'_, Flight> {
        self.flight.as_ref().map(|flight| *flight)
    }

    /// The flight, its logs matched with the vehicles.
    pub fn flown(&self) -> Evidence<'_, FlownMotions<'a>> {
        self.flown.as_ref()
    }

    /// Whether the plan came into being during the flight.
    pub fn is_planned_in_loop(&self) -> bool {
        self.flight().is_ok_and(|flight| flight.planning.is_some())
    }

    /// The end of the mission, s; infinite if it cannot be told.
    pub fn mission_end_s(&self) -> f64 {
        self.flown().map_or(f64::INFINITY, FlownMotions::mission_end_s)
    }

    /// The motion of every vehicle while it is judged.
    pub fn flown_motions(&self) -> Evidence<'_, [Motion]> {
        self.flown().map(|flown| flown.motions.as_slice())
    }

    /// Makes every check of `family`, in the order of a verdict, on all threads.
    ///
    /// - `own`: the family's function for a check, applied; `None` if the check is one that all families share
    ///
    /// # Panics
    ///
    /// If a check has no function, which is a bug.
    pub fn checks(&self, family: Family, own: impl Fn(&CheckSpec) -> Option<CheckResult> + Sync) -> Vec<Check> {
        let planned_in_loop = self.is_planned_in_loop();
        let check = |spec: &&CheckSpec| match spec.group {
            Group::Nodes | Group::Plan if planned_in_loop => spec.skip(PLANNED_IN_LOOP),
            Group::Nodes | Group::Plan | Group::Flight => {
                let shared = || Some(function_of(SHARED_CHECKS, spec)?(spec, self));
                let made = own(spec).or_else(shared).expect("every check has a function");
                made.unwrap_or_else(|missing| spec.fail(missing))
            }
        };
        let specs: Vec<&CheckSpec> = checks_of(family).collect();
        specs.par_iter().map(check).collect()
    }
}

/// The function of a check in a table.
pub fn function_of<F: Copy>(table: &CheckTable<F>, spec: &CheckSpec) -> Option<F> {
    table.iter().find(|(name, _)| *name == spec.name).map(|(_, function)| *function)
}

#[cfg(test)]
pub(super) mod tests {
    use scenarios::{Family, check_names};

    use super::{CheckTable, SHARED_CHECKS};

    /// Every check of `family` has exactly one function, in its own table or in the shared one, and every function a check.
    pub fn assert_complete<F>(family: Family, own: &CheckTable<F>) {
        let shared = SHARED_CHECKS.iter().map(|(name, _)| *name);
        let mut functions: Vec<&str> = own.iter().map(|(name, _)| *name).chain(shared).collect();
        let mut checks: Vec<&str> = check_names(family).collect();
        functions.sort_unstable();
        checks.sort_unstable();
        assert_eq!(functions, checks, "{family}");
    }
}
