//! The bodies in space: quadrotor, load, cable, envelope circle, paths of the load.

use nalgebra::Vector3;
use scenarios::slung_load::{Cable, GRAVITY_MPS2, Model};
use sim::{LoadSample, Sample, VehicleLog};

use super::super::body::{is_drawable, is_due};
use super::super::{
    Animation, Body, BodyKind, Lines, Paint, Part, Points, Pose, Radius, Scene, circle, colours, is_finite, item_path,
};
use crate::output::run::JudgedRun;

/// Time between two frames, s.
const FRAME_S: f64 = 0.02;
/// Points of a circle.
const CIRCLE_POINTS: usize = 48;
/// Points of a slack cable.
const SLACK_POINTS: usize = 24;
/// Tension at which the cable is drawn in full red, as a multiple of the load's weight.
const RED_TENSION: f64 = 3.0;

/// Quadrotor and load at one time.
#[derive(Clone, Copy)]
struct Frame<'a> {
    sample: &'a Sample,
    load: &'a LoadSample,
}

/// Adds one vehicle with its load.
pub(super) fn add<'a>(scene: &mut Scene<'a>, run: &JudgedRun<'a>, log: &'a VehicleLog) {
    let Some(vehicle) = run.scenario.vehicles.iter().find(|vehicle| vehicle.name == log.vehicle) else { return };
    let model = run.scenario.slung_load_model(vehicle);
    scene.bodies.extend([quadrotor(model, log), load(model, log)]);
    let frames = frames(log, FRAME_S);
    let mut animate = |name: &str, radius: f32, strips: Vec<Vec<[f64; 3]>>, paints: Vec<Paint>| {
        let times_s = frames.iter().map(|frame| frame.sample.t_s).collect();
        scene.animations.push(Animation { path: item_path(&[name, &log.vehicle]), times_s, strips, paints, radius });
    };
    animate(
        "cables",
        2.0,
        frames.iter().map(|frame| cable(model, frame)).collect(),
        frames.iter().map(|frame| tension_paint(model, frame.load)).collect(),
    );
    animate(
        "envelopes",
        1.0,
        frames.iter().map(|frame| envelope(model, frame)).collect(),
        vec![Paint::opaque(colours::FLEET)],
    );
    add_load_paths(scene, log, &frames);
}

/// The drawable frames, at least `interval_s` apart.
fn frames(log: &VehicleLog, interval_s: f64) -> Vec<Frame<'_>> {
    let mut frames: Vec<Frame<'_>> = Vec::new();
    for (sample, load) in log.samples.iter().zip(&log.loads) {
        let is_due = frames.last().is_none_or(|last| is_due(last.sample.t_s, sample.t_s, interval_s));
        if is_due && is_drawable(sample) && is_finite(&load.position_m) {
            frames.push(Frame { sample, load });
        }
    }
    frames
}

/// Arms and rotors as lines; the circles of the rotors touch the body's disc from inside.
fn quadrotor<'a>(model: &Model, log: &'a VehicleLog) -> Body<'a> {
    let colour = colours::vehicle(0, 1);
    let hub = model.arm_m / std::f64::consts::SQRT_2;
    let hubs = [[hub, -hub], [-hub, -hub], [-hub, hub], [hub, hub]];
    let circles = hubs.map(|[x, y]| circle([x, y, 0.0], model.propeller_radius_m, CIRCLE_POINTS));
    let arms = [[hubs[0], hubs[2]], [hubs[1], hubs[3]]].map(|arm| arm.map(|[x, y]| [x, y, 0.0]).to_vec());
    let nose = vec![[0.0, 0.0, 0.0], [model.arm_m * 0.6, 0.0, 0.0]];
    let strips = circles.into_iter().chain(arms).chain([nose]).collect();
    let parts = vec![
        Part::fixed("frame", Lines::new(strips, Paint::opaque(colour), 1.6)),
        Part::upright("name", Points::one([0.0; 3], colour, 2.0, log.vehicle.as_str(), true)),
    ];
    Body {
        frame: log.vehicle.clone(),
        path: item_path(&["vehicles", &log.vehicle]),
        kind: BodyKind::Vehicle,
        parts,
        interval_s: FRAME_S,
        poses: Box::new(|interval_s| frames(log, interval_s).iter().map(|frame| Pose::of(frame.sample)).collect()),
    }
}

