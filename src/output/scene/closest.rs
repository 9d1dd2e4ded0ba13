//! Marks in space: the closest approaches that the judge found, and crashes.

use scenarios::{Prism, World};
use sim::{EventKind, Flight, Sample};

use super::body::is_drawable;
use super::{Lines, Paint, Points, Scene, colours};
use crate::number_format::quantity;
use crate::output::run::JudgedRun;
use crate::verdict::{Check, Status};

/// The checks that are marked in space, and their labels.
const MARKED: [(&str, &str); 2] = [("flight.separation", "separation"), ("flight.clearance", "clearance")];

/// Adds one line between the two objects that came closest for every marked check that names them, and a point where each
/// vehicle crashed.
pub(super) fn add(scene: &mut Scene<'_>, run: &JudgedRun<'_>, flight: &Flight) {
    for (name, title) in MARKED {
        let Some(check) = run.verdict.checks.iter().find(|check| check.name == name) else { continue };
        if is_crash(flight, check) {
            continue;
        }
        let Some(ends_m) = ends_m(run, flight, check) else { continue };
        let colour = if check.status == Status::Pass { colours::KEPT } else { colours::LIMIT };
        let value = check.value.map(|value| quantity(value, &check.unit)).unwrap_or_default();
        let mark =
            Lines::new(vec![ends_m.to_vec()], Paint::opaque(colour), 2.5).labelled(format!("{title} {value}"), true);
        scene.add_item(&["closest", name], mark);
    }
    add_crashes(scene, flight);
}

/// Is the closest approach the crash itself? Then the mark of the crash is enough.
fn is_crash(flight: &Flight, check: &Check) -> bool {
    let Some(at_s) = check.at_s else { return false };
    let mut crashes = flight.events.iter().filter(|event| matches!(event.kind, EventKind::Crash { .. }));
    crashes.any(|crash| {
        (crash.t_s - at_s).abs() <= 2.0 * flight.step_s
            && crash.vehicles.iter().any(|vehicle| check.between.contains(vehicle))
    })
}

/// Marks the last drawable position of each vehicle that crashed.
fn add_crashes(scene: &mut Scene<'_>, flight: &Flight) {
    let crashes = flight.events.iter().filter(|event| matches!(event.kind, EventKind::Crash { .. }));
    for name in crashes.flat_map(|event| &event.vehicles) {
        let Some(log) = flight.vehicles.iter().find(|log| log.vehicle == *name) else { continue };
        let Some(last) = log.samples.iter().rfind(|sample| is_drawable(sample)) else { continue };
        let label = format!("{name} crashed at {:.1} s", last.t_s);
        scene.add_item(&["crashed", name], Points::one(last.position_m, colours::LIMIT, 6.0, label, true));
    }
}

/// The positions of the two objects concerned: two vehicles, or a vehicle and the nearest point of an obstacle, m.
fn ends_m(run: &JudgedRun<'_>, flight: &Flight, check: &Check) -> Option<[[f64; 3]; 2]> {
    let [first, second] = check.between.as_slice() else { return None };
    let at_s = check.at_s?;
    let vehicle_m = |name: &str| position_m(flight, name, at_s);
    let surface_m = |name: &str, from_m: [f64; 3]| surface_point_m(&run.scenario.world, name, at_s, from_m);
    match (vehicle_m(first), vehicle_m(second)) {
        (Some(a), Some(b)) => Some([a, b]),
        (Some(a), None) => Some([a, surface_m(second, a)?]),
        (None, Some(b)) => Some([b, surface_m(first, b)?]),
        (None, None) => None,
    }
}

/// Position of a vehicle at the sample nearest to `t_s`.
fn position_m(flight: &Flight, vehicle: &str, t_s: f64) -> Option<[f64; 3]> {
    let log = flight.vehicles.iter().find(|log| log.vehicle == vehicle)?;
    let distance_s = |sample: &&Sample| (sample.t_s - t_s).abs();
    let nearest = log.samples.iter().min_by(|a, b| distance_s(a).total_cmp(&distance_s(b)))?;
    is_drawable(nearest).then_some(nearest.position_m)
}

