//! The flight of an earlier run as a ghost.

use super::{Body, BodyKind, Lines, Paint, Part, Points, Pose, Scene, colours, item_path};
use crate::output::ghost::{Ghost, GhostVehicle};

/// Width of a ghost's path, points on the screen.
const RADIUS: f32 = 0.8;

/// Adds the path of every vehicle, and a dot that moves along it.
pub(super) fn add<'a>(scene: &mut Scene<'a>, ghost: &'a Ghost) {
    for vehicle in &ghost.vehicles {
        let line = Lines::new(vec![vehicle.positions_m.clone()], Paint::translucent(colours::GHOST, 0.8), RADIUS)
            .labelled(format!("{} before", vehicle.name), false);
        scene.add_item(&["ghost", &vehicle.name, "path"], line);
        scene.bodies.push(body(vehicle));
    }
    scene.legend.push("- grey line and grey dot: the flight of the earlier run".to_owned());
}

fn body(vehicle: &GhostVehicle) -> Body<'_> {
    let dot = Points::one([0.0; 3], colours::GHOST, 4.0, format!("{} before", vehicle.name), false);
    let pose = |(t_s, position_m): (&f64, &[f64; 3])| Pose {
        t_s: *t_s,
        position_m: *position_m,
        world_from_body: Pose::UPRIGHT,
    };
    Body {
        frame: format!("{}/ghost", vehicle.name),
        path: item_path(&["ghost", &vehicle.name]),
        kind: BodyKind::Ghost,
        parts: vec![Part::upright("now", dot)],
        interval_s: 0.0,
        poses: Box::new(move |_| vehicle.times_s.iter().zip(&vehicle.positions_m).map(pose).collect()),
    }
}
