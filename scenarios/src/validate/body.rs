//! The body of a vehicle at its start and goal, a sphere, against static obstacles, the map's edges and geofences.

use crate::{Geofence, GeofenceKind, Issue, Waypoint, World};

/// Rounding of a distance, m.
const ROUNDING_M: f64 = 1e-9;

/// Obstacles that the body touches while its centre is outside. A point inside an obstacle is reported for every family.
pub(crate) fn too_near_obstacles(radius_m: f64, world: &World, field: &str, waypoint: &Waypoint) -> Vec<Issue> {
    let [x_m, y_m, z_m] = waypoint.position_m();
    let cylinders = world.cylinders.iter().map(|it| (it.name.clone(), it.signed_distance_m(x_m, y_m)));
    let flat = world.prism_obstacles();
    let prisms = flat.iter().map(|it| (it.name.clone(), it.signed_distance_in_space_m([x_m, y_m, z_m])));
    let solids = world.read_solids();
    let solids = solids.iter().map(|it| (it.name().to_owned(), it.signed_distance_m([x_m, y_m, z_m])));
    let is_near = |(_, distance_m): &(String, f64)| (0.0..radius_m).contains(distance_m);
    let near = cylinders.chain(prisms).chain(solids).filter(is_near);
    near.map(|(name, distance_m)| too_near(radius_m, field, &name, distance_m)).collect()
}

/// Edges of the map that a body, or a load, reaches beyond while its centre is on the map.
pub(crate) fn too_near_edges(radius_m: f64, world: &World, field: &str, position_m: [f64; 3]) -> Vec<Issue> {
    let axes = ["x_m", "y_m", "z_m"].into_iter().zip(position_m).zip(world.map.axes());
    let is_near = |margin_m: f64| (0.0..radius_m - ROUNDING_M).contains(&margin_m);
    axes.filter(|((_, value), range)| is_near(range.margin(*value)))
        .map(|((axis, value), range)| {
            let expected = format!("at least {radius_m} m, the body radius, from both ends of {range}");
            Issue::new(format!("{field}.{axis}"), value.to_string(), expected)
                .remedy("move the point, or enlarge the map")
        })
        .collect()
}

/// Geofences on whose wrong side a body, or a load, is with a part.
pub(crate) fn beyond_geofences(radius_m: f64, world: &World, field: &str, position_m: [f64; 3]) -> Vec<Issue> {
    let simple = world.geofences.iter().filter(|fence| fence.is_simple());
    let margins = simple.map(|fence| (fence, fence.margin_m(position_m)));
    margins
        .filter(|(_, margin_m)| *margin_m < radius_m - ROUNDING_M)
        .map(|(fence, margin_m)| beyond_geofence(fence, margin_m, (radius_m, field), position_m))
        .collect()
}

fn beyond_geofence(
    fence: &Geofence,
    margin_m: f64,
    (radius_m, field): (f64, &str),
    [x_m, y_m, z_m]: [f64; 3],
) -> Issue {
    let (side, allowed) = match fence.kind {
        GeofenceKind::StayIn => ("outside", "inside"),
        GeofenceKind::KeepOut => ("inside", "outside"),
    };
    let point = format!("({x_m}, {y_m}, {z_m}) m");
    let (found, expected) = if margin_m < 0.0 {
        (format!("{point}, {:.3} m {side} geofence `{}`", -margin_m, fence.name), format!("a point {allowed} it"))
    } else {
        let found = format!("{point}, {margin_m:.3} m from the boundary of geofence `{}`", fence.name);
        (found, format!("a point {allowed} it, at least {radius_m} m, the body radius, from its boundary"))
    };
    Issue::new(field, found, expected).remedy("move the point or the geofence")
}

/// The issue of a point that is too near an obstacle.
pub(crate) fn too_near(radius_m: f64, field: &str, obstacle: &str, distance_m: f64) -> Issue {
    let found = format!("a point {distance_m:.3} m from `{obstacle}`");
    let expected = format!("at least {radius_m} m, the body radius");
    Issue::new(field, found, expected).remedy("move the point or the obstacle")
}
