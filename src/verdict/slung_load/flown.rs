//! The logged flight of a quadrotor and its load as a continuous motion.

use nalgebra::{Quaternion, UnitQuaternion, Vector3};
use sim::slung_load::SlungLoadState;
use sim::{Flight, LoadSample, Sample, VehicleLog};

use super::motion::{MotionSample, SlungLoadMotion};
use super::planned::motions;
use crate::verdict::missing_evidence::MissingEvidence;
use crate::verdict::motion::Motion;

/// A log that can be judged: quadrotor and load over continuous time, including the hover after the plan's end.
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
    /// The motion of the scenario's one vehicle.
    ///
    /// # Errors
    ///
    /// There is not exactly one log; vehicle and load differ in their number of samples; the motion or the attitude cannot be
    /// judged.
    pub fn new(flight: &'a Flight) -> Result<Self, MissingEvidence> {
        let [log] = flight.vehicles.as_slice() else {
            return Err(MissingEvidence::LogCount { logs: flight.vehicles.len(), vehicles: 1 });
        };
        let vehicle = log.vehicle.clone();
        let (samples, loads) = (log.samples.len(), log.loads.len());
        if loads != samples {
            return Err(MissingEvidence::LoadSampleCount { vehicle, samples, loads });
        }
        let samples: Vec<MotionSample> = log.samples.iter().zip(&log.loads).map(motion_sample).collect();
        let motions = motions(&log.vehicle, &samples)?;
        if let Some(sample) = log.samples.iter().find(|sample| !is_attitude(sample.world_from_body)) {
            return Err(MissingEvidence::NotARotation { vehicle, t_s: sample.t_s });
        }
        Ok(Self { log, motion: SlungLoadMotion::new(samples).sampled(), motions })
    }
}

/// Quadrotor and load at a sample of their logs.
pub fn motion_sample((sample, load): (&Sample, &LoadSample)) -> MotionSample {
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
