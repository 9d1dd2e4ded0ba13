//! Obstacles of every kind: known beforehand, hidden until they are sensed, moving.

use scenarios::{MovingCylinder, Prism, Range, Scenario};
use sim::{EventKind, Flight};

use super::map::middle;
use super::solids;
use super::{Body, BodyKind, Changes, Cylinder, Cylinders, Lines, Paint, Part, Pose, Scene, colours, item_path};
use crate::output::run::JudgedRun;

/// Number of vertical lines on the faces of a prism.
const FACE_LINES: f64 = 60.0;
/// Corners of the polygon that stands for a hidden cylinder.
const CYLINDER_CORNERS: usize = 24;
/// Time between two positions of a moving obstacle, s.
const INTERVAL_S: f64 = 0.05;

/// Adds all obstacles.
pub(super) fn add<'a>(scene: &mut Scene<'a>, run: &JudgedRun<'a>) {
    add_known(scene, run.scenario);
    solids::add(scene, &run.scenario.world);
    add_hidden(scene, run.scenario, run.flight);
    for moving in &run.scenario.world.moving {
        add_moving(scene, moving, run.scenario.world.map.z_m);
    }
}

/// Cylinders are unbounded; they are drawn from the floor to the ceiling of the map.
fn add_known(scene: &mut Scene<'_>, scenario: &Scenario) {
    let known = scenario.world.known_before_flight();
    let z = known.map.z_m;
    let cylinder = |cylinder: &scenarios::Cylinder| Cylinder {
        centre_m: [cylinder.center_m[0], cylinder.center_m[1], middle(z)],
        length_m: z.width(),
        radius_m: cylinder.radius_m,
        name: Some(cylinder.name.clone()),
    };
    let cylinders = known.cylinders.iter().map(cylinder).collect();
    scene.add_item(
        &["obstacles"],
        Cylinders { cylinders, paint: Paint::translucent(colours::OBSTACLE, 0.8), radius: 0.8 },
    );
    for prism in known.prism_obstacles() {
        let [edges, faces] = prism_lines(&prism, z, colours::OBSTACLE, true);
        scene.add_item(&["obstacles", &prism.name, "edges"], edges.labelled(prism.name.as_str(), false));
        scene.add_item(&["obstacles", &prism.name, "faces"], faces);
    }
}

/// Hidden obstacles change their colour when the first vehicle senses them.
fn add_hidden(scene: &mut Scene<'_>, scenario: &Scenario, flight: Option<&Flight>) {
    let world = &scenario.world;
    let cylinders = world.cylinders.iter().map(|cylinder| (as_prism(cylinder), false));
    let flat = world.prism_obstacles().into_iter().map(|prism| (prism, true));
    for (prism, has_corners) in cylinders.chain(flat).filter(|(prism, _)| world.is_hidden(&prism.name)) {
        let sensed_s = flight.and_then(|flight| sensed_s(flight, &prism.name));
        let looks = [(0.0, colours::UNKNOWN)].into_iter().chain(sensed_s.map(|t_s| (t_s, colours::OBSTACLE)));
        let (mut edges, mut faces) = (Vec::new(), Vec::new());
        for (t_s, colour) in looks {
            let [edges_then, faces_then] = prism_lines(&prism, world.map.z_m, colour, has_corners);
            edges.push((t_s, edges_then.into()));
            faces.push((t_s, faces_then.into()));
        }
        for (part, shapes) in [("edges", edges), ("faces", faces)] {
            scene.changes.push(Changes { path: item_path(&["hidden", &prism.name, part]), shapes });
        }
    }
}

/// Time at which the first vehicle sensed an obstacle, s.
fn sensed_s(flight: &Flight, name: &str) -> Option<f64> {
    let is_it = |kind: &EventKind| matches!(kind, EventKind::Discovered { obstacle } if obstacle == name);
    flight.events.iter().filter(|event| is_it(&event.kind)).map(|event| event.t_s).reduce(f64::min)
}

