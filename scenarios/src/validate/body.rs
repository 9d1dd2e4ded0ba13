//! The body of a vehicle at its start and goal, a sphere, against static obstacles.

use crate::{Issue, Waypoint, World};

/// Obstacles that the body touches while its centre is outside. A point inside an obstacle is reported for every family.
pub(crate) fn too_near_obstacles(radius_m: f64, world: &World, field: &str, waypoint: &Waypoint) -> Vec<Issue> {
    let [x_m, y_m, z_m] = waypoint.position_m();
    let cylinders = world.cylinders.iter().map(|it| (it.name.clone(), it.signed_distance_m(x_m, y_m)));
    let flat = world.prism_obstacles();
    let prisms = flat.iter().map(|it| (it.name.clone(), it.signed_distance_in_space_m([x_m, y_m, z_m])));
    let is_near = |(_, distance_m): &(String, f64)| (0.0..radius_m).contains(distance_m);
    let near = cylinders.chain(prisms).filter(is_near);
    near.map(|(name, distance_m)| too_near(radius_m, field, &name, distance_m)).collect()
}

/// The issue of a point that is too near an obstacle.
pub(crate) fn too_near(radius_m: f64, field: &str, obstacle: &str, distance_m: f64) -> Issue {
    let found = format!("a point {distance_m:.3} m from `{obstacle}`");
    let expected = format!("at least {radius_m} m, the body radius");
    Issue::new(field, found, expected).remedy("move the point or the obstacle")
}
