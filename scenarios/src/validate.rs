//! Validation of scenarios. Every rule is a pure function from a part of the scenario to issues.

pub(crate) mod body;
mod disturbance;
mod fleet;
mod identifier;
mod model;
mod planner;
pub(crate) mod quantity;
mod requirement;
mod simulation;
mod solids;
mod vehicle;
mod verdict;
mod world;

pub use disturbance::wind_without_effect;
pub(crate) use model::planning_inside_physical;
pub(crate) use vehicle::{inside_obstacle, outside_map};

use crate::{Issue, Scenario};

/// All issues of a scenario; empty if it is valid. Fields are named by their path in the file.
///
/// Whether the planner exists and supports the scenario is not checked here.
pub fn validate(scenario: &Scenario) -> Vec<Issue> {
    let mut issues = Vec::new();
    issues.extend(identifier::scenario_name(&scenario.name));
    issues.extend(world::issues(&scenario.world));
    issues.extend(model::issues(&scenario.models));
    issues.extend(vehicle::issues(scenario));
    issues.extend(vehicle::unsupported(scenario));
    issues.extend(fleet::issues(scenario));
    issues.extend(planner::issues(&scenario.planner));
    issues.extend(planner::flight_time(scenario));
    issues.extend(simulation::issues(&scenario.simulation));
    issues.extend(disturbance::issues(scenario));
    issues.extend(requirement::issues(scenario));
    issues.extend(verdict::issues(scenario));
    issues
}
