//! What multirotors add to a recording: what they sense, what they plan in the loop, how they move.
//!
//! | entities | what | where it is written |
//! |---|---|---|
//! | `/world/hidden/NAME` | obstacles that are not known beforehand, violet until one vehicle senses them, then red | `obstacles` |
//! | `/world/moving/NAME` | obstacles that move | `obstacles` |
//! | `/world/craft/NAME` | the moving vehicle, its sphere, and the ring of its sensors | `craft` |
//! | `/world/horizon/NAME`, `/world/candidates/NAME` | references of the last replans, fading; best candidates of the last | `planning` |
//! | `/world/cost_map/NAME`, `/world/route/NAME` | edges of the cost map, way from the horizon's end to the goal | `planning` |
//! | `/plots/replan`, `/plots/delay` | wall time of each answer, planning time in the simulation | `planning` |
//! | `/plots/speed`, `/plots/control`, `/plots/tracking`, `/plots/clearance` | time series | here |

mod craft;
mod obstacles;
mod planning;

use rerun::RecordingStream;
use scenarios::multirotor::Plant;
use sim::{Actuation, Flight, Sample};

use super::blueprint::{Blueprint, Part, ViewClass};
use super::decimation::Curve;
use super::distances::Distances;
use super::quantity::Quantity;
use super::series::{end_s, log_curve, log_fleet, log_limit, log_quantity};
use super::{Logged, Run, entity, palette};

type Error = Box<dyn std::error::Error + Send + Sync>;

/// Most points of one series.
const MOST_POINTS: usize = 2000;

/// Logs everything that the flight of multirotors has of its own.
pub fn log(stream: &RecordingStream, run: &Run<'_>, flight: &Flight, distances: Distances) -> Logged {
    obstacles::log(stream, run.scenario, flight)?;
    craft::log(stream, run.scenario, flight)?;
    if let Some(log) = &flight.planning {
        planning::log(stream, run.scenario, log)?;
    }
    log_series(stream, run, flight, distances)
}

/// Tabs beside the verdict: motion, and planning in the loop.
pub fn tabs(layout: &Blueprint, flight: &Flight) -> Result<Vec<Part>, Error> {
    let motion = [
        (plot(layout, flight, "speed", "Speed through the air [m/s]")?, 1.0),
        (plot(layout, flight, "control", "Acceleration [m/s²], or thrust of each rotor [N]")?, 1.0),
    ];
    let mut tabs = vec![layout.rows("Motion", &motion)?];
    if flight.planning.is_some() {
        let planning = [
            (plot(layout, flight, "replan", "Wall time of each answer on this machine [ms]")?, 1.0),
            (plot(layout, flight, "delay", "From question to effect, in the simulation [ms]")?, 1.0),
        ];
        tabs.push(layout.rows("Planning", &planning)?);
    }
    Ok(tabs)
}

fn plot(layout: &Blueprint, flight: &Flight, group: &str, title: &str) -> Result<Part, Error> {
    let contents = [format!("/plots/{group}/**"), format!("/limits/{group}/**")];
    let view = layout.view(ViewClass::TimeSeries, title, "/", &contents)?;
    layout.times(&view, 0.0, 1.25 * end_s(flight))?;
    Ok(view)
}

fn log_series(stream: &RecordingStream, run: &Run<'_>, flight: &Flight, distances: Distances) -> Logged {
    let end_s = end_s(flight);
    if let Some(curve) = distances.clearance {
        log_fleet(stream, "clearance", "smallest clearance", curve)?;
        log_limit(stream, "clearance", "surface,", 0.0, "m", end_s)?;
    }
    if let (Some(curve), Some(limit_m)) = (distances.separation, run.scenario.fleet.separation_m) {
        log_fleet(stream, "separation", "smallest separation", curve)?;
        log_limit(stream, "separation", "limit R =", limit_m, "m", end_s)?;
    }
    log_quantity(stream, Quantity::Tracking, flight)?;
    log_limit(stream, "tracking", "limit", run.scenario.limits().tracking_max_m, "m", end_s)?;
    let count = flight.vehicles.len();
    for (index, (log, vehicle)) in flight.vehicles.iter().zip(&run.scenario.vehicles).enumerate() {
        let colour = palette::opaque(palette::vehicle(index, count));
        let curve_of = |group: &str, name: &str, value: &dyn Fn(&Sample) -> f64| {
            let curve: Curve = log.samples.iter().map(|sample| (sample.t_s, value(sample))).collect();
            let path = entity(&format!("plots/{group}"), name);
            log_curve(stream, path, name, colour, 1.2, curve.decimated(MOST_POINTS))
        };
        curve_of("speed", &log.vehicle, &|sample| norm(sample.air_velocity_mps()))?;
        let model = run.scenario.multirotor_model(vehicle);
        log_limit(
            stream,
            "speed",
            &format!("{} at most", model.limits.speed_mps),
            model.limits.speed_mps,
            "m/s",
            end_s,
        )?;
        match (&model.airframe, model.plant) {
            (Some(airframe), Plant::Quadrotor) => {
                for rotor in 0..4 {
                    curve_of("control", &format!("{} F_{}", log.vehicle, rotor + 1), &|sample| {
                        thrust_n(sample, rotor)
                    })?;
                }
                log_limit(stream, "control", "lowest", airframe.thrust_n.min, "N", end_s)?;
                log_limit(stream, "control", "highest", airframe.thrust_n.max, "N", end_s)?;
            }
            _ => {
                curve_of("control", &log.vehicle, &acceleration_mps2)?;
                log_limit(stream, "control", "highest", model.limits.acceleration_mps2, "m/s²", end_s)?;
            }
        }
    }
    Ok(())
}

fn norm(vector: [f64; 3]) -> f64 {
    vector.iter().map(|component| component * component).sum::<f64>().sqrt()
}

fn acceleration_mps2(sample: &Sample) -> f64 {
    match &sample.actuation {
        Actuation::Acceleration(acceleration) => norm(acceleration.control),
        _ => f64::NAN,
    }
}

fn thrust_n(sample: &Sample, rotor: usize) -> f64 {
    match &sample.actuation {
        Actuation::Thrusts(thrusts) => thrusts.control.thrust_n[rotor],
        _ => f64::NAN,
    }
}
