//! What is put before the judge, and the evidence that the families share.

use rayon::prelude::*;
use scenarios::{CheckSpec, Family, Group, Plan, Scenario, checks_of};
use sim::Flight;

use crate::verdict::evidence::{Decide, Evidence};
use crate::verdict::flown::FlownMotions;
use crate::verdict::{Check, arrival, conditions, flight_integrity, integrity, tracking};

/// Why the groups `nodes` and `plan` are skipped for a plan that came into being during the flight.
const PLANNED_IN_FLIGHT: &str = "planned in the loop: before the flight there was no plan";

/// A plan, its flight, and what can be said of both whatever the family.
pub struct Case<'a> {
    /// The scenario.
    pub scenario: &'a Scenario,
    /// The plan, flyable or not.
    pub plan: &'a Plan,
    flyable: Result<(), String>,
    flight: Result<&'a Flight, String>,
    flown: Result<FlownMotions<'a>, String>,
}

impl<'a> Case<'a> {
    /// - `flight`: `None` when the plan was not flown
    pub fn new(scenario: &'a Scenario, plan: &'a Plan, flight: Option<&'a Flight>) -> Self {
        let flyable = integrity::is_flyable(scenario, plan);
        let flight = flyable.clone().and_then(|()| flight.ok_or_else(|| "the plan was not flown".to_owned()));
        let flown = flight.clone().and_then(|flight| FlownMotions::new(scenario, plan, flight));
        Self { scenario, plan, flyable, flight, flown }
    }

    /// The plan, if it is flyable.
    pub fn flyable(&self) -> Evidence<'_, Plan> {
        self.flyable.as_ref().map(|()| self.plan).map_err(String::as_str)
    }

    /// The flight.
    pub fn flight(&self) -> Evidence<'_, Flight> {
        self.flight.as_ref().map(|flight| *flight).map_err(String::as_str)
    }

    /// The flight, its logs matched with the vehicles.
    pub fn flown(&self) -> Evidence<'_, FlownMotions<'a>> {
        self.flown.as_ref().map_err(String::as_str)
    }

    /// Every check that is put to `family`, in the order of a verdict, made by `check` on all threads.
    pub fn checks(&self, family: Family, check: impl Fn(&CheckSpec) -> Check + Sync) -> Vec<Check> {
        let planned_in_flight = self.flight().is_ok_and(|flight| flight.planning.is_some());
        let specs: Vec<&CheckSpec> = checks_of(family).collect();
        let make = |spec: &CheckSpec| match spec.group {
            Group::Nodes | Group::Plan if planned_in_flight => spec.skip(PLANNED_IN_FLIGHT),
            Group::Nodes | Group::Plan | Group::Flight => check(spec),
        };
        specs.into_par_iter().map(make).collect()
    }

    /// A check that is made alike for all families.
    pub fn shared(&self, spec: &CheckSpec) -> Check {
        let (scenario, plan, flyable, flown) = (self.scenario, self.plan, self.flyable(), self.flown());
        match spec.name {
            "plan.finite" => integrity::check_plan_finite(spec, plan),
            "plan.complete" => integrity::check_plan_complete(spec, scenario, plan),
            "plan.arrival" => arrival::check_planned_arrival(spec, scenario, flyable),
            "plan.duration" => arrival::check_planned_duration(spec, scenario, flyable),
            "flight.finite" => self.logged(spec, |flight| flight_integrity::check_finite(spec, flight)),
            "flight.complete" => self.logged(spec, |it| flight_integrity::check_complete(spec, scenario, plan, it)),
            "flight.conditions" => self.logged(spec, |flight| conditions::check(spec, scenario, plan, flight)),
            "flight.arrival" => arrival::check_flown_arrival(spec, scenario, flown),
            "flight.duration" => arrival::check_flown_duration(spec, scenario, flown),
            "flight.tracking_rms" => tracking::check_root_mean_square(spec, scenario, flown),
            "flight.tracking_max" => tracking::check_largest(spec, scenario, flown),
            "flight.saturation" => tracking::check_saturation(spec, scenario, flown),
            _ => spec.fail("the judge has no such check for this family of vehicles"),
        }
    }

    /// The number of crashes.
    ///
    /// - `flown`: to look for contacts that the log does not tell of
    pub fn crash(&self, spec: &CheckSpec, flown: Evidence<'_, FlownMotions<'_>>) -> Check {
        self.logged(spec, |flight| flight_integrity::check_crash(spec, self.scenario, flight, flown))
    }

    fn logged(&self, spec: &CheckSpec, check: impl FnOnce(&Flight) -> Check) -> Check {
        self.flight().map_or_else(|reason| spec.fail(reason), check)
    }
}
