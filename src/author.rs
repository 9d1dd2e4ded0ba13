//! Who makes the plan of a job.

use planners::Planner;
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

    /// The plan. `progress` receives the iterations of a planner of ours as they end.
    pub fn plan(&self, scenario: &Scenario, seed: u64, progress: &mut dyn FnMut(&Iteration)) -> HandedOver {
        match self {
            Self::Registered(planner) => {
                HandedOver { answer: Answer::whole(planner.plan(scenario, seed, progress)), log: None }
            }
            Self::Outside(planner) => {
                let outside = planner.plan(scenario, seed);
                HandedOver { answer: outside.answer, log: Some(outside.log) }
            }
            Self::Submitted(answer) => HandedOver { answer: (**answer).clone(), log: None },
        }
    }
}
