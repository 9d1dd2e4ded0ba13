//! What stands still, and what moves with its vehicle: everything that is drawn.

use std::sync::Arc;

use foxglove::messages::{
    ArrowPrimitive, Color, CubePrimitive, CylinderPrimitive, LinePrimitive, Point3, Pose, Quaternion, SceneEntity,
    SceneUpdate, SpherePrimitive, TextPrimitive, Vector3, line_primitive,
};
use foxglove::{Channel, Context};
use scenarios::{Map, Prism, Range, Scenario};
use sim::{LoadSample, Sample};

use super::{WORLD, channel, timestamp};
use crate::output::recording::{Run, colours, is_drawable};

/// Drawn length of an aircraft as a share of the map's larger side: to scale it would not be seen.
const LENGTH_OF_MAP: f64 = 0.028;
/// Samples between two points of a flown path: half a second at steps of 10 ms.
const PATH_STRIDE: usize = 50;

/// Logs both scenes.
pub fn log(context: &Arc<Context>, run: &Run<'_>) {
    let world: Channel<SceneUpdate> = channel(context, "/world");
    let mut entities = vec![map(&run.scenario.world.map), obstacles(run.scenario), ends(run.scenario)];
    entities.extend(paths(run));
    world.log_with_time(&SceneUpdate { deletions: Vec::new(), entities }, timestamp(0.0));
    let fleet: Channel<SceneUpdate> = channel(context, "/fleet");
    let entities = (0..run.scenario.vehicles.len()).map(|index| aircraft(run.scenario, index)).collect();
    fleet.log_with_time(&SceneUpdate { deletions: Vec::new(), entities }, timestamp(0.0));
}

fn entity(id: &str) -> SceneEntity {
    SceneEntity {
        timestamp: Some(timestamp(0.0)),
        frame_id: WORLD.to_owned(),
        id: id.to_owned(),
        ..SceneEntity::default()
    }
}

fn map(map: &Map) -> SceneEntity {
    let [x, y, z] = map.axes().map(|axis| [axis.min, axis.max]);
    let corner = |i: usize| Point3 { x: x[i & 1], y: y[(i >> 1) & 1], z: z[(i >> 2) & 1] };
    // every edge joins two corners that differ in one bit
    let edges = (0..8).flat_map(|i| [1, 2, 4].map(|bit| (i, i | bit))).filter(|(from, to)| from != to);
    let points: Vec<Point3> = edges.flat_map(|(from, to)| [corner(from), corner(to)]).collect();
    SceneEntity { lines: vec![line(points, colours::MAP, line_primitive::Type::LineList)], ..entity("map") }
}

/// Cylinders from the floor to the ceiling of the map: in truth they end nowhere.
fn obstacles(scenario: &Scenario) -> SceneEntity {
    let z = scenario.world.map.z_m;
    let middle_m = f64::midpoint(z.min, z.max);
    let cylinders = scenario.world.cylinders.iter().map(|cylinder| CylinderPrimitive {
        pose: Some(at([cylinder.center_m[0], cylinder.center_m[1], middle_m])),
        size: Some(Vector3 { x: 2.0 * cylinder.radius_m, y: 2.0 * cylinder.radius_m, z: z.width() }),
        bottom_scale: 1.0,
        top_scale: 1.0,
        color: Some(color(colours::OBSTACLE, 0.6)),
    });
    let texts =
        scenario.world.cylinders.iter().map(|cylinder| {
            text(&cylinder.name, [cylinder.center_m[0], cylinder.center_m[1], z.max], colours::OBSTACLE)
        });
    let prisms = scenario.world.flat_obstacles();
    let outlines = prisms.iter().map(|prism| outline(prism, z));
    let names = prisms.iter().map(|prism| {
        let [x, y] = prism.corners_m[0];
        text(&prism.name, [x, y, prism.z_m.unwrap_or(z).max], colours::OBSTACLE)
    });
    SceneEntity {
        cylinders: cylinders.collect(),
        texts: texts.chain(names).collect(),
        lines: outlines.collect(),
        ..entity("obstacles")
    }
}

/// The edges of a prism; one without bottom or top ends with the map.
fn outline(prism: &Prism, map_z_m: Range) -> LinePrimitive {
    let z_m = prism.z_m.unwrap_or(map_z_m);
    let corners = &prism.corners_m;
    let edges = (0..corners.len()).flat_map(|i| {
        let ([x, y], [next_x, next_y]) = (corners[i], corners[(i + 1) % corners.len()]);
        let rings = [z_m.min, z_m.max].map(|z| [[x, y, z], [next_x, next_y, z]]);
        rings.into_iter().chain([[[x, y, z_m.min], [x, y, z_m.max]]]).flatten()
    });
    line(edges.map(point).collect(), colours::OBSTACLE, line_primitive::Type::LineList)
}

/// The cable of a vehicle at one instant.
pub fn cable(vehicle: &str, sample: &Sample, load: &LoadSample) -> SceneEntity {
    let ends = [sample.position_m, load.position_m].map(point).to_vec();
    let strip = line(ends, colours::MAP, line_primitive::Type::LineStrip);
    SceneEntity { timestamp: Some(timestamp(sample.t_s)), lines: vec![strip], ..entity(&format!("cable/{vehicle}")) }
}

