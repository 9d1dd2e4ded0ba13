//! The moving bodies in space: quadrotor, cable, load, envelope circle.

use nalgebra::Vector3;
use rerun::components::Translation3D;
use rerun::{Color, LineStrips3D, Points3D, Quaternion, Radius, RecordingStream, Transform3D};
use scenarios::slung_load::{Cable, GRAVITY_MPS2, Model};
use sim::{LoadSample, Sample, VehicleLog};

use super::super::world::pixels;
use super::super::{Logged, Run, SIM_TIME, entity, is_drawable, palette, sim_times, to_f32};

/// Time between two pictures, s.
const FRAME_S: f64 = 0.02;
/// Points of a circle, and of a cable that hangs loose.
const CIRCLE_POINTS: usize = 48;
const LOOSE_POINTS: usize = 24;
/// Tension at which the cable is drawn red, as a multiple of the load's weight.
const RED_TENSION: f64 = 3.0;
/// Colours of a slack cable, of the load and of the envelope.
const SLACK: [u8; 3] = [150, 155, 165];
const LOAD: [u8; 3] = [245, 190, 70];
const ENVELOPE: [u8; 3] = [95, 165, 245];

/// One picture.
struct Frame<'a> {
    sample: &'a Sample,
    load: &'a LoadSample,
}

/// Logs one vehicle.
pub fn log(stream: &RecordingStream, run: &Run<'_>, log: &VehicleLog) -> Logged {
    let Some(vehicle) = run.scenario.vehicles.iter().find(|vehicle| vehicle.name == log.vehicle) else { return Ok(()) };
    let model = run.scenario.slung_load_model(vehicle);
    let frames = frames(log);
    stream.set_duration_secs(SIM_TIME, 0.0);
    log_quadrotor(stream, model, &log.vehicle, &frames)?;
    log_load(stream, model, &log.vehicle, &frames)?;
    stream.reset_time();
    log_strips(stream, &entity("world/cable", &log.vehicle), 2.0, &frames, |frame| {
        (cable(model, frame), tension_colour(model, frame.load))
    })?;
    log_strips(stream, &entity("world/envelope", &log.vehicle), 1.0, &frames, |frame| {
        (envelope(model, frame), palette::opaque(ENVELOPE))
    })?;
    log_paths(stream, log)
}

fn frames(log: &VehicleLog) -> Vec<Frame<'_>> {
    let mut frames: Vec<Frame<'_>> = Vec::new();
    for (sample, load) in log.samples.iter().zip(&log.loads) {
        let is_due = frames.last().is_none_or(|last| sample.t_s - last.sample.t_s >= 0.99 * FRAME_S);
        if is_due && is_drawable(sample) && load.position_m.iter().all(|x| x.is_finite()) {
            frames.push(Frame { sample, load });
        }
    }
    frames
}

