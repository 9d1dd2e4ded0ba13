//! Does a scenario hold together? Every rule is a pure function from a part of the scenario to problems.

mod family;
mod fleet;
mod identifier;
mod model;
mod planner;
mod quantity;
mod sensing;
mod simulation;
mod vehicle;
mod verdict;
mod world;

use crate::{Problem, Scenario};

/// Everything in the scenario that makes no sense; empty if it can be planned and flown.
///
/// Fields are named by their path in the file. Whether the planner exists, and whether it can handle the scenario, is
/// not asked here.
pub fn validate(scenario: &Scenario) -> Vec<Problem> {
    let mut problems = Vec::new();
    problems.extend(identifier::scenario_name(&scenario.name));
    problems.extend(world::problems(&scenario.world));
    problems.extend(model::problems(&scenario.models));
    problems.extend(vehicle::problems(scenario));
    problems.extend(family::problems(scenario));
    problems.extend(fleet::problems(scenario));
    problems.extend(sensing::problems(scenario));
    problems.extend(planner::problems(&scenario.planner));
    problems.extend(planner::flight_time(scenario));
    problems.extend(simulation::problems(&scenario.simulation));
    problems.extend(verdict::problems(&scenario.verdict));
    problems
}