fn as_prism(cylinder: &scenarios::Cylinder) -> Prism {
    let corner = |i: usize| {
        let (sin, cos) = (std::f64::consts::TAU * i as f64 / CYLINDER_CORNERS as f64).sin_cos();
        [cylinder.center_m[0] + cylinder.radius_m * cos, cylinder.center_m[1] + cylinder.radius_m * sin]
    };
    Prism { name: cylinder.name.clone(), corners_m: (0..CYLINDER_CORNERS).map(corner).collect(), z_m: None }
}

/// The edges of a prism, and thin vertical lines on its faces that leave what is behind it visible. A prism without bottom
/// and top is drawn from the floor to the ceiling of the map.
///
/// - `has_corners`: draw the vertical edges too?
fn prism_lines(prism: &Prism, map_z_m: Range, colour: [u8; 3], has_corners: bool) -> [Lines; 2] {
    let z = prism.z_m.unwrap_or(map_z_m);
    let n = prism.corners_m.len();
    let vertical = |[x, y]: [f64; 2]| vec![[x, y, z.min], [x, y, z.max]];
    let ring = |z: f64| (0..=n).map(|i| prism.corners_m[i % n]).map(|[x, y]| [x, y, z]).collect::<Vec<_>>();
    let corners = prism.corners_m.iter().filter(|_| has_corners).map(|corner| vertical(*corner));
    let edges = [ring(z.min), ring(z.max)].into_iter().chain(corners).collect();
    let faces = face_points_m(prism).into_iter().map(vertical).collect();
    [Lines::new(edges, Paint::opaque(colour), 1.4), Lines::new(faces, Paint::opaque(colours::dimmed(colour)), 0.4)]
}

/// Points along the edge of a prism's polygon, about equally spaced, without the corners.
fn face_points_m(prism: &Prism) -> Vec<[f64; 2]> {
    let n = prism.corners_m.len();
    let edge = |i: usize| (prism.corners_m[i], prism.corners_m[(i + 1) % n]);
    let length_m = |(a, b): ([f64; 2], [f64; 2])| (b[0] - a[0]).hypot(b[1] - a[1]);
    let spacing_m = (0..n).map(|i| length_m(edge(i))).sum::<f64>() / FACE_LINES;
    let points = (0..n).flat_map(|i| {
        let (a, b) = edge(i);
        let steps = (length_m((a, b)) / spacing_m).round().max(1.0);
        (1..steps as usize).map(move |k| {
            let fraction = k as f64 / steps;
            [a[0] + fraction * (b[0] - a[0]), a[1] + fraction * (b[1] - a[1])]
        })
    });
    points.collect()
}

fn add_moving<'a>(scene: &mut Scene<'a>, moving: &'a MovingCylinder, map_z_m: Range) {
    let (z, end_s) = (moving.z_m.unwrap_or(map_z_m), scene.end_s);
    let cylinder = Cylinder {
        centre_m: [0.0; 3],
        length_m: z.width(),
        radius_m: moving.radius_m,
        name: Some(moving.name.clone()),
    };
    let shape = Cylinders { cylinders: vec![cylinder], paint: Paint::translucent(colours::MOVING, 0.8), radius: 0.8 };
    let pose = move |t_s: f64| {
        let [x, y] = moving.position_m(t_s);
        Pose { t_s, position_m: [x, y, middle(z)], world_from_body: Pose::UPRIGHT }
    };
    let poses = move |interval_s: f64| {
        let count = (end_s / interval_s) as usize;
        (0..=count).map(|frame| pose(frame as f64 * interval_s)).collect()
    };
    scene.bodies.push(Body {
        frame: moving.name.clone(),
        path: item_path(&["moving", &moving.name]),
        kind: BodyKind::Obstacle,
        parts: vec![Part::upright("", shape)],
        interval_s: INTERVAL_S,
        poses: Box::new(poses),
    });
}
