//! The flight of a quadrotor with its load, as the judge looks at it.

use nalgebra::{Quaternion, UnitQuaternion, Vector3};
use sim::slung_load::SlungLoadState;
use sim::{Flight, LoadSample, Sample, VehicleLog};

use super::motion::{MotionSample, SlungLoadMotion};
use super::planned::motions;
use crate::verdict::motion::Motion;

/// A log that can be judged: quadrotor and load over continuous time, hovering after the plan's end included.
#[derive(Clone, Debug)]
pub struct FlownMotion<'a> {
    /// The vehicle's log.
    pub log: &'a VehicleLog,
    /// Quadrotor and load.
    pub motion: SlungLoadMotion,
    /// The quadrotor's centre, and the load's.
    pub motions: [Motion; 2],
}

impl<'a> FlownMotion<'a> {
    /// Refuses, with the reason, a log that cannot be judged.
    pub fn new(flight: &'a Flight) -> Result<Self, String> {
        let [log] = flight.vehicles.as_slice() else {
            return Err(format!("the flight has the logs of {} vehicles, the scenario has one", flight.vehicles.len()));
        };
        if log.loads.len() != log.samples.len() {
            let (loads, samples) = (log.loads.len(), log.samples.len());
            return Err(format!("the log has {samples} samples of the vehicle and {loads} of its load"));
        }
        let samples: Vec<MotionSample> = log.samples.iter().zip(&log.loads).map(instant).collect();
        let motions = motions(&log.vehicle, &samples)?;
        if let Some(sample) = log.samples.iter().find(|sample| !is_attitude(sample.world_from_body)) {
            return Err(format!("the attitude of {} is none at {} s", log.vehicle, sample.t_s));
        }
        Ok(Self { log, motion: SlungLoadMotion::new(samples).sampled(), motions })
    }
}

/// Quadrotor and load at the instant of a sample.
pub fn instant((sample, load): (&Sample, &LoadSample)) -> MotionSample {
    let body = SlungLoadState {
        position_m: sample.position_m.into(),
        velocity_mps: sample.velocity_mps.into(),
        attitude: UnitQuaternion::from_quaternion(Quaternion::from(sample.world_from_body)),
        body_rate_radps: Vector3::zeros(),
        load_position_m: load.position_m.into(),
        load_velocity_mps: load.velocity_mps.into(),
    };
    MotionSample { t_s: sample.t_s, body }
}

fn is_attitude(quaternion: [f64; 4]) -> bool {
    let norm_squared: f64 = quaternion.iter().map(|q| q * q).sum();
    (norm_squared - 1.0).abs() < 1e-6
}
