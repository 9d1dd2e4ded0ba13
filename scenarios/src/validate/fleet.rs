//! Distances between the vehicles at their starts and goals.

use super::quantity::positive_if_given;
use crate::{Issue, Scenario, Vehicle, Waypoint};

pub(super) fn issues(scenario: &Scenario) -> Vec<Issue> {
    let mut issues: Vec<Issue> =
        positive_if_given("fleet.separation_m", scenario.fleet.separation_m).into_iter().collect();
    for (later, vehicle) in scenario.vehicles.iter().enumerate() {
        for other in &scenario.vehicles[..later] {
            issues.extend(too_close(scenario, format!("vehicles[{later}].start"), vehicle, other, |v| &v.start));
            issues.extend(too_close(scenario, format!("vehicles[{later}].goal"), vehicle, other, |v| &v.goal));
        }
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
    let separation_m = scenario.fleet.separation_m?;
    let flies_on = scenario.models.get(&vehicle.model).is_some_and(|model| !model.family().hovers());
    let (apart_m, sense) = if flies_on { (horizontal_m, " (horizontally)") } else { (distance_m, "") };
    (apart_m < separation_m).then(|| {
        let found = format!("a point {apart_m:.3} m{sense} from that of `{}`", other.name);
        Issue::new(field, found, format!("{separation_m} m or more, the separation of the fleet"))
            .remedy("move one of them, or lower fleet.separation_m")
    })
}

/// Zero if the model is unknown, which is reported separately.
fn body_radius_m(scenario: &Scenario, vehicle: &Vehicle) -> f64 {
    scenario.models.get(&vehicle.model).map_or(0.0, |model| model.body_radius_m())
}
