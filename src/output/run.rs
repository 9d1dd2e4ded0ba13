//! The input of every recording and of the scene.

use scenarios::{Plan, Scenario};
use sim::Flight;

use crate::campaign::margin_budget::MarginBudget;
use crate::verdict::Verdict;

/// Everything that a run produced, from the scenario to the verdict.
#[derive(Clone, Copy, Debug)]
pub struct Run<'a> {
    /// The scenario.
    pub scenario: &'a Scenario,
    /// The plan, possibly without trajectories.
    pub plan: &'a Plan,
    /// The flight; `None` if the plan could not be flown.
    pub flight: Option<&'a Flight>,
    /// The verdict on plan and flight.
    pub verdict: &'a Verdict,
    /// The margin budgets; empty unless they were asked for.
    pub waterfall: &'a [MarginBudget],
}
