//! Thrusts, tension, swing, tracking error and clearance over time, with their limits; the states of the cable.

use scenarios::Prism;
use scenarios::slung_load::{Cable, Model, Trajectory};
use sim::slung_load::{Part, Parts, SlungLoadState};
use sim::{Actuation, EventKind, Flight, LoadSample, Sample, VehicleLog};

use super::super::{Channel, Channels, Curve, Plot, Scene, Series, StateSeries, colours, distance_m, requirements};
use crate::output::run::JudgedRun;
use crate::verdict::is_flyable;
use crate::verdict::slung_load::{FlownMotion, PlannedMotion, TENSION_WINDOW_S};

/// Largest number of points of one series.
const MAX_POINTS: usize = 2000;
/// Time between two points of a distance, s.
const DISTANCE_STEP_S: f64 = 0.01;
/// Width of a line, points on the screen.
const WIDTH: f32 = 1.3;

/// Adds every series of the flight.
pub(super) fn add<'a>(scene: &mut Scene<'a>, run: &JudgedRun<'a>, flight: &'a Flight) {
    let (Some(log), Some(vehicle)) = (flight.vehicles.first(), run.scenario.vehicles.first()) else { return };
    let (model, end_s) = (run.scenario.slung_load_model(vehicle), scene.end_s);
    scene.channels.push(channels(log, flight.plan_end_s));
    let mut limit = |group, name, value, unit| scene.series.push(Series::limit(group, name, value, unit, end_s));
    limit("thrust_n", "lowest", model.limits.thrust_n.min, "N");
    limit("thrust_n", "highest", model.limits.thrust_n.max, "N");
    limit("thrust_n", "lowest planned", model.planning_limits.thrust_n.min, "N");
    limit("thrust_n", "highest planned", model.planning_limits.thrust_n.max, "N");
    limit("tracking_m", "limit", run.scenario.limits().tracking_max_m, "m");
    limit("tension_n", "highest", model.limits.tension_n, "N");
    limit("clearance_m", "surface", 0.0, "m");
    add_tension(scene, run, log);
    add_distances(scene, run, model, flight);
    add_states(scene, run, flight);
}

fn channels(log: &VehicleLog, plan_end_s: f64) -> Channels<'_> {
    let plot = |group, name: &str, colour, until_s| Plot {
        group,
        name: name.to_owned(),
        colour,
        width: WIDTH,
        max_points: MAX_POINTS,
        until_s,
    };
    let (samples, loads) = (log.samples.as_slice(), log.loads.as_slice());
    // NaN where the log of the load is shorter than that of the vehicle.
    let number = |field, value: fn(&Sample, &LoadSample) -> f64| {
        Channel::number(field, move |step| loads.get(step).map_or(f64::NAN, |load| value(&samples[step], load)))
    };
    let tracking = plot("tracking_m", "quadrotor", colours::vehicle(0, 1), plan_end_s);
    let load_tracking = plot("tracking_m", "load", colours::FLEET, plan_end_s);
    let mut channels = vec![
        number("tracking_error_m", |sample, _| distance_m(sample.position_m, sample.reference_position_m))
            .plotted(tracking),
        number("load_tracking_error_m", |_, load| distance_m(load.position_m, load.reference_position_m))
            .plotted(load_tracking),
        Channel::number("altitude_m", |step| samples[step].position_m[2]),
    ];
    const THRUSTS: [&str; 4] = ["thrust_1_n", "thrust_2_n", "thrust_3_n", "thrust_4_n"];
    for (rotor, field) in THRUSTS.into_iter().enumerate() {
        let plot = plot("thrust_n", &format!("F_{}", rotor + 1), colours::vehicle(rotor, 4), f64::INFINITY);
        channels.push(Channel::number(field, move |step| thrust_n(&samples[step], rotor)).plotted(plot));
    }
    let swing = plot("swing_deg", "flown", colours::vehicle(0, 1), f64::INFINITY);
    channels.extend([
        number("tension_n", |_, load| load.tension_n),
        number("cable_deg", cable_deg).plotted(swing),
        Channel::flag("is_taut", |step| loads.get(step).is_some_and(|load| load.cable == Cable::Taut)),
        Channel::flag("is_saturated", |step| samples[step].is_saturated()),
    ]);
    Channels { vehicle: &log.vehicle, message: "Quadrotor", samples, channels }
}

fn thrust_n(sample: &Sample, rotor: usize) -> f64 {
    match &sample.actuation {
        Actuation::Thrusts(thrusts) => thrusts.control.thrust_n[rotor],
        _ => f64::NAN,
    }
}

/// Angle of the cable from straight down, deg.
fn cable_deg(sample: &Sample, load: &LoadSample) -> f64 {
    let [x, y, z]: [f64; 3] = std::array::from_fn(|i| load.position_m[i] - sample.position_m[i]);
    x.hypot(y).atan2(-z).to_degrees()
}

