use scenarios::{Plan, Scenario};
use sim::Flight;

use super::super::edit_trajectory::AsEditable;
use super::ReferenceCase;
use crate::plan_source::plan_import::CompletedPlan;
use crate::plan_source::{Flown, PlanSource};

/// A reference case that has not been planned and flown yet.
pub struct UnflownCase {
    /// A shipped scenario, or a variant of one.
    pub scenario: Scenario,
    plan_source: PlanSource,
}

impl UnflownCase {
    /// A shipped scenario with the planner that it names.
    ///
    /// - `text`: the scenario file
    ///
    /// # Panics
    ///
    /// If `text` is not a valid scenario, or its planner is not registered: a bug.
    pub fn shipped(name: &str, text: &str) -> Self {
        let scenario = scenarios::parse(name, text).unwrap_or_else(|error| panic!("{name}: {error}"));
        let planner = scenario.planner.name.clone();
        Self { plan_source: registered(&planner), scenario }
    }

    /// The same case with another planner.
    pub fn planned_by(self, planner: &str) -> Self {
        let case = self.with(|scenario| planner.clone_into(&mut scenario.planner.name));
        Self { plan_source: registered(planner), ..case }
    }

    /// The same case with a changed scenario.
    pub fn with(mut self, change: impl FnOnce(&mut Scenario)) -> Self {
        change(&mut self.scenario);
        self
    }

    /// Plans and flies it.
    ///
    /// - `edit`: access to the trajectories of its family
    pub fn flown(self, edit: AsEditable) -> ReferenceCase {
        let Self { scenario, plan_source } = self;
        let plan_source = match plan_one_by_one(&scenario, &plan_source) {
            Some(plan) => PlanSource::Imported(Box::new(CompletedPlan::whole(plan))),
            None => plan_source,
        };
        let Flown { answer, flight } = plan_source.fly(&scenario, scenario.simulation.seed);
        ReferenceCase { scenario, plan: answer.plan, flight, edit, plan_source }
    }
}

fn registered(planner: &str) -> PlanSource {
    PlanSource::Registered(planners::find(planner).unwrap_or_else(|| panic!("there is no planner {planner}")))
}

/// A plan for every vehicle of a fleet, one after the other, for a planner that handles one vehicle only; `None` for a
/// planner that handles the fleet.
fn plan_one_by_one(scenario: &Scenario, plan_source: &PlanSource) -> Option<Plan> {
    let PlanSource::Registered(planner) = plan_source else { return None };
    (planner.unsupported_reason)(scenario)?;
    let alone = |vehicle: &scenarios::Vehicle| {
        let mut alone = scenario.clone();
        alone.vehicles = vec![vehicle.clone()];
        planner.plan(&alone.planner_view(), scenario.simulation.seed, &mut |_| {})
    };
    let plans: Vec<Plan> = scenario.vehicles.iter().map(alone).collect();
    let trajectories = plans.iter().flat_map(|plan| plan.trajectories.clone()).collect();
    Some(Plan { trajectories, ..plans[0].clone() })
}

impl ReferenceCase {
    /// Flies the plan again, or lets the in-loop planner plan anew, possibly in another scenario than that of the verdict.
    pub fn fly_in(&mut self, scenario: &Scenario) {
        let source = self.plan_source.fixed_to(CompletedPlan::whole(self.plan.clone()));
        let Flown { answer, flight } = source.fly(scenario, scenario.simulation.seed);
        (self.plan, self.flight) = (answer.plan, flight);
    }

    /// Flies another plan, with the planning log of the flight before.
    pub fn fly_instead(&mut self, plan: &Plan) {
        let planning = self.flight().planning.take();
        let flight = sim::fly(&self.scenario, plan, self.scenario.simulation.seed, &mut |_| {});
        self.flight = Some(Flight { planning, ..flight });
    }

    /// Whether it was planned during the flight.
    pub fn is_planned_in_the_loop(&self) -> bool {
        self.plan_source.plans_in_the_loop()
    }
}
