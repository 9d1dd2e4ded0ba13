//! Where specimens come from: shipped scenarios, planned and flown.

use scenarios::{Plan, Scenario};
use sim::Flight;

use super::ReferenceCase;
use crate::plan_source::PlanSource;
use crate::verdict;

/// A scenario that is still to be planned and flown.
pub struct UnflownCase {
    /// The scenario: one of those that are shipped, or a part of one.
    pub scenario: Scenario,
    /// Its planner.
    pub plan_source: PlanSource,
}

/// A shipped scenario, with the planner that it names.
///
/// # Panics
///
/// If the text is not a scenario: a bug.
pub fn shipped(name: &str, text: &str) -> UnflownCase {
    let scenario = scenarios::parse(name, text).unwrap_or_else(|error| panic!("{name}: {error}"));
    by(scenario.planner.name.clone().as_str(), scenario)
}

/// A scenario with a planner of ours.
pub fn by(planner: &str, mut scenario: Scenario) -> UnflownCase {
    let planner = planners::find(planner).unwrap_or_else(|| panic!("{}: unknown planner {planner}", scenario.name));
    planner.name.clone_into(&mut scenario.planner.name);
    UnflownCase { scenario, plan_source: PlanSource::Registered(planner) }
}

impl UnflownCase {
    /// Plans and flies it.
    pub fn flown(self) -> ReferenceCase {
        let Self { scenario, plan_source } = self;
        let seed = scenario.simulation.seed;
        let (plan, flight) = plan_source.fly_in_loop(&scenario, seed).map_or_else(
            || {
                let plan = ahead(&scenario, &plan_source);
                let flight = flown_ahead(&scenario, &plan);
                (plan, flight)
            },
            |(plan, flight)| (plan, Some(flight)),
        );
        ReferenceCase { scenario, plan, flight, plan_source }
    }
}

fn flown_ahead(scenario: &Scenario, plan: &Plan) -> Option<Flight> {
    let is_flyable = verdict::is_flyable(scenario, plan).is_ok();
    is_flyable.then(|| sim::fly(scenario, plan, scenario.simulation.seed, &mut |_| {}))
}

/// A plan for every vehicle. A planner that handles one at a time plans for one after the other.
fn ahead(scenario: &Scenario, plan_source: &PlanSource) -> Plan {
    let seed = scenario.simulation.seed;
    let plan = |scenario: &Scenario| plan_source.plan(scenario, seed, &mut |_| {}).answer.plan;
    let PlanSource::Registered(planner) = plan_source else { return plan(scenario) };
    if (planner.unsupported_reason)(scenario).is_none() {
        return plan(scenario);
    }
    let alone = |vehicle: &scenarios::Vehicle| {
        let mut alone = scenario.clone();
        alone.vehicles = vec![vehicle.clone()];
        plan(&alone)
    };
    let plans: Vec<Plan> = scenario.vehicles.iter().map(alone).collect();
    let trajectories = plans.iter().flat_map(|plan| plan.trajectories.clone()).collect();
    Plan { trajectories, ..plans[0].clone() }
}

impl ReferenceCase {
    /// Flies it again, for instance in another scenario than it will be judged by: the plan, or by who plans in the loop.
    pub fn fly_in(&mut self, scenario: &Scenario) {
        match self.plan_source.fly_in_loop(scenario, scenario.simulation.seed) {
            Some((plan, flight)) => (self.plan, self.flight) = (plan, Some(flight)),
            None => self.flight = flown_ahead(scenario, &self.plan),
        }
    }

    /// Flies another plan, and says that it was planned as before.
    pub fn fly_instead(&mut self, plan: &Plan) {
        let planning = self.flight().planning.take();
        let flight = sim::fly(&self.scenario, plan, self.scenario.simulation.seed, &mut |_| {});
        self.flight = Some(Flight { planning, ..flight });
    }

    /// Was it planned during the flight?
    pub fn is_planned_in_the_loop(&self) -> bool {
        self.plan_source.plans_in_the_loop()
    }
}