/// Spheres at the starts (dim) and cubes at the goals (bright).
fn ends(scenario: &Scenario) -> SceneEntity {
    let count = scenario.vehicles.len();
    let size_m = length_m(scenario) / 4.0;
    let size = Some(Vector3 { x: size_m, y: size_m, z: size_m });
    let colour = |index| colours::vehicle(index, count);
    let vehicles = || scenario.vehicles.iter().enumerate();
    let starts = vehicles().map(|(index, vehicle)| SpherePrimitive {
        pose: Some(at(vehicle.start.position_m())),
        size,
        color: Some(color(colours::dimmed(colour(index)), 1.0)),
    });
    let goals = vehicles().map(|(index, vehicle)| CubePrimitive {
        pose: Some(at(vehicle.goal.position_m())),
        size,
        color: Some(color(colour(index), 1.0)),
    });
    SceneEntity { spheres: starts.collect(), cubes: goals.collect(), ..entity("starts and goals") }
}

/// PlannedMotions paths dim, flown paths bright.
fn paths(run: &Run<'_>) -> Vec<SceneEntity> {
    let count = run.scenario.vehicles.len();
    let strip = |id: String, points: Vec<[f64; 3]>, colour: [u8; 3]| {
        let points =
            points.into_iter().filter(|point| point.iter().all(|value| value.is_finite())).map(point).collect();
        SceneEntity { lines: vec![line(points, colour, line_primitive::Type::LineStrip)], ..entity(&id) }
    };
    let planned = run.plan.trajectories.iter().enumerate().map(|(index, trajectory)| {
        let nodes = (0..trajectory.node_count()).map(|node| trajectory.nodes().position_m(node)).collect();
        strip(format!("planned/{}", trajectory.vehicle()), nodes, colours::dimmed(colours::vehicle(index, count)))
    });
    let logs = run.flight.iter().flat_map(|flight| &flight.vehicles).enumerate();
    let flown = logs.map(|(index, log)| {
        let samples = log.samples.iter().step_by(PATH_STRIDE).chain(log.samples.last());
        let points = samples.filter(|sample| is_drawable(sample)).map(|sample| sample.position_m).collect();
        strip(format!("flown/{}", log.vehicle), points, colours::vehicle(index, count))
    });
    planned.chain(flown).collect()
}

/// An arrow along the nose, the name, and the safety volume: two of them touch when the separation is R.
fn aircraft(scenario: &Scenario, index: usize) -> SceneEntity {
    let name = &scenario.vehicles[index].name;
    let colour = colours::vehicle(index, scenario.vehicles.len());
    let length_m = length_m(scenario);
    let body = ArrowPrimitive {
        pose: Some(at([-length_m / 2.0, 0.0, 0.0])),
        shaft_length: 0.6 * length_m,
        shaft_diameter: 0.15 * length_m,
        head_length: 0.4 * length_m,
        head_diameter: 0.35 * length_m,
        color: Some(color(colour, 1.0)),
    };
    let safety = scenario.fleet.separation_m.map(|separation_m| CylinderPrimitive {
        pose: Some(at([0.0; 3])),
        size: Some(Vector3 { x: separation_m, y: separation_m, z: length_m / 4.0 }),
        bottom_scale: 1.0,
        top_scale: 1.0,
        color: Some(color(colour, 0.2)),
    });
    SceneEntity {
        frame_id: name.clone(),
        frame_locked: true,
        arrows: vec![body],
        cylinders: safety.into_iter().collect(),
        texts: vec![text(name, [0.0, 0.0, length_m / 2.0], colour)],
        ..entity(name)
    }
}

fn length_m(scenario: &Scenario) -> f64 {
    let map = &scenario.world.map;
    LENGTH_OF_MAP * map.x_m.width().max(map.y_m.width())
}

fn line(points: Vec<Point3>, colour: [u8; 3], kind: line_primitive::Type) -> LinePrimitive {
    LinePrimitive {
        r#type: kind as i32,
        pose: Some(at([0.0; 3])),
        thickness: 1.5,
        scale_invariant: true,
        points,
        color: Some(color(colour, 1.0)),
        ..LinePrimitive::default()
    }
}

fn text(text: &str, position_m: [f64; 3], colour: [u8; 3]) -> TextPrimitive {
    TextPrimitive {
        pose: Some(at(position_m)),
        billboard: true,
        font_size: 12.0,
        scale_invariant: true,
        color: Some(color(colour, 1.0)),
        text: text.to_owned(),
    }
}

fn at([x, y, z]: [f64; 3]) -> Pose {
    Pose { position: Some(Vector3 { x, y, z }), orientation: Some(Quaternion { x: 0.0, y: 0.0, z: 0.0, w: 1.0 }) }
}

fn point([x, y, z]: [f64; 3]) -> Point3 {
    Point3 { x, y, z }
}

fn color([r, g, b]: [u8; 3], a: f64) -> Color {
    let [r, g, b] = [r, g, b].map(|channel| f64::from(channel) / 255.0);
    Color { r, g, b, a }
}
