use scenarios::in_loop::InLoopPlanner;
use scenarios::{Iteration, Plan, Scenario};

/// Receives every iteration as it ends.
pub type Progress<'a> = &'a mut dyn FnMut(&Iteration);

/// A planner: from a scenario and a seed to a plan, or to somebody who plans while the vehicle flies.
pub struct Planner {
    /// Name, as in `[planner] name` and `--planner`.
    pub name: &'static str,
    /// What it is, in a sentence.
    pub summary: &'static str,
    /// What it claims to handle, in a few words.
    pub handles: &'static str,
    /// Why it cannot handle a scenario, if it cannot.
    pub refuses: fn(&Scenario) -> Option<String>,
    pub(crate) answers: Answers,
}

/// When a planner answers.
pub(crate) enum Answers {
    /// Before the flight, for all vehicles at once.
    Ahead(fn(&Scenario, u64, Progress<'_>) -> Plan),
    /// During the flight: made for one vehicle, by its index, and a seed.
    InLoop(fn(&Scenario, usize, u64) -> Box<dyn InLoopPlanner>),
}

impl Planner {
    /// Does it plan during the flight?
    pub fn plans_in_the_loop(&self) -> bool {
        matches!(self.answers, Answers::InLoop(_))
    }

    /// Plans `scenario`, which must not be one that it [refuses](Self::refuses). The same seed gives the same plan, wall
    /// times aside, on any number of threads.
    ///
    /// - `scenario`: what is known beforehand, see [`Scenario::planner_view`]
    ///
    /// Panics for a planner that plans in the loop.
    pub fn plan(&self, scenario: &Scenario, seed: u64, progress: Progress<'_>) -> Plan {
        match self.answers {
            Answers::Ahead(plan) => plan(scenario, seed, progress),
            Answers::InLoop(_) => panic!("{} plans in the loop: there is no plan before the flight", self.name),
        }
    }

    /// One who plans in the loop for the vehicle of this index. The same seed and the same observations give the same
    /// answers on any number of threads.
    ///
    /// - `scenario`: what is known beforehand, see [`Scenario::planner_view`]
    ///
    /// Panics for a planner that plans before the flight.
    pub fn in_loop(&self, scenario: &Scenario, vehicle: usize, seed: u64) -> Box<dyn InLoopPlanner> {
        match self.answers {
            Answers::InLoop(make) => make(scenario, vehicle, seed),
            Answers::Ahead(_) => panic!("{} plans before the flight, not in the loop", self.name),
        }
    }
}
