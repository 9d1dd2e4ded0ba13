//! Who makes the plan of a job.

use planners::Planner;
use scenarios::in_loop::InLoopPlanner;
use scenarios::{Iteration, Scenario};

use crate::outside::OutsidePlanner;
use crate::submitted::Answer;

/// Who answers a scenario.
#[derive(Clone)]
pub enum Author {
    /// A planner of ours.
    Registered(&'static Planner),
    /// A command.
    Outside(OutsidePlanner),
    /// Somebody who has answered already; the plan bears the name.
    Submitted(Box<Answer>),
}

/// A plan as its author hands it over.
pub struct HandedOver {
    /// The plan.
    pub answer: Answer,
    /// What an outside planner wrote to its standard error.
    pub log: Option<String>,
}

impl Author {
    /// Name under which the results go.
    pub fn name(&self) -> &str {
        match self {
            Self::Registered(planner) => planner.name,
            Self::Outside(planner) => &planner.name,
            Self::Submitted(answer) => &answer.plan.planner,
        }
    }

    /// Does it answer during the flight?
    pub fn plans_in_the_loop(&self) -> bool {
        matches!(self, Self::Registered(planner) if planner.plans_in_the_loop())
    }

    /// Those who plan in the loop, one per vehicle; `None` if it answers before the flight. They are told what is known
    /// beforehand, and no more.
    pub fn crew(&self, scenario: &Scenario, seed: u64) -> Option<Vec<Box<dyn InLoopPlanner>>> {
        let Self::Registered(planner) = self else { return None };
        let briefing = scenario.briefing();
        let vehicles = 0..scenario.vehicles.len();
        planner.plans_in_the_loop().then(|| vehicles.map(|index| planner.in_loop(&briefing, index, seed)).collect())
    }

    /// The plan of one who answers before the flight, from what is known beforehand. `progress` receives the iterations of a planner of ours as they end.
    pub fn plan(&self, scenario: &Scenario, seed: u64, progress: &mut dyn FnMut(&Iteration)) -> HandedOver {
        match self {
            Self::Registered(planner) => {
                HandedOver { answer: Answer::whole(planner.plan(&scenario.briefing(), seed, progress)), log: None }
            }
            Self::Outside(planner) => {
                let outside = planner.plan(&scenario.briefing(), seed);
                HandedOver { answer: outside.answer, log: Some(outside.log) }
            }
            Self::Submitted(answer) => HandedOver { answer: (**answer).clone(), log: None },
        }
    }
}
