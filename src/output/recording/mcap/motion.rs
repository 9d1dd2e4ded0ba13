//! What changes over time.

use std::sync::Arc;

use foxglove::messages::{FrameTransform, FrameTransforms, Quaternion, SceneUpdate, Vector3};
use foxglove::{Channel, Context, Encode};
use scenarios::Family;
use scenarios::slung_load::Cable;
use sim::{Actuation, Flight, VehicleLog};

use super::{WORLD, channel, scene, timestamp};
use crate::metrics::{DistanceSample, clearance_over_time, separation_over_time};
use crate::output::recording::{Run, is_drawable};
use crate::verdict::{FlownMotions, is_flyable};

/// Time between two messages of one topic, s.
const INTERVAL_S: f64 = 0.05;

/// One aircraft at one instant.
#[derive(Encode)]
struct Aircraft {
    tracking_error_m: f64,
    airspeed_mps: f64,
    altitude_m: f64,
    n_x: f64,
    n_y: f64,
    n_z: f64,
    is_saturated: bool,
}

/// One quadrotor with its load at one instant.
#[derive(Encode)]
struct Quadrotor {
    tracking_error_m: f64,
    load_tracking_error_m: f64,
    altitude_m: f64,
    thrust_1_n: f64,
    thrust_2_n: f64,
    thrust_3_n: f64,
    thrust_4_n: f64,
    tension_n: f64,
    is_taut: bool,
    is_saturated: bool,
}

/// The fleet at one instant, as far as the scenario asks for it.
#[derive(Encode)]
struct Distances {
    separation_m: Option<f64>,
    separation_limit_m: Option<f64>,
    clearance_m: Option<f64>,
}

/// Logs poses, figures of each vehicle, and the fleet's distances.
pub fn log(context: &Arc<Context>, run: &Run<'_>, flight: &Flight) {
    let stride = (INTERVAL_S / flight.step_s).round().max(1.0) as usize;
    log_poses(context, flight, stride);
    for log in &flight.vehicles {
        match log.loads.is_empty() {
            true => log_aircraft(context, log, stride),
            false => log_quadrotor(context, log, stride),
        }
    }
    log_distances(context, run, flight);
}

fn log_aircraft(context: &Arc<Context>, log: &VehicleLog, stride: usize) {
    let topic: Channel<Aircraft> = channel(context, &format!("/vehicles/{}", log.vehicle));
    for sample in log.samples.iter().step_by(stride).filter(|sample| is_drawable(sample)) {
        let Actuation::LoadFactors(factors) = sample.actuation else { continue };
        let message = Aircraft {
            tracking_error_m: distance_m(sample.position_m, sample.reference_position_m),
            airspeed_mps: distance_m(sample.velocity_mps, sample.wind_mps),
            altitude_m: sample.position_m[2],
            n_x: factors.control.n_x,
            n_y: factors.control.n_y,
            n_z: factors.control.n_z,
            is_saturated: sample.is_saturated(),
        };
        topic.log_with_time(&message, timestamp(sample.t_s));
    }
}

/// The quadrotor's figures, and the cable as a line that is replaced at every instant.
fn log_quadrotor(context: &Arc<Context>, log: &VehicleLog, stride: usize) {
    let topic: Channel<Quadrotor> = channel(context, &format!("/vehicles/{}", log.vehicle));
    let cables: Channel<SceneUpdate> = channel(context, &format!("/cables/{}", log.vehicle));
    let steps = log.samples.iter().zip(&log.loads).step_by(stride);
    for (sample, load) in steps.filter(|(sample, _)| is_drawable(sample)) {
        let Actuation::Thrusts(thrusts) = sample.actuation else { continue };
        let [thrust_1_n, thrust_2_n, thrust_3_n, thrust_4_n] = thrusts.control.thrust_n;
        let message = Quadrotor {
            tracking_error_m: distance_m(sample.position_m, sample.reference_position_m),
            load_tracking_error_m: distance_m(load.position_m, load.reference_position_m),
            altitude_m: sample.position_m[2],
            thrust_1_n,
            thrust_2_n,
            thrust_3_n,
            thrust_4_n,
            tension_n: load.tension_n,
            is_taut: load.cable == Cable::Taut,
            is_saturated: sample.is_saturated(),
        };
        topic.log_with_time(&message, timestamp(sample.t_s));
        let cable = scene::cable(&log.vehicle, sample, load);
        cables.log_with_time(&SceneUpdate { deletions: Vec::new(), entities: vec![cable] }, timestamp(sample.t_s));
    }
}

/// One message per instant, with all vehicles that still fly.
fn log_poses(context: &Arc<Context>, flight: &Flight, stride: usize) {
    let topic: Channel<FrameTransforms> = channel(context, "/tf");
    let steps = flight.vehicles.iter().map(|log| log.samples.len()).max().unwrap_or(0);
    for step in (0..steps).step_by(stride) {
        let transforms: Vec<FrameTransform> = flight.vehicles.iter().flat_map(|log| transforms(log, step)).collect();
        if !transforms.is_empty() {
            topic.log_with_time(&FrameTransforms { transforms }, timestamp(step as f64 * flight.step_s));
        }
    }
}

/// Where a vehicle and its load are at a step, as long as it flies.
fn transforms(log: &VehicleLog, step: usize) -> Vec<FrameTransform> {
    let Some(sample) = log.samples.get(step).filter(|sample| is_drawable(sample)) else { return Vec::new() };
    let load = log.loads.get(step).map(|load| {
        let attitude = [0.0, 0.0, 0.0, 1.0];
        transform(&format!("{}/load", log.vehicle), sample.t_s, load.position_m, attitude)
    });
    let vehicle = transform(&log.vehicle, sample.t_s, sample.position_m, sample.world_from_body);
    std::iter::once(vehicle).chain(load).collect()
}

fn transform(frame: &str, t_s: f64, [x, y, z]: [f64; 3], [qx, qy, qz, qw]: [f64; 4]) -> FrameTransform {
    FrameTransform {
        timestamp: Some(timestamp(t_s)),
        parent_frame_id: WORLD.to_owned(),
        child_frame_id: frame.to_owned(),
        translation: Some(Vector3 { x, y, z }),
        rotation: Some(Quaternion { x: qx, y: qy, z: qz, w: qw }),
    }
}

fn distance_m(a: [f64; 3], b: [f64; 3]) -> f64 {
    (0..3).map(|axis| (a[axis] - b[axis]).powi(2)).sum::<f64>().sqrt()
}

fn log_distances(context: &Arc<Context>, run: &Run<'_>, flight: &Flight) {
    // of one vehicle with a load the judge knows more than its centre
    if is_flyable(run.scenario, run.plan).is_err() || run.scenario.family() == Family::SlungLoad {
        return;
    }
    let Ok(flown) = FlownMotions::new(run.scenario, run.plan, flight) else { return };
    let separation = separation_over_time(&flown.motions, INTERVAL_S);
    let clearance = clearance_over_time(&flown.motions, &run.scenario.world.cylinders, INTERVAL_S);
    let topic: Channel<Distances> = channel(context, "/distances");
    let at = |series: &[DistanceSample], index: usize| series.get(index).map(|nearest| nearest.distance_m);
    let longest = if separation.len() > clearance.len() { &separation } else { &clearance };
    for (index, instant) in longest.iter().enumerate() {
        let message = Distances {
            separation_m: at(&separation, index),
            separation_limit_m: run.scenario.fleet.separation_m,
            clearance_m: at(&clearance, index),
        };
        topic.log_with_time(&message, timestamp(instant.t_s));
    }
}