fn add_tension(scene: &mut Scene<'_>, run: &JudgedRun<'_>, log: &VehicleLog) {
    let window = (TENSION_WINDOW_S / run.scenario.simulation.step_s).round().max(1.0) as usize;
    let mean_n = |end: usize| {
        let first = (end + 1).saturating_sub(window);
        log.loads[first..=end].iter().map(|load| load.tension_n).sum::<f64>() / window as f64
    };
    let logged = log.samples.len().min(log.loads.len());
    let flown: Curve = (0..logged).map(|i| (log.samples[i].t_s, mean_n(i))).collect();
    add_curve(scene, "tension_n", "flown", colours::vehicle(0, 1), flown);
    let is_flyable = is_flyable(run.scenario, run.plan).is_ok();
    let planned = is_flyable.then(|| PlannedMotion::new(run.scenario, run.plan).ok()).flatten();
    if let Some(planned) = planned {
        let curve: Curve = planned.knots.iter().map(|knot| (knot.t_s, knot.tension_n)).collect();
        add_curve(scene, "tension_n", "planned, without impacts", colours::FLEET, curve);
    }
}

/// Distance of every part and of the envelope to the nearest obstacle; of the body to the ground too. Then the robustness of
/// requirements.
fn add_distances(scene: &mut Scene<'_>, run: &JudgedRun<'_>, model: &Model, flight: &Flight) {
    let Ok(flown) = FlownMotion::new(flight) else { return };
    requirements::add(scene, run, &flown.motions, flight);
    let (obstacles, parts) = (run.scenario.world.prism_obstacles(), Parts::new(model));
    let ground_m = run.scenario.world.ground_m.unwrap_or(f64::NEG_INFINITY);
    let stride = (DISTANCE_STEP_S / run.scenario.simulation.step_s).round().max(1.0) as usize;
    // Infinite distances are left out: without an obstacle there is no curve.
    let curve = |distance_m: &dyn Fn(&SlungLoadState) -> f64| -> Curve {
        flown.motion.samples().iter().step_by(stride).map(|at| (at.t_s, distance_m(&at.body))).collect()
    };
    let nearest = |distance_m: &dyn Fn(&Prism) -> f64| obstacles.iter().map(distance_m).fold(f64::INFINITY, f64::min);
    for (index, part) in Part::ALL.into_iter().enumerate() {
        let distances = curve(&|body| {
            let height_m = if part == Part::Body { parts.height_m(body) - ground_m } else { f64::INFINITY };
            nearest(&|obstacle| parts.distance_m(part, body, obstacle)).min(height_m)
        });
        add_curve(scene, "clearance_m", part.name(), colours::vehicle(index, 3), distances);
    }
    let envelope = curve(&|body| nearest(&|obstacle| parts.envelope_distance_m(body, obstacle)));
    add_curve(scene, "clearance_m", "envelope", colours::FLEET, envelope);
}

/// The planned and the flown state of the cable, as states and as a curve of steps.
fn add_states(scene: &mut Scene<'_>, run: &JudgedRun<'_>, flight: &Flight) {
    let Some(scenarios::Trajectory::SlungLoad(trajectory)) = run.plan.trajectories.first() else { return };
    let Some(first) = trajectory.cable.first() else { return };
    let flown = flight.events.iter().filter_map(|event| match event.kind {
        EventKind::CableTaut { .. } => Some((event.t_s, Cable::Taut)),
        EventKind::CableSlack => Some((event.t_s, Cable::Slack)),
        _ => None,
    });
    let flown: Vec<(f64, Cable)> = [(0.0, *first)].into_iter().chain(flown).collect();
    let all = [("planned", planned_states(trajectory), colours::FLEET), ("flown", flown, colours::vehicle(0, 1))];
    for (name, states, colour) in all {
        let last = states.last().map(|(_, cable)| (scene.end_s, *cable));
        let steps = states.iter().copied().chain(last);
        let steps: Curve = steps.map(|(t_s, cable)| (t_s, f64::from(u8::from(cable == Cable::Taut)))).collect();
        let curve = steps.decimated(MAX_POINTS);
        scene.series.push(Series { width: WIDTH, is_stepped: true, ..Series::new("cable", name, colour, curve) });
        let changes = states.iter().map(|(t_s, cable)| (*t_s, state_name(*cable))).collect();
        scene.states.push(StateSeries { group: "cable", name, changes });
    }
}

fn state_name(cable: Cable) -> &'static str {
    match cable {
        Cable::Taut => "taut",
        Cable::Slack => "slack",
    }
}

fn planned_states(trajectory: &Trajectory) -> Vec<(f64, Cable)> {
    let mut states: Vec<(f64, Cable)> = Vec::new();
    for (t_s, cable) in trajectory.times_s.iter().zip(&trajectory.cable) {
        if states.last().is_none_or(|(_, last)| last != cable) {
            states.push((*t_s, *cable));
        }
    }
    states
}

fn add_curve(scene: &mut Scene<'_>, group: &'static str, name: &str, colour: [u8; 3], curve: Curve) {
    scene.series.push(Series { width: WIDTH, ..Series::new(group, name, colour, curve.decimated(MAX_POINTS)) });
}
