//! Thrusts, tension, swing, tracking, clearance over time, each with what it is held against; slack and taut as states.

use rerun::components::InterpolationMode;
use rerun::{Color, RecordingStream, Scalars, SeriesLines, StateChange};
use scenarios::Prism;
use scenarios::slung_load::{Cable, Model, Trajectory};
use sim::slung_load::{Body, Part, Parts};
use sim::{Actuation, EventKind, Flight, LoadSample, Sample, VehicleLog};

use super::super::decimation::Curve;
use super::super::series::{end_s, log_limit};
use super::super::{Logged, Run, SIM_TIME, entity, palette, sim_times};
use crate::verdict::is_flyable;
use crate::verdict::slung_load::{FlownMotion, PlannedMotion, TENSION_WINDOW_S};

/// Most points of one series.
const MOST_POINTS: usize = 2000;
/// Time between two points of a distance, s.
const DISTANCE_STEP_S: f64 = 0.01;

/// Logs every series of the flight.
pub fn log(stream: &RecordingStream, run: &Run<'_>, flight: &Flight) -> Logged {
    let (Some(log), Some(vehicle)) = (flight.vehicles.first(), run.scenario.vehicles.first()) else { return Ok(()) };
    let (model, end_s) = (run.scenario.slung_load_model(vehicle), end_s(flight));
    log_thrusts(stream, model, log, end_s)?;
    log_tension(stream, run, model, log, end_s)?;
    log_tracking(stream, log, flight.plan_end_s)?;
    log_limit(stream, "tracking", "limit", run.scenario.limits().tracking_max_m, "m", end_s)?;
    log_distances(stream, run, model, flight)?;
    log_limit(stream, "clearance", "surface,", 0.0, "m", end_s)?;
    log_states(stream, run, flight)
}

fn log_thrusts(stream: &RecordingStream, model: &Model, log: &VehicleLog, end_s: f64) -> Logged {
    for rotor in 0..4 {
        let thrust_n = |sample: &Sample| match &sample.actuation {
            Actuation::Thrusts(thrusts) => thrusts.control.thrust_n[rotor],
            _ => f64::NAN,
        };
        let curve: Curve = log.samples.iter().map(|sample| (sample.t_s, thrust_n(sample))).collect();
        curve_of(stream, "thrust", &format!("F_{}", rotor + 1), palette::vehicle(rotor, 4), curve)?;
    }
    for (name, value) in [
        ("lowest", model.limits.thrust_n.min),
        ("highest", model.limits.thrust_n.max),
        ("lowest planned", model.planning_limits.thrust_n.min),
        ("highest planned", model.planning_limits.thrust_n.max),
    ] {
        log_limit(stream, "thrust", name, value, "N", end_s)?;
    }
    Ok(())
}

fn log_tension(stream: &RecordingStream, run: &Run<'_>, model: &Model, log: &VehicleLog, end_s: f64) -> Logged {
    let step_s = run.scenario.simulation.step_s;
    let window = (TENSION_WINDOW_S / step_s).round().max(1.0) as usize;
    let mean_n = |end: usize| {
        let first = (end + 1).saturating_sub(window);
        log.loads[first..=end].iter().map(|load| load.tension_n).sum::<f64>() / window as f64
    };
    let logged = log.samples.len().min(log.loads.len());
    let flown: Curve = (0..logged).map(|i| (log.samples[i].t_s, mean_n(i))).collect();
    curve_of(stream, "tension", "flown", palette::vehicle(0, 1), flown)?;
    let swing_deg = |(sample, load): (&Sample, &LoadSample)| {
        let [x, y, z]: [f64; 3] = std::array::from_fn(|i| load.position_m[i] - sample.position_m[i]);
        (sample.t_s, x.hypot(y).atan2(-z).to_degrees())
    };
    let swing: Curve = log.samples.iter().zip(&log.loads).map(swing_deg).collect();
    curve_of(stream, "swing", "flown", palette::vehicle(0, 1), swing)?;
    if let Some(planned) =
        is_flyable(run.scenario, run.plan).ok().and_then(|()| PlannedMotion::new(run.scenario, run.plan).ok())
    {
        let curve: Curve = planned.knots.iter().map(|knot| (knot.t_s, knot.tension_n)).collect();
        curve_of(stream, "tension", "planned, without impacts", palette::FLEET, curve)?;
    }
    log_limit(stream, "tension", "highest", model.limits.tension_n, "N", end_s)
}

