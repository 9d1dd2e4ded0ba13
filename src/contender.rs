//! Who is put to the test in many flights: a plan, or somebody who plans in the loop.

use scenarios::Scenario;

use crate::author::Author;
use crate::submitted::Answer;
use crate::verdict::{self, Verdict};

/// Whose flights are disturbed.
#[derive(Clone, Copy)]
pub enum Contender<'a> {
    /// A plan: it stays as it is.
    Plan(&'a Answer),
    /// Somebody who plans in the loop: he plans anew in every flight.
    InLoop(&'a Author),
}

impl<'a> Contender<'a> {
    /// The plan that `author` made beforehand, or himself if he makes none.
    pub fn of(author: &'a Author, answer: Option<&'a Answer>) -> Self {
        answer.map_or(Self::InLoop(author), Self::Plan)
    }

    /// Name of the planner.
    pub fn planner(&self) -> &'a str {
        match self {
            Self::Plan(answer) => &answer.plan.planner,
            Self::InLoop(author) => author.name(),
        }
    }

    /// Flies once, in a world that may be another than the one that was planned for, and judges it.
    pub fn judged_in(&self, scenario: &Scenario, seed: u64) -> Verdict {
        match self {
            Self::Plan(Answer { plan, given }) => {
                let is_flyable = verdict::is_flyable(scenario, plan).is_ok();
                let flight = is_flyable.then(|| sim::fly(scenario, plan, seed, &mut |_| {}));
                verdict::judge_given(scenario, plan, given, flight.as_ref())
            }
            Self::InLoop(author) => {
                let (plan, flight) = author.fly_in_loop(scenario, seed).expect("one who plans in the loop");
                verdict::judge(scenario, &plan, Some(&flight))
            }
        }
    }
}
