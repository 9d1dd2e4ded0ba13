//! Sequential convex programming for fixed-wing fleets (Wang, Xu, Long 2020): the problem of every vehicle is
//! linearised about its last trajectory, with the trajectories of the others frozen, and solved as an elastic linear
//! program.

mod avoidance;
pub mod coupled;
mod coupled_program;
mod decoupled;
pub mod dynamic_priority;
mod dynamics;
pub mod fleet;
mod initial_guess;
mod interval;
mod iterate;
mod options;
pub mod parallel;
mod plan;
mod priority;
mod scaling;
pub mod serial;
mod shooting;
mod subproblem;
mod subproblem_solver;
mod time_bound;
mod transcription;
mod trapezoid;

use scenarios::{Scenario, Vehicle, Waypoint};

use crate::planner::{Planner, ignored_geofence, ignored_solid, ignored_via_point};

/// The planners of the fixed-wing family.
pub(crate) const PLANNERS: &[Planner] =
    &[fleet::PLANNER, coupled::PLANNER, serial::PLANNER, parallel::PLANNER, dynamic_priority::PLANNER];

/// These planners know cylinders only.
fn ignored_flat_face(scenario: &Scenario) -> Option<String> {
    let prisms = scenario.world.prism_obstacles();
    Some(format!("it plans around cylinders, not around boxes and prisms such as `{}`", prisms.first()?.name))
}

/// Why these planners cannot handle a scenario, if they cannot.
pub fn unsupported_reason(scenario: &Scenario) -> Option<String> {
    let is_other = |vehicle: &&Vehicle| !scenario.models.fixed_wing.contains_key(&vehicle.model);
    match scenario.vehicles.iter().find(is_other) {
        Some(other) => Some(format!("vehicle `{}` is not a fixed-wing aircraft", other.name)),
        None => ignored_geofence(scenario)
            .or_else(|| ignored_flat_face(scenario))
            .or_else(|| ignored_solid(scenario))
            .or_else(|| ignored_via_point(scenario))
            .or_else(|| above_each_other(scenario)),
    }
}

/// Two vehicles that begin or end nearer to each other than these planners keep them.
fn above_each_other(scenario: &Scenario) -> Option<String> {
    let separation_m = scenario.horizontal_separation_m()?;
    let are_near = |a: &Waypoint, b: &Waypoint| (a.x_m - b.x_m).hypot(a.y_m - b.y_m) < separation_m;
    scenario.vehicles.iter().enumerate().find_map(|(later, vehicle)| {
        scenario.vehicles[..later].iter().find_map(|other| {
            let ends =
                [("start", are_near(&vehicle.start, &other.start)), ("end", are_near(&vehicle.goal, &other.goal))];
            let (verb, _) = ends.into_iter().find(|(_, are_near)| *are_near)?;
            let [a, b] = [&other.name, &vehicle.name];
            Some(format!(
                "it keeps vehicles {separation_m} m apart horizontally, and `{a}` and `{b}` {verb} nearer to each other"
            ))
        })
    })
}