fn load<'a>(model: &Model, log: &'a VehicleLog) -> Body<'a> {
    let ball = Points {
        positions_m: vec![[0.0; 3]],
        paints: vec![Paint::opaque(colours::LOAD)],
        radius: Radius::World(model.load_radius_m),
        labels: Vec::new(),
        are_labels_shown: false,
    };
    let pose = |frame: &Frame<'_>| Pose {
        t_s: frame.sample.t_s,
        position_m: frame.load.position_m,
        world_from_body: Pose::UPRIGHT,
    };
    Body {
        frame: format!("{}/load", log.vehicle),
        path: item_path(&["loads", &log.vehicle]),
        kind: BodyKind::Vehicle,
        parts: vec![Part::upright("ball", ball)],
        interval_s: FRAME_S,
        poses: Box::new(move |interval_s| frames(log, interval_s).iter().map(pose).collect()),
    }
}

/// Straight while taut. While slack, two half waves to the side, whose length is approximately that of the cable:
/// l = ρ (1 + (n π A / 2 ρ)²), n = 2.
fn cable(model: &Model, frame: &Frame<'_>) -> Vec<[f64; 3]> {
    let (from, to) = (Vector3::from(frame.sample.position_m), Vector3::from(frame.load.position_m));
    let along = to - from;
    if frame.load.cable == Cable::Taut {
        return vec![from.into(), to.into()];
    }
    let slack_m2 = along.norm() * (model.cable_length_m - along.norm()).max(0.0);
    let sideways = along.cross(&Vector3::y()).try_normalize(1e-9).unwrap_or_else(Vector3::x);
    let amplitude_m = slack_m2.sqrt() / std::f64::consts::PI;
    let point = |i: usize| {
        let fraction = i as f64 / SLACK_POINTS as f64;
        from + along * fraction + sideways * (amplitude_m * (std::f64::consts::TAU * fraction).sin())
    };
    (0..=SLACK_POINTS).map(|i| point(i).into()).collect()
}

/// Grey while slack; while taut from green over yellow to red.
fn tension_paint(model: &Model, load: &LoadSample) -> Paint {
    if load.cable == Cable::Slack {
        return Paint::opaque(colours::SLACK);
    }
    let fraction = (load.tension_n / (RED_TENSION * model.load_mass_kg * GRAVITY_MPS2)).clamp(0.0, 1.0);
    let channel = |value: f64| (255.0 * value.clamp(0.0, 1.0)) as u8;
    Paint::opaque([channel(2.0 * fraction), channel(2.0 * (1.0 - fraction)), 60])
}

/// The envelope circle at the quadrotor's height.
fn envelope(model: &Model, frame: &Frame<'_>) -> Vec<[f64; 3]> {
    let [x, y, _] = std::array::from_fn(|i| frame.load.position_m[i] - frame.sample.position_m[i]);
    circle(frame.sample.position_m, f64::hypot(x, y).max(model.body_radius_m()), CIRCLE_POINTS)
}

/// The planned and the flown path of the load.
fn add_load_paths(scene: &mut Scene<'_>, log: &VehicleLog, frames: &[Frame<'_>]) {
    let path = |position_m: fn(&LoadSample) -> [f64; 3], colour: [u8; 3], radius: f32| {
        let points = frames.iter().map(|frame| position_m(frame.load)).collect();
        Lines::new(vec![points], Paint::opaque(colour), radius)
    };
    let planned = path(|load| load.reference_position_m, colours::dimmed(colours::LOAD), 0.5);
    scene.add_item(&["planned_load", &log.vehicle], planned);
    scene.add_item(&["flown_load", &log.vehicle], path(|load| load.position_m, colours::LOAD, 1.0));
}
