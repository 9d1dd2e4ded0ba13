use scenarios::{Iteration, Plan, Scenario};

use crate::scp;

/// A planner, as the command line knows it.
pub struct Entry {
    /// Name, as in `[planner] name` and `--planner`.
    pub name: &'static str,
    /// What it is, in a sentence.
    pub summary: &'static str,
    /// What it claims to handle, in a few words.
    pub handles: &'static str,
    /// Why it cannot handle a scenario, if it cannot.
    pub refuses: fn(&Scenario) -> Option<String>,
    plan: fn(&Scenario, u64, &mut dyn FnMut(&Iteration)) -> Plan,
}

/// Every planner, one line each.
pub fn registry() -> &'static [Entry] {
    &[Entry {
        name: "parallel-scp",
        summary: "Decoupled sequential convex programming, everybody avoids everybody (Wang, Xu, Long 2020)",
        handles: "fixed-wing fleets among cylinders",
        refuses: scp::refuses,
        plan: scp::parallel::plan,
    }]
}

/// The planner of that name.
pub fn find(name: &str) -> Option<&'static Entry> {
    registry().iter().find(|entry| entry.name == name)
}

impl Entry {
    /// Plans `scenario`; `progress` sees every iteration as it ends. The scenario must not be one that it
    /// [refuses](Entry::refuses).
    pub fn plan(&self, scenario: &Scenario, seed: u64, progress: &mut dyn FnMut(&Iteration)) -> Plan {
        (self.plan)(scenario, seed, progress)
    }
}
