//! Validation of fixed-wing models, and of starts and goals against their planning limits, obstacles and the ground.

use super::{Limits, Model};
use crate::validate::body::too_near_obstacles;
use crate::validate::planning_inside_physical;
use crate::validate::quantity::{inside, ordered, positive};
use crate::{Issue, Range, Scenario, Waypoint, World};

pub(super) fn model(field: &str, model: &Model) -> Vec<Issue> {
    let mut issues = Vec::new();
    issues.extend(positive(&format!("{field}.mass_kg"), model.mass_kg));
    issues.extend(positive(&format!("{field}.body_radius_m"), model.body_radius_m));
    issues.extend(limits(&format!("{field}.limits"), &model.limits));
    issues.extend(limits(&format!("{field}.planning_limits"), &model.planning_limits));
    issues.extend(planning_inside_physical(field, named(&model.planning_limits), named(&model.limits)));
    issues
}

fn limits(field: &str, limits: &Limits) -> Vec<Issue> {
    let mut issues = Vec::new();
    for (name, range) in named(limits) {
        issues.extend(ordered(&format!("{field}.{name}"), range));
    }
    if limits.speed_mps.min <= 0.0 {
        let expected = "a minimum speed greater than 0: a fixed wing can't hover";
        issues.push(Issue::new(format!("{field}.speed_mps"), limits.speed_mps.to_string(), expected));
    }
    if limits.flight_path_deg.min <= -90.0 || limits.flight_path_deg.max >= 90.0 {
        let expected = "both ends strictly between -90 and 90 deg";
        issues.push(Issue::new(format!("{field}.flight_path_deg"), limits.flight_path_deg.to_string(), expected));
    }
    issues
}

fn named(limits: &Limits) -> [(&'static str, Range); 6] {
    [
        ("altitude_m", limits.altitude_m),
        ("speed_mps", limits.speed_mps),
        ("flight_path_deg", limits.flight_path_deg),
        ("n_x", limits.n_x),
        ("n_y", limits.n_y),
        ("n_z", limits.n_z),
    ]
}

/// Start or goal against the planning limits and the obstacles.
pub(super) fn waypoint(model: &Model, world: &World, field: &str, waypoint: &Waypoint) -> Vec<Issue> {
    let limits = &model.planning_limits;
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
    let load = waypoint.load.map(|_| {
        Issue::new(format!("{field}.load"), "a load", "nothing: a fixed wing carries no load").remedy("remove it")
    });
    let near = too_near_obstacles(model.body_radius_m, world, field, waypoint);
    quantities.into_iter().filter_map(check).chain(load).chain(near).collect()
}

/// Planners keep aircraft off the ground by their planning limits.
pub(super) fn above_ground(scenario: &Scenario) -> Vec<Issue> {
    let Some(ground_m) = scenario.world.ground_m else { return Vec::new() };
    let models = scenario.models.fixed_wing.iter();
    let low = models.filter(|(_, model)| model.planning_limits.altitude_m.min < ground_m + model.body_radius_m);
    low.map(|(name, model)| {
        let field = format!("models.fixed-wing.{name}.planning_limits.altitude_m");
        let expected =
            format!("a minimum of at least {} m, the body radius above the ground", ground_m + model.body_radius_m);
        Issue::new(field, model.planning_limits.altitude_m.to_string(), expected)
            .remedy("raise the minimum, or lower world.ground_m")
    })
    .collect()
}