/// Arms and rotors as lines: the rotors' circles touch the body's disc from inside.
fn log_quadrotor(stream: &RecordingStream, model: &Model, name: &str, frames: &[Frame<'_>]) -> Logged {
    let quadrotor = entity("world/quadrotor", name);
    let colour = palette::vehicle(0, 1);
    let hub = model.arm_m / std::f64::consts::SQRT_2;
    let hubs = [[hub, -hub], [-hub, -hub], [-hub, hub], [hub, hub]];
    let circles = hubs.map(|[x, y]| circle([x, y, 0.0], model.propeller_radius_m));
    let arms = [[hubs[0], hubs[2]], [hubs[1], hubs[3]]].map(|arm| arm.map(|[x, y]| [x, y, 0.0]).to_vec());
    let nose = vec![[0.0, 0.0, 0.0], [model.arm_m * 0.6, 0.0, 0.0]];
    let strips =
        circles.into_iter().chain(arms).chain([nose]).map(|strip| strip.into_iter().map(to_f32).collect::<Vec<_>>());
    let frame = LineStrips3D::new(strips).with_colors([palette::opaque(colour)]).with_radii([pixels(1.6)]);
    stream.log(quadrotor.clone() / "frame", &frame)?;
    let label = Points3D::new([[0.0_f32; 3]]).with_labels([name]).with_show_labels(true);
    stream.log(quadrotor.clone() / "name", &label.with_colors([palette::opaque(colour)]).with_radii([pixels(2.0)]))?;

    let times = || sim_times(frames.iter().map(|frame| frame.sample.t_s));
    let positions = frames.iter().map(|frame| Translation3D::from(to_f32(frame.sample.position_m)));
    let attitudes = frames.iter().map(|frame| Quaternion::from_xyzw(to_f32(frame.sample.world_from_body)));
    let translations = Transform3D::update_fields().with_many_translation(positions).columns_of_unit_batches()?;
    stream.send_columns(quadrotor.clone(), [times()], translations)?;
    let rotations = Transform3D::update_fields().with_many_quaternion(attitudes).columns_of_unit_batches()?;
    Ok(stream.send_columns(quadrotor / "frame", [times()], rotations)?)
}

fn log_load(stream: &RecordingStream, model: &Model, name: &str, frames: &[Frame<'_>]) -> Logged {
    let load = entity("world/load", name);
    let ball = Points3D::new([[0.0_f32; 3]])
        .with_radii([Radius::new_scene_units(model.load_radius_m as f32)])
        .with_colors([palette::opaque(LOAD)]);
    stream.log(load.clone() / "ball", &ball)?;
    let positions = frames.iter().map(|frame| Translation3D::from(to_f32(frame.load.position_m)));
    let translations = Transform3D::update_fields().with_many_translation(positions).columns_of_unit_batches()?;
    Ok(stream.send_columns(load, [sim_times(frames.iter().map(|frame| frame.sample.t_s))], translations)?)
}

/// A line that changes its shape and colour from picture to picture.
fn log_strips(
    stream: &RecordingStream,
    path: &rerun::EntityPath,
    width: f32,
    frames: &[Frame<'_>],
    draw: impl Fn(&Frame<'_>) -> (Vec<[f64; 3]>, Color),
) -> Logged {
    stream.log_static(path.clone(), &LineStrips3D::update_fields().with_radii([pixels(width)]))?;
    let (strips, colours): (Vec<_>, Vec<_>) = frames.iter().map(draw).unzip();
    let strips = strips.into_iter().map(|strip| strip.into_iter().map(to_f32).collect::<Vec<_>>());
    let lines = LineStrips3D::update_fields().with_strips(strips).with_colors(colours).columns_of_unit_batches()?;
    Ok(stream.send_columns(path.clone(), [sim_times(frames.iter().map(|frame| frame.sample.t_s))], lines)?)
}

/// Straight while taut. While slack, two half waves to the side that make a line of about the cable's length:
/// l = ρ (1 + (n π A / 2 ρ)²), n = 2.
fn cable(model: &Model, frame: &Frame<'_>) -> Vec<[f64; 3]> {
    let (from, to) = (Vector3::from(frame.sample.position_m), Vector3::from(frame.load.position_m));
    let along = to - from;
    if frame.load.cable == Cable::Taut {
        return vec![from.into(), to.into()];
    }
    let spare_m2 = along.norm() * (model.cable_length_m - along.norm()).max(0.0);
    let aside = along.cross(&Vector3::y()).try_normalize(1e-9).unwrap_or_else(Vector3::x);
    let amplitude_m = spare_m2.sqrt() / std::f64::consts::PI;
    let point = |i: usize| {
        let share = i as f64 / LOOSE_POINTS as f64;
        from + along * share + aside * (amplitude_m * (std::f64::consts::TAU * share).sin())
    };
    (0..=LOOSE_POINTS).map(|i| point(i).into()).collect()
}

/// Grey while slack; while taut from green over yellow to red.
fn tension_colour(model: &Model, load: &LoadSample) -> Color {
    if load.cable == Cable::Slack {
        return palette::opaque(SLACK);
    }
    let share = (load.tension_n / (RED_TENSION * model.load_mass_kg * GRAVITY_MPS2)).clamp(0.0, 1.0);
    let channel = |value: f64| (255.0 * value.clamp(0.0, 1.0)) as u8;
    palette::opaque([channel(2.0 * share), channel(2.0 * (1.0 - share)), 60])
}

/// The envelope circle at the quadrotor's height.
fn envelope(model: &Model, frame: &Frame<'_>) -> Vec<[f64; 3]> {
    let [x, y, _] = std::array::from_fn(|i| frame.load.position_m[i] - frame.sample.position_m[i]);
    circle(frame.sample.position_m, f64::hypot(x, y).max(model.body_radius_m()))
}

fn circle([x, y, z]: [f64; 3], radius_m: f64) -> Vec<[f64; 3]> {
    let point = |i: usize| {
        let (sin, cos) = (std::f64::consts::TAU * i as f64 / CIRCLE_POINTS as f64).sin_cos();
        [x + radius_m * cos, y + radius_m * sin, z]
    };
    (0..=CIRCLE_POINTS).map(point).collect()
}

/// Where the load was to go, and where it went.
fn log_paths(stream: &RecordingStream, log: &VehicleLog) -> Logged {
    let frames = frames(log);
    let path = |place: fn(&LoadSample) -> [f64; 3], colour: [u8; 3], width: f32| {
        LineStrips3D::new([frames.iter().map(|frame| to_f32(place(frame.load))).collect::<Vec<_>>()])
            .with_colors([palette::opaque(colour)])
            .with_radii([pixels(width)])
    };
    let planned = path(|load| load.reference_position_m, palette::dimmed(LOAD), 0.5);
    stream.log_static(entity("world/planned_load", &log.vehicle), &planned)?;
    let flown = path(|load| load.position_m, LOAD, 1.0);
    Ok(stream.log_static(entity("world/flown_load", &log.vehicle), &flown)?)
}
