//! The one path from a plan source to a flight, for plans that are made beforehand and for in-loop planners.

use scenarios::Scenario;
use scenarios::in_loop::InLoopPlanner;
use sim::Flight;

use super::in_loop;
use super::plan_import::CompletedPlan;
use crate::verdict::{self, Verdict};

/// What guides the vehicles through a flight.
pub enum Guidance {
    /// A plan, which the tracking controllers follow.
    Plan(Box<CompletedPlan>),
    /// In-loop planners, which plan during the flight.
    InLoop {
        /// Name under which the results go.
        planner: String,
        /// One planner per vehicle, in the order of the scenario.
        planners: Vec<Box<dyn InLoopPlanner>>,
    },
}

/// A plan and its flight.
pub struct Flown {
    /// The plan; of in-loop planners, the references that the vehicles followed.
    pub answer: CompletedPlan,
    /// The flight; `None` if there is no plan that can be flown.
    pub flight: Option<Flight>,
}

impl Guidance {
    /// The plan; `None` for in-loop planners.
    pub fn into_plan(self) -> Option<CompletedPlan> {
        match self {
            Self::Plan(answer) => Some(*answer),
            Self::InLoop { .. } => None,
        }
    }

    /// Longest duration of the flight, s; `None` if there is no plan that can be flown.
    pub fn max_flight_duration_s(&self, scenario: &Scenario) -> Option<f64> {
        let max_duration_s = scenario.simulation.max_duration_s;
        match self {
            Self::Plan(answer) => {
                let plan = &answer.plan;
                verdict::is_flyable(scenario, plan).ok()?;
                Some((plan.flight_time_s()? + scenario.simulation.coast_s).min(max_duration_s))
            }
            Self::InLoop { .. } => Some(max_duration_s),
        }
    }

    /// Flies once.
    ///
    /// - `seed`: of gusts, sensors and planning times; the same seed gives the same flight
    /// - `progress`: receives the simulated time about once per simulated second, s
    pub fn fly(self, scenario: &Scenario, seed: u64, progress: &mut dyn FnMut(f64)) -> Flown {
        match self {
            Self::Plan(answer) => {
                let is_flyable = verdict::is_flyable(scenario, &answer.plan).is_ok();
                let flight = is_flyable.then(|| sim::fly(scenario, &answer.plan, seed, progress));
                Flown { answer: *answer, flight }
            }
            Self::InLoop { planner, planners } => {
                let flight = sim::fly(scenario, planners, seed, progress);
                let log = flight.planning.as_ref().expect("an in-loop flight has a log of its planning");
                let plan = in_loop::as_plan(scenario, &planner, seed, log);
                Flown { answer: CompletedPlan::whole(plan), flight: Some(flight) }
            }
        }
    }
}

impl Flown {
    /// The verdict on plan and flight.
    pub fn judge(&self, scenario: &Scenario) -> Verdict {
        verdict::judge_imported(scenario, &self.answer.plan, &self.answer.provenance, self.flight.as_ref())
    }
}