/// The point nearest to `from_m` on the side of an obstacle at an instant, m. It is at the same height, or at that of the
/// obstacle's nearer end.
fn surface_point_m(world: &World, obstacle: &str, at_s: f64, from_m: [f64; 3]) -> Option<[f64; 3]> {
    let [x, y, z] = from_m;
    if let Some(cylinder) = world.cylinders.iter().find(|cylinder| cylinder.name == obstacle) {
        return Some(at_height(circle_point_m(cylinder.center_m, cylinder.radius_m, [x, y]), z));
    }
    if let Some(moving) = world.moving.iter().find(|moving| moving.name == obstacle) {
        let z = moving.z_m.map_or(z, |range| z.clamp(range.min, range.max));
        return Some(at_height(circle_point_m(moving.position_m(at_s), moving.radius_m, [x, y]), z));
    }
    if let Some(solid) = world.solids().iter().find(|solid| solid.name() == obstacle) {
        return Some(solid.nearest(from_m).point_m);
    }
    let prism = world.prism_obstacles().into_iter().find(|prism| prism.name == obstacle)?;
    let z = prism.z_m.map_or(z, |range| z.clamp(range.min, range.max));
    Some(at_height(polygon_point_m(&prism, [x, y])?, z))
}

fn at_height([x, y]: [f64; 2], z: f64) -> [f64; 3] {
    [x, y, z]
}

fn circle_point_m([cx, cy]: [f64; 2], radius_m: f64, [x, y]: [f64; 2]) -> [f64; 2] {
    let scale = radius_m / (x - cx).hypot(y - cy).max(f64::MIN_POSITIVE);
    [cx + (x - cx) * scale, cy + (y - cy) * scale]
}

/// The nearest point on the polygon's edge.
fn polygon_point_m(prism: &Prism, [x, y]: [f64; 2]) -> Option<[f64; 2]> {
    let corners = &prism.corners_m;
    let edges = corners.iter().zip(corners.iter().cycle().skip(1));
    let candidates = edges.map(|([ax, ay], [bx, by])| {
        let (dx, dy) = (bx - ax, by - ay);
        let along = ((x - ax) * dx + (y - ay) * dy) / (dx * dx + dy * dy).max(f64::MIN_POSITIVE);
        let along = along.clamp(0.0, 1.0);
        [ax + along * dx, ay + along * dy]
    });
    let distance_m = |[px, py]: &[f64; 2]| (px - x).hypot(py - y);
    candidates.min_by(|a, b| distance_m(a).total_cmp(&distance_m(b)))
}

#[cfg(test)]
mod tests {
    use scenarios::{BoxObstacle, Cylinder, Map, MovingCylinder, Range, World};

    use super::surface_point_m;

    #[test]
    fn the_nearest_point_is_on_the_surface_of_every_kind_of_obstacle() {
        let axis = Range::new(-100.0, 100.0);
        let mut world = World::empty(Map { x_m: axis, y_m: axis, z_m: axis });
        world.cylinders.push(Cylinder { name: "tower".into(), center_m: [10.0, 0.0], radius_m: 2.0 });
        world.boxes.push(BoxObstacle {
            name: "wall".into(),
            center_m: [0.0, 10.0],
            size_m: [4.0, 2.0],
            heading_deg: 0.0,
            z_m: Some(Range::new(0.0, 3.0)),
        });
        world.moving.push(MovingCylinder {
            name: "cart".into(),
            radius_m: 1.0,
            z_m: None,
            path_m: vec![[-10.0, 0.0], [-10.0, 50.0]],
            speed_mps: 5.0,
            offset_m: 0.0,
        });
        let is = |obstacle: &str, at_s: f64, expected: [f64; 3]| {
            let found = surface_point_m(&world, obstacle, at_s, [0.0, 0.0, 5.0]).expect(obstacle);
            assert!((0..3).all(|i| (found[i] - expected[i]).abs() < 1e-9), "{obstacle}: {found:?}");
        };
        is("tower", 0.0, [8.0, 0.0, 5.0]);
        is("wall", 0.0, [0.0, 9.0, 3.0]);
        is("cart", 0.0, [-9.0, 0.0, 5.0]);
        let moved_m = 125.0_f64.sqrt();
        is("cart", 1.0, [-10.0 + 10.0 / moved_m, 5.0 - 5.0 / moved_m, 5.0]);
        assert_eq!(surface_point_m(&world, "map frame", 0.0, [0.0; 3]), None);
    }
}
