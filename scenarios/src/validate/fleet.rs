//! Distances between the vehicles at their starts and goals.

use super::quantity::positive_if_given;
use crate::{FleetRules, Issue, Scenario, Separation, SeparationShape, Vehicle, Waypoint};

pub(super) fn issues(scenario: &Scenario) -> Vec<Issue> {
    let mut issues = rule_issues(&scenario.fleet);
    for (later, vehicle) in scenario.vehicles.iter().enumerate() {
        for other in &scenario.vehicles[..later] {
            issues.extend(too_close(scenario, format!("vehicles[{later}].start"), vehicle, other, |v| &v.start));
            issues.extend(too_close(scenario, format!("vehicles[{later}].goal"), vehicle, other, |v| &v.goal));
        }
    }
    issues
}

/// A rule that is not complete, or stated twice.
fn rule_issues(fleet: &FleetRules) -> Vec<Issue> {
    let height = ("fleet.separation_height_m", fleet.separation_height_m.map(|height_m| height_m.to_string()));
    let shape = ("fleet.separation_shape", fleet.separation_shape.map(|shape| format!("{shape:?}").to_lowercase()));
    let radius = ("fleet.separation_m", fleet.separation_m.map(|radius_m| radius_m.to_string()));
    let beside = |(field, found): (&str, Option<String>), expected: &str, remedy: &str| {
        found.map(|found| Issue::new(field, found, expected).remedy(remedy))
    };
    if fleet.separation_volume.is_some() {
        let expected = "no such key beside `separation_volume`, which states the whole rule";
        let issues = [radius, shape, height].map(|given| beside(given, expected, "remove one of the two keys"));
        return issues.into_iter().flatten().collect();
    }
    let positive =
        [("fleet.separation_m", fleet.separation_m), ("fleet.separation_height_m", fleet.separation_height_m)];
    let mut issues: Vec<Issue> =
        positive.iter().filter_map(|(field, value)| positive_if_given(field, *value)).collect();
    if fleet.separation_m.is_none() {
        let given = [shape, height].map(|given| beside(given, "`fleet.separation_m` beside it", "add separation_m"));
        issues.extend(given.into_iter().flatten());
        return issues;
    }
    let has_height = matches!(fleet.separation_shape, Some(SeparationShape::Cylinder | SeparationShape::Ellipsoid));
    if has_height && fleet.separation_height_m.is_none() {
        let (field, found) = shape;
        let issue = Issue::new(field, found.unwrap_or_default(), "`fleet.separation_height_m` beside it");
        issues.push(issue.remedy("add separation_height_m, how far the volume reaches up and down"));
    } else if !has_height {
        let expected = "no such key: only cylinders and ellipsoids have a height";
        issues.extend(beside(height, expected, "set separation_shape to \"cylinder\" or \"ellipsoid\""));
    }
    issues
}

/// An overlap of two bodies, or a violation of the separation, at the waypoints that `end` selects.
fn too_close(
    scenario: &Scenario,
    field: String,
    vehicle: &Vehicle,
    other: &Vehicle,
    end: impl Fn(&Vehicle) -> &Waypoint,
) -> Option<Issue> {
    let (a, b) = (end(vehicle), end(other));
    let horizontal_m = (a.x_m - b.x_m).hypot(a.y_m - b.y_m);
    let distance_m = horizontal_m.hypot(a.z_m - b.z_m);
    let touching_m = body_radius_m(scenario, vehicle) + body_radius_m(scenario, other);
    if distance_m < touching_m {
        let found = format!("a point {distance_m:.3} m from that of `{}`: the two bodies overlap", other.name);
        return Some(Issue::new(field, found, format!("{touching_m} m or more, the sum of the body radii")));
    }
    let Separation { measure, limit_m, .. } = scenario.separation()?;
    let apart_m = measure.distance_m([a.x_m - b.x_m, a.y_m - b.y_m, a.z_m - b.z_m]);
    (apart_m < limit_m).then(|| {
        let found = format!("a point {apart_m:.3} m ({}) from that of `{}`", measure.describe(), other.name);
        Issue::new(field, found, format!("{limit_m} m or more, the separation of the fleet"))
            .remedy("move one of them, or relax the separation rule in [fleet]")
    })
}

/// Zero if the model is unknown, which is reported separately.
fn body_radius_m(scenario: &Scenario, vehicle: &Vehicle) -> f64 {
    scenario.models.get(&vehicle.model).map_or(0.0, |model| model.body_radius_m())
}
