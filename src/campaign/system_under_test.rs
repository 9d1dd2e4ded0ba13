//! Who is put to the test in many flights: a plan, or somebody who plans in the loop.

use scenarios::Scenario;

use crate::plan_source::PlanSource;
use crate::plan_source::plan_import::CompletedPlan;
use crate::verdict::{self, Verdict};

/// Whose flights are disturbed.
#[derive(Clone, Copy)]
pub enum SystemUnderTest<'a> {
    /// A plan: it stays as it is.
    Plan(&'a CompletedPlan),
    /// Somebody who plans in the loop: he plans anew in every flight.
    InLoop(&'a PlanSource),
}

impl<'a> SystemUnderTest<'a> {
    /// The plan that `plan_source` made beforehand, or himself if he makes none.
    pub fn of(plan_source: &'a PlanSource, answer: Option<&'a CompletedPlan>) -> Self {
        answer.map_or(Self::InLoop(plan_source), Self::Plan)
    }

    /// Name of the planner.
    pub fn planner(&self) -> &'a str {
        match self {
            Self::Plan(answer) => &answer.plan.planner,
            Self::InLoop(plan_source) => plan_source.name(),
        }
    }

    /// Flies once, in a world that may be another than the one that was planned for, and judges it.
    pub fn judged_in(&self, scenario: &Scenario, seed: u64) -> Verdict {
        match self {
            Self::Plan(CompletedPlan { plan, provenance }) => {
                let is_flyable = verdict::is_flyable(scenario, plan).is_ok();
                let flight = is_flyable.then(|| sim::fly(scenario, plan, seed, &mut |_| {}));
                verdict::judge_imported(scenario, plan, provenance, flight.as_ref())
            }
            Self::InLoop(plan_source) => {
                let (plan, flight) = plan_source.fly_in_loop(scenario, seed).expect("one who plans in the loop");
                verdict::judge(scenario, &plan, Some(&flight))
            }
        }
    }
}
