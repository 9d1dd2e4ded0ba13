//! Each vehicle by itself: its name, its model, and its start and goal against map, obstacles and limits.

use super::identifier::entity_names;
use super::quantity::inside;
use crate::fixed_wing::Limits;
use crate::{Problem, Scenario, Vehicle, Waypoint, World, nearest};

pub(super) fn problems(scenario: &Scenario) -> Vec<Problem> {
    if scenario.vehicles.is_empty() {
        return vec![Problem::new("vehicles", "none", "one vehicle at least").remedy("add a `[[vehicles]]` table")];
    }
    let mut problems = entity_names("vehicles", scenario.vehicles.iter().map(|vehicle| vehicle.name.as_str()));
    for (index, vehicle) in scenario.vehicles.iter().enumerate() {
        problems.extend(unknown_model(scenario, index, vehicle));
        for (end, waypoint) in [("start", &vehicle.start), ("goal", &vehicle.goal)] {
            let field = format!("vehicles[{index}].{end}");
            problems.extend(outside_map(&scenario.world, &field, waypoint));
            problems.extend(inside_obstacle(&scenario.world, &field, waypoint));
            if let Some(model) = scenario.models.fixed_wing.get(&vehicle.model) {
                problems.extend(outside_planning_limits(&model.planning_limits, &field, waypoint));
            }
        }
    }
    problems
}

fn unknown_model(scenario: &Scenario, index: usize, vehicle: &Vehicle) -> Option<Problem> {
    let names: Vec<&str> = scenario.models.fixed_wing.keys().map(String::as_str).collect();
    if names.contains(&vehicle.model.as_str()) {
        return None;
    }
    let expected = match names.as_slice() {
        [] => "the name of a model".to_owned(),
        names => format!("the name of a model: {}", names.join(", ")),
    };
    let remedy = match nearest(&vehicle.model, names) {
        Some(name) => format!("did you mean \"{name}\"?"),
        None => format!("define it in a table [models.fixed-wing.{}]", vehicle.model),
    };
    Some(Problem::new(format!("vehicles[{index}].model"), format!("\"{}\"", vehicle.model), expected).remedy(remedy))
}

fn outside_map(world: &World, field: &str, waypoint: &Waypoint) -> Vec<Problem> {
    let axes = ["x_m", "y_m", "z_m"].into_iter().zip(waypoint.position_m()).zip(world.map.axes());
    axes.filter_map(|((axis, value), range)| inside(&format!("{field}.{axis}"), value, range, "the map")).collect()
}

fn inside_obstacle(world: &World, field: &str, waypoint: &Waypoint) -> Vec<Problem> {
    let depth = |cylinder: &crate::Cylinder| -cylinder.signed_distance_m(waypoint.x_m, waypoint.y_m);
    let hit = world.cylinders.iter().filter(|cylinder| depth(cylinder) > 0.0);
    let problem = |cylinder: &crate::Cylinder| {
        let found =
            format!("({}, {}) m, {:.3} m inside `{}`", waypoint.x_m, waypoint.y_m, depth(cylinder), cylinder.name);
        Problem::new(field, found, "a point outside every obstacle").remedy("move the point or the obstacle")
    };
    hit.map(problem).collect()
}

fn outside_planning_limits(limits: &Limits, field: &str, waypoint: &Waypoint) -> Vec<Problem> {
    let quantities = [
        ("z_m", waypoint.z_m, limits.altitude_m, "the planning limits of altitude, m"),
        ("speed_mps", waypoint.speed_mps, limits.speed_mps, "the planning limits of speed, m/s"),
        (
            "flight_path_deg",
            waypoint.flight_path_deg,
            limits.flight_path_deg,
            "the planning limits of climb angle, deg",
        ),
    ];
    let check = |(name, value, range, of)| inside(&format!("{field}.{name}"), value, range, of);
    quantities.into_iter().filter_map(check).collect()
}
