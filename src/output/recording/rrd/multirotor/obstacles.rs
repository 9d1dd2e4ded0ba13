//! Obstacles that are not there from the beginning: hidden ones, which change their colour when they are sensed, and those
//! that move.

use rerun::components::{FillMode, Translation3D};
use rerun::{Cylinders3D, LineStrips3D, RecordingStream, Transform3D};
use scenarios::{Cylinder, Prism, Range, Scenario};
use sim::{EventKind, Flight};

use super::super::series::end_s;
use super::super::world::{face_points, pixels};
use super::super::{Logged, SIM_TIME, entity, palette, sim_times, to_f32};

/// Obstacles that nobody knows of yet, and those that move.
const UNKNOWN: [u8; 3] = [120, 100, 190];
const MOVING: [u8; 3] = [235, 140, 60];
/// Corners of the polygon that a cylinder is drawn as.
const CORNERS: usize = 24;
/// Time between two positions of what moves, s.
const FRAME_S: f64 = 0.05;

/// Logs both kinds.
pub fn log(stream: &RecordingStream, scenario: &Scenario, flight: &Flight) -> Logged {
    let world = &scenario.world;
    let cylinders = world.cylinders.iter().map(as_prism);
    for prism in cylinders.chain(world.flat_obstacles()).filter(|prism| world.is_hidden(&prism.name)) {
        stream.set_duration_secs(SIM_TIME, 0.0);
        log_prism(stream, &prism, world.map.z_m, UNKNOWN)?;
        if let Some(t_s) = discovered_s(flight, &prism.name) {
            stream.set_duration_secs(SIM_TIME, t_s);
            log_prism(stream, &prism, world.map.z_m, palette::OBSTACLE)?;
        }
    }
    stream.reset_time();
    log_moving(stream, scenario, flight)
}

/// When the first vehicle sensed it, s.
fn discovered_s(flight: &Flight, name: &str) -> Option<f64> {
    let is_it = |kind: &EventKind| matches!(kind, EventKind::Discovered { obstacle } if obstacle == name);
    flight.events.iter().filter(|event| is_it(&event.kind)).map(|event| event.t_s).reduce(f64::min)
}

fn as_prism(cylinder: &Cylinder) -> Prism {
    let corner = |i: usize| {
        let (sin, cos) = (std::f64::consts::TAU * i as f64 / CORNERS as f64).sin_cos();
        [cylinder.center_m[0] + cylinder.radius_m * cos, cylinder.center_m[1] + cylinder.radius_m * sin]
    };
    Prism { name: cylinder.name.clone(), corners_m: (0..CORNERS).map(corner).collect(), z_m: None }
}

fn log_prism(stream: &RecordingStream, prism: &Prism, map_z_m: Range, colour: [u8; 3]) -> Logged {
    let z = prism.z_m.unwrap_or(map_z_m);
    let n = prism.corners_m.len();
    let ring = |z: f64| (0..=n).map(|i| prism.corners_m[i % n]).map(|[x, y]| to_f32([x, y, z])).collect::<Vec<_>>();
    let upright = |[x, y]: [f64; 2]| [[x, y, z.min], [x, y, z.max]].map(to_f32).to_vec();
    let path = entity("world/hidden", &prism.name);
    let edges =
        LineStrips3D::new([ring(z.min), ring(z.max)]).with_colors([palette::opaque(colour)]).with_radii([pixels(1.4)]);
    stream.log(path.clone() / "edges", &edges)?;
    let faces = LineStrips3D::new(face_points(prism).into_iter().map(upright))
        .with_colors([palette::opaque(palette::dimmed(colour))])
        .with_radii([pixels(0.4)]);
    Ok(stream.log(path / "faces", &faces)?)
}

fn log_moving(stream: &RecordingStream, scenario: &Scenario, flight: &Flight) -> Logged {
    let frames = (end_s(flight) / FRAME_S) as usize;
    for moving in &scenario.world.moving {
        let z = moving.z_m.unwrap_or(scenario.world.map.z_m);
        let path = entity("world/moving", &moving.name);
        stream.set_duration_secs(SIM_TIME, 0.0);
        let body = Cylinders3D::from_lengths_and_radii([z.width() as f32], [moving.radius_m as f32])
            .with_labels([moving.name.as_str()])
            .with_colors([palette::translucent(MOVING, 0.8)])
            .with_line_radii([pixels(0.8)])
            .with_fill_mode(FillMode::TransparentFillMajorWireframe);
        stream.log(path.clone(), &body)?;
        stream.reset_time();
        let times_s: Vec<f64> = (0..=frames).map(|frame| frame as f64 * FRAME_S).collect();
        let positions = times_s.iter().map(|t_s| {
            let [x, y] = moving.position_m(*t_s);
            Translation3D::from(to_f32([x, y, f64::midpoint(z.min, z.max)]))
        });
        let translations = Transform3D::update_fields().with_many_translation(positions).columns_of_unit_batches()?;
        stream.send_columns(path, [sim_times(times_s)], translations)?;
    }
    Ok(())
}
