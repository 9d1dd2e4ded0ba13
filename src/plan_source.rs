//! Where a plan comes from: a registered planner, an external command, or an imported file.

use planners::Planner;
use scenarios::in_loop::InLoopPlanner;
use scenarios::{Iteration, Plan, Scenario};
use sim::Flight;

pub mod external;
pub mod in_loop;
pub mod plan_import;

use self::external::ExternalPlanner;
use self::plan_import::CompletedPlan;

/// Those who plan in the loop, one per vehicle.
pub type InLoopPlanners = Vec<Box<dyn InLoopPlanner>>;

/// Ends a command that plans in the loop, and returns what it wrote to its standard error.
pub type Log = Box<dyn FnOnce() -> String>;

/// Who answers a scenario.
#[derive(Clone)]
pub enum PlanSource {
    /// A planner of ours.
    Registered(&'static Planner),
    /// A command.
    External(ExternalPlanner),
    /// Somebody who has answered already; the plan bears the name.
    Imported(Box<CompletedPlan>),
}

/// A plan as its plan_source hands it over.
pub struct PlannerOutput {
    /// The plan.
    pub answer: CompletedPlan,
    /// What an outside planner wrote to its standard error.
    pub log: Option<String>,
}

impl PlanSource {
    /// Name under which the results go.
    pub fn name(&self) -> &str {
        match self {
            Self::Registered(planner) => planner.name,
            Self::External(planner) => &planner.name,
            Self::Imported(answer) => &answer.plan.planner,
        }
    }

    /// Does it answer during the flight?
    pub fn plans_in_the_loop(&self) -> bool {
        match self {
            Self::Registered(planner) => planner.plans_in_the_loop(),
            Self::External(planner) => planner.in_loop,
            Self::Imported(_) => false,
        }
    }

    /// Those who plan in the loop, one per vehicle, and how to come by what a command writes to its standard error; `None`
    /// if it answers before the flight. They are told what is known beforehand, and no more.
    pub fn crew(&self, scenario: &Scenario, seed: u64) -> Option<(InLoopPlanners, Option<Log>)> {
        let planner_view = scenario.planner_view();
        match self {
            Self::Registered(planner) if planner.plans_in_the_loop() => {
                let vehicles = 0..scenario.vehicles.len();
                Some((vehicles.map(|index| planner.in_loop(&planner_view, index, seed)).collect(), None))
            }
            Self::External(planner) if planner.in_loop => {
                let crew = external::ExternalSession::start(planner, &planner_view, seed);
                let log: Log = Box::new(crew.log());
                Some((crew.planners, Some(log)))
            }
            _ => None,
        }
    }

    /// The flight of one who plans in the loop, and what he followed as a plan; `None` if he answers before the flight.
    pub fn fly_in_loop(&self, scenario: &Scenario, seed: u64) -> Option<(Plan, Flight)> {
        let (crew, _) = self.crew(scenario, seed)?;
        let flight = sim::fly_in_loop(scenario, crew, seed, &mut |_| {});
        let plan = in_loop::as_plan(scenario, self.name(), seed, flight.planning.as_ref()?);
        Some((plan, flight))
    }

    /// The plan of one who answers before the flight, from what is known beforehand. `progress` receives the iterations of a
    /// planner of ours as they end.
    pub fn plan(&self, scenario: &Scenario, seed: u64, progress: &mut dyn FnMut(&Iteration)) -> PlannerOutput {
        match self {
            Self::Registered(planner) => PlannerOutput {
                answer: CompletedPlan::whole(planner.plan(&scenario.planner_view(), seed, progress)),
                log: None,
            },
            Self::External(planner) => {
                let outside = planner.plan(&scenario.planner_view(), seed);
                PlannerOutput { answer: outside.answer, log: Some(outside.log) }
            }
            Self::Imported(answer) => PlannerOutput { answer: (**answer).clone(), log: None },
        }
    }
}
