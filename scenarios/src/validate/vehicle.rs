//! Single vehicles: name, model, and start and goal against map, obstacles and limits.

use super::body::{beyond_geofences, too_near_edges};
use super::identifier::entity_names;
use super::quantity::{inside, not_negative, ordered, positive};
use crate::geometry::Solid;
use crate::{Issue, Scenario, Vehicle, ViaPoint, World, closest_name};

pub(super) fn issues(scenario: &Scenario) -> Vec<Issue> {
    if scenario.vehicles.is_empty() {
        return vec![Issue::new("vehicles", "none", "at least one vehicle").remedy("add a `[[vehicles]]` table")];
    }
    let mut issues = entity_names("vehicles", scenario.vehicles.iter().map(|vehicle| vehicle.name.as_str()));
    issues.extend(of_another_family(scenario));
    for (index, vehicle) in scenario.vehicles.iter().enumerate() {
        issues.extend(unknown_model(scenario, index, vehicle));
        for (end, waypoint) in [("start", &vehicle.start), ("goal", &vehicle.goal)] {
            let field = format!("vehicles[{index}].{end}");
            issues.extend(outside_map(&scenario.world, &field, waypoint.position_m()));
            issues.extend(inside_obstacle(&scenario.world, &field, waypoint.position_m()));
            let model = scenario.models.get(&vehicle.model);
            let (world, radius_m) = (&scenario.world, model.map_or(0.0, |model| model.body_radius_m()));
            issues.extend(too_near_edges(radius_m, world, &field, waypoint.position_m()));
            issues.extend(beyond_geofences(radius_m, world, &field, waypoint.position_m()));
            issues.extend(model.iter().flat_map(|model| model.waypoint_issues(&scenario.world, &field, waypoint)));
        }
        for (place, via) in vehicle.via.iter().enumerate() {
            issues.extend(via_issues(&scenario.world, &format!("vehicles[{index}].via[{place}]"), via));
        }
    }
    issues
}

/// A via-point's size and window, and its centre against map and obstacles.
fn via_issues(world: &World, field: &str, via: &ViaPoint) -> Vec<Issue> {
    let mut issues = outside_map(world, field, via.position_m());
    issues.extend(inside_obstacle(world, field, via.position_m()));
    issues.extend(positive(&format!("{field}.radius_m"), via.radius_m));
    let window = format!("{field}.window_s");
    issues.extend(via.window_s.and_then(|window_s| ordered(&window, window_s)));
    issues.extend(via.window_s.and_then(|window_s| not_negative(&window, window_s.min)));
    issues
}

/// What the family of the first vehicle does not support.
pub(super) fn unsupported(scenario: &Scenario) -> Vec<Issue> {
    let first = scenario.vehicles.first().and_then(|vehicle| scenario.models.get(&vehicle.model));
    first.map_or_else(Vec::new, |model| (model.family().spec().unsupported)(scenario))
}

/// Simulation and verdict support one family at a time.
fn of_another_family(scenario: &Scenario) -> Option<Issue> {
    let mut families = scenario
        .vehicles
        .iter()
        .enumerate()
        .filter_map(|(index, vehicle)| Some((index, vehicle, scenario.models.get(&vehicle.model)?.family())));
    let (_, first, family) = families.next()?;
    let (index, other, other_family) = families.find(|(_, _, other)| *other != family)?;
    let found = format!("\"{}\", a {other_family}", other.model);
    let expected = format!("a {family} like `{}`: all vehicles of a scenario are of one family", first.name);
    Some(Issue::new(format!("vehicles[{index}].model"), found, expected).remedy("move it to a scenario of its own"))
}

fn unknown_model(scenario: &Scenario, index: usize, vehicle: &Vehicle) -> Option<Issue> {
    let names: Vec<&str> = scenario.models.names().collect();
    if names.contains(&vehicle.model.as_str()) {
        return None;
    }
    let expected = match names.as_slice() {
        [] => "the name of a model".to_owned(),
        names => format!("the name of a model: {}", names.join(", ")),
    };
    let remedy = match closest_name(&vehicle.model, names) {
        Some(name) => format!("did you mean \"{name}\"?"),
        None => format!("define it in a table [models.FAMILY.{}]", vehicle.model),
    };
    Some(Issue::new(format!("vehicles[{index}].model"), format!("\"{}\"", vehicle.model), expected).remedy(remedy))
}

pub(crate) fn outside_map(world: &World, field: &str, position_m: [f64; 3]) -> Vec<Issue> {
    let axes = ["x_m", "y_m", "z_m"].into_iter().zip(position_m).zip(world.map.axes());
    axes.filter_map(|((axis, value), range)| inside(&format!("{field}.{axis}"), value, range, "the map")).collect()
}

fn inside_solid(solid: &Solid, field: &str, point_m: [f64; 3]) -> Issue {
    let ([x_m, y_m, z_m], side) = (point_m, if solid.is_terrain() { "below" } else { "inside" });
    let depth_m = solid.signed_distance_m(point_m).abs();
    let found = format!("({x_m}, {y_m}, {z_m}) m, {side} `{}`, {depth_m:.3} m from its surface", solid.name());
    Issue::new(field, found, "a point outside every obstacle").remedy("move the point or the obstacle")
}

pub(crate) fn inside_obstacle(world: &World, field: &str, [x_m, y_m, z_m]: [f64; 3]) -> Vec<Issue> {
    let cylinders =
        world.cylinders.iter().map(|cylinder| (cylinder.name.clone(), cylinder.signed_distance_m(x_m, y_m)));
    let at_height =
        world.prism_obstacles().into_iter().filter(|prism| prism.z_m.is_none_or(|range| range.contains(z_m)));
    let prisms = at_height.map(|prism| (prism.name.clone(), prism.signed_distance_m([x_m, y_m])));
    let issue = |(name, distance_m): (String, f64)| {
        let found = format!("({x_m}, {y_m}) m, {:.3} m inside `{name}`", -distance_m);
        Issue::new(field, found, "a point outside every obstacle").remedy("move the point or the obstacle")
    };
    let upright = cylinders.chain(prisms).filter(|(_, distance_m)| *distance_m < 0.0).map(issue);
    let enclosing = world.read_solids().into_iter().filter(|solid| solid.encloses([x_m, y_m, z_m]));
    upright.chain(enclosing.map(|solid| inside_solid(&solid, field, [x_m, y_m, z_m]))).collect()
}