fn log_tracking(stream: &RecordingStream, log: &VehicleLog, plan_end_s: f64) -> Logged {
    let distance_m = |a: [f64; 3], b: [f64; 3]| (0..3).map(|i| (a[i] - b[i]).powi(2)).sum::<f64>().sqrt();
    let tracked = || log.samples.iter().zip(&log.loads).filter(|(sample, _)| sample.t_s <= plan_end_s);
    let quadrotor: Curve =
        tracked().map(|(sample, _)| (sample.t_s, distance_m(sample.position_m, sample.reference_position_m))).collect();
    curve_of(stream, "tracking", "quadrotor", palette::vehicle(0, 1), quadrotor)?;
    let load: Curve =
        tracked().map(|(sample, load)| (sample.t_s, distance_m(load.position_m, load.reference_position_m))).collect();
    curve_of(stream, "tracking", "load", palette::FLEET, load)
}

/// Of every part and of the envelope, the distance to the obstacle that is nearest; of the body, to the ground too.
fn log_distances(stream: &RecordingStream, run: &Run<'_>, model: &Model, flight: &Flight) -> Logged {
    let Ok(flown) = FlownMotion::new(flight) else { return Ok(()) };
    let (obstacles, parts) = (run.scenario.world.flat_obstacles(), Parts::of(model));
    let ground_m = run.scenario.world.ground_m.unwrap_or(f64::NEG_INFINITY);
    let stride = (DISTANCE_STEP_S / run.scenario.simulation.step_s).round().max(1.0) as usize;
    // What nothing is near to has no curve: infinite points are left out.
    let curve = |distance_m: &dyn Fn(&Body) -> f64| -> Curve {
        flown.motion.samples().iter().step_by(stride).map(|at| (at.t_s, distance_m(&at.body))).collect()
    };
    let nearest = |distance_m: &dyn Fn(&Prism) -> f64| obstacles.iter().map(distance_m).fold(f64::INFINITY, f64::min);
    for (index, part) in Part::ALL.into_iter().enumerate() {
        let distances = curve(&|body| {
            let height_m = if part == Part::Body { parts.height_m(body) - ground_m } else { f64::INFINITY };
            nearest(&|obstacle| parts.distance_m(part, body, obstacle)).min(height_m)
        });
        curve_of(stream, "clearance", part.name(), palette::vehicle(index, 3), distances)?;
    }
    let envelope = curve(&|body| nearest(&|obstacle| parts.envelope_distance_m(body, obstacle)));
    curve_of(stream, "clearance", "envelope", palette::FLEET, envelope)
}

/// Slack and taut, planned and flown.
fn log_states(stream: &RecordingStream, run: &Run<'_>, flight: &Flight) -> Logged {
    let Some(scenarios::Trajectory::SlungLoad(trajectory)) = run.plan.trajectories.first() else { return Ok(()) };
    let Some(first) = trajectory.cable.first() else { return Ok(()) };
    let flown = flight.events.iter().filter_map(|event| match event.kind {
        EventKind::CableTaut { .. } => Some((event.t_s, Cable::Taut)),
        EventKind::CableSlack => Some((event.t_s, Cable::Slack)),
        _ => None,
    });
    let flown: Vec<(f64, Cable)> = [(0.0, *first)].into_iter().chain(flown).collect();
    let changes = [("planned", planned_states(trajectory)), ("flown", flown)];
    for (name, states) in changes {
        let last = states.last().map(|(_, cable)| (end_s(flight), *cable));
        let steps = states.iter().copied().chain(last);
        let steps = steps.map(|(t_s, cable)| (t_s, f64::from(u8::from(cable == Cable::Taut))));
        let colour = if name == "planned" { palette::FLEET } else { palette::vehicle(0, 1) };
        curve_between(stream, "cable", name, colour, (steps.collect(), InterpolationMode::StepAfter))?;
        for (t_s, cable) in states {
            stream.set_duration_secs(SIM_TIME, t_s);
            let state = match cable {
                Cable::Taut => "taut",
                Cable::Slack => "slack",
            };
            stream.log(entity("state/cable", name), &StateChange::single(state))?;
        }
    }
    stream.reset_time();
    Ok(())
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

fn curve_of(stream: &RecordingStream, group: &str, name: &str, colour: [u8; 3], curve: Curve) -> Logged {
    curve_between(stream, group, name, colour, (curve, InterpolationMode::Linear))
}

/// A curve, and what is drawn between its points.
fn curve_between(
    stream: &RecordingStream,
    group: &str,
    name: &str,
    colour: [u8; 3],
    (curve, between): (Curve, InterpolationMode),
) -> Logged {
    let path = entity(&format!("plots/{group}"), name);
    let colour: Color = palette::opaque(colour);
    let style = SeriesLines::new().with_names([name]).with_colors([colour]).with_widths([1.3]);
    let style = style.with_interpolation_mode(between);
    stream.log_static(path.clone(), &style)?;
    let curve = curve.decimated(MOST_POINTS);
    let values = Scalars::new(curve.values).columns_of_unit_batches()?;
    Ok(stream.send_columns(path, [sim_times(curve.times_s)], values)?)
}
