//! Starts and goals of multirotors: on the map and clear of obstacles with the whole body, and at rest.

use super::super::Model;
use crate::validate::body::{too_near, too_near_obstacles};
use crate::{Issue, Waypoint, World};

pub(in crate::multirotor) fn issues(model: &Model, world: &World, field: &str, waypoint: &Waypoint) -> Vec<Issue> {
    let mut issues = too_near_obstacles(model.body_radius_m, world, field, waypoint);
    if field.ends_with(".start") {
        issues.extend(too_near_moving(model, world, field, waypoint));
    }
    if waypoint.speed_mps != 0.0 && waypoint.speed_mps.is_finite() {
        let issue = Issue::new(format!("{field}.speed_mps"), waypoint.speed_mps.to_string(), "0");
        issues.push(issue.remedy("remove it: multirotors start and end at rest"));
    }
    issues.extend(waypoint.load.map(|_| {
        Issue::new(format!("{field}.load"), "a load", "nothing: this vehicle carries no load").remedy("remove it")
    }));
    issues
}

fn too_near_moving(model: &Model, world: &World, field: &str, waypoint: &Waypoint) -> Vec<Issue> {
    let with_path = world.moving.iter().filter(|moving| moving.has_path());
    with_path
        .filter_map(|moving| {
            let distance_m = moving.signed_distance_m(0.0, waypoint.position_m());
            (distance_m < model.body_radius_m).then(|| too_near(model.body_radius_m, field, &moving.name, distance_m))
        })
        .collect()
}
