//! The input of the scene.

use scenarios::{Plan, Scenario};
use sim::Flight;

use crate::output::ghost::Ghost;
use crate::verdict::Verdict;

/// A plan, its flight and the verdict on both.
#[derive(Clone, Copy, Debug)]
pub struct JudgedRun<'a> {
    /// The scenario.
    pub scenario: &'a Scenario,
    /// The plan, possibly without trajectories.
    pub plan: &'a Plan,
    /// The flight; `None` if the plan could not be flown.
    pub flight: Option<&'a Flight>,
    /// The verdict.
    pub verdict: &'a Verdict,
    /// An earlier flight to show beside this one.
    pub ghost: Option<&'a Ghost>,
}
