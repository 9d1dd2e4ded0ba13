use scenarios::{Iteration, Plan, Scenario};

/// Receives every iteration as it ends.
pub type Progress<'a> = &'a mut dyn FnMut(&Iteration);

/// A planner: from a scenario and a seed to a plan.
pub struct Planner {
    /// Name, as in `[planner] name` and `--planner`.
    pub name: &'static str,
    /// What it is, in a sentence.
    pub summary: &'static str,
    /// What it claims to handle, in a few words.
    pub handles: &'static str,
    /// Why it cannot handle a scenario, if it cannot.
    pub refuses: fn(&Scenario) -> Option<String>,
    pub(crate) answer: fn(&Scenario, u64, Progress<'_>) -> Plan,
}

impl Planner {
    /// Plans `scenario`, which must not be one that it [refuses](Self::refuses). The same seed gives the same plan, wall
    /// times aside, on any number of threads.
    pub fn plan(&self, scenario: &Scenario, seed: u64, progress: Progress<'_>) -> Plan {
        (self.answer)(scenario, seed, progress)
    }
}
