//! Absolute and relative pose error of the flown path against the planned one, by the definitions and names of evo
//! (translation part, no alignment), so that figures can be compared with those of other people's tools.
//!
//! A pose here is a position and the direction of motion with level wings, of a quadrotor the world's axes: the same for
//! plan and flight, so that banking does not count as an error. [Sturm et al. 2012, A benchmark for the evaluation of RGB-D SLAM systems, section V]

use nalgebra::{Quaternion, UnitQuaternion, Vector3};
use scenarios::fixed_wing::Control;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use sim::fixed_wing::world_from_body;
use sim::{Actuation, Flight, Sample, VehicleLog};

use crate::statistics;

/// Time between two poses, s.
const INTERVAL_S: f64 = 0.1;
/// Poses between the two ends of a relative error: 1 s.
const DELTA: usize = 10;

/// The pose of a body at one instant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pose {
    /// When, s.
    pub t_s: f64,
    /// Position in the world frame, m.
    pub position_m: [f64; 3],
    /// Attitude as a unit quaternion (x, y, z, w).
    pub world_from_body: [f64; 4],
}

/// Pose errors of one vehicle, while it follows its plan.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct VehicleErrors {
    /// Name of the vehicle.
    pub vehicle: String,
    /// Absolute pose error: distance between flown and planned position, at 10 Hz.
    pub ape: Statistics,
    /// Relative pose error: difference of the ways covered in 1 s, each in its own frame at the beginning.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub rpe: Option<Statistics>,
}

/// Statistics of errors, m, by the names of evo.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Statistics {
    /// Root of the mean square, m.
    pub rmse: f64,
    /// Mean, m.
    pub mean: f64,
    /// Median, m.
    pub median: f64,
    /// Standard deviation of all errors, m.
    pub std: f64,
    /// Smallest, m.
    pub min: f64,
    /// Largest, m.
    pub max: f64,
}

/// Errors of every vehicle whose errors are numbers.
pub fn of_fleet(flight: &Flight) -> Vec<VehicleErrors> {
    let of_vehicle = |log: &VehicleLog| {
        let (planned, flown) = (planned(log, flight), flown(log, flight));
        let ape = Statistics::of(absolute(&planned, &flown))?;
        Some(VehicleErrors {
            vehicle: log.vehicle.clone(),
            ape,
            rpe: Statistics::of(relative(&planned, &flown, DELTA)),
        })
    };
    flight.vehicles.iter().filter_map(of_vehicle).collect()
}

/// The planned path at 10 Hz, until the plan ends.
pub fn planned(log: &VehicleLog, flight: &Flight) -> Vec<Pose> {
    poses(log, flight, |sample| (sample.reference_position_m, sample.reference_velocity_mps))
}

/// The flown path at the same instants.
pub fn flown(log: &VehicleLog, flight: &Flight) -> Vec<Pose> {
    poses(log, flight, |sample| (sample.position_m, sample.velocity_mps))
}

fn poses(log: &VehicleLog, flight: &Flight, of: impl Fn(&Sample) -> ([f64; 3], [f64; 3])) -> Vec<Pose> {
    let stride = (INTERVAL_S / flight.step_s).round().max(1.0) as usize;
    let during_plan = log.samples.iter().step_by(stride).take_while(|sample| sample.t_s <= flight.plan_end_s);
    during_plan
        .map(|sample| {
            let (position_m, velocity_mps) = of(sample);
            let world_from_body = match sample.actuation {
                Actuation::LoadFactors(_) => world_from_body(&Vector3::from(velocity_mps), Control::CRUISE),
                // what hovers has no direction of motion
                Actuation::Thrusts(_) | Actuation::Acceleration(_) => [0.0, 0.0, 0.0, 1.0],
            };
            Pose { t_s: sample.t_s, position_m, world_from_body }
        })
        .collect()
}

/// |p - q| of every pair of poses, m.
pub fn absolute(reference: &[Pose], estimate: &[Pose]) -> Vec<f64> {
    let distance = |(q, p): (&Pose, &Pose)| (Vector3::from(p.position_m) - Vector3::from(q.position_m)).norm();
    reference.iter().zip(estimate).map(distance).collect()
}

/// The translation of (Q_i⁻¹ Q_j)⁻¹ (P_i⁻¹ P_j) for every j = i + `delta`, i a multiple of `delta`, m.
pub fn relative(reference: &[Pose], estimate: &[Pose], delta: usize) -> Vec<f64> {
    let way = |poses: &[Pose], i: usize| {
        let [x, y, z, w] = poses[i].world_from_body;
        let body_from_world = UnitQuaternion::new_normalize(Quaternion::new(w, x, y, z)).inverse();
        body_from_world * (Vector3::from(poses[i + delta].position_m) - Vector3::from(poses[i].position_m))
    };
    let count = reference.len().min(estimate.len());
    (0..count.saturating_sub(delta)).step_by(delta).map(|i| (way(estimate, i) - way(reference, i)).norm()).collect()
}

impl Statistics {
    /// Of `errors`; `None` of none, or if one of them is not a number.
    pub fn of(mut errors: Vec<f64>) -> Option<Self> {
        if errors.is_empty() || errors.iter().any(|error| !error.is_finite()) {
            return None;
        }
        errors.sort_by(f64::total_cmp);
        let n = errors.len();
        let mean_of = |f: &dyn Fn(f64) -> f64| errors.iter().map(|error| f(*error)).sum::<f64>() / n as f64;
        let mean = mean_of(&|error| error);
        Some(Self {
            rmse: mean_of(&|error| error * error).sqrt(),
            mean,
            median: statistics::median(&errors)?,
            std: mean_of(&|error| (error - mean).powi(2)).sqrt(),
            min: errors[0],
            max: errors[n - 1],
        })
    }
}

#[cfg(test)]
mod tests {
    use super::{Pose, Statistics, absolute, relative};

    /// 61 poses, 0.1 s apart: a reference, and an estimate that wanders about it and yaws.
    fn paths() -> (Vec<Pose>, Vec<Pose>) {
        let pose = |t_s: f64, position_m: [f64; 3], yaw: f64| Pose {
            t_s,
            position_m,
            world_from_body: [0.0, 0.0, (yaw / 2.0).sin(), (yaw / 2.0).cos()],
        };
        let reference = |t: f64| [30.0 * (0.2 * t).sin(), 30.0 * (0.3 * t).cos(), 400.0 + 0.5 * t];
        let estimate = |t: f64| {
            let [x, y, z] = reference(t);
            [x + 0.3 * (2.0 * t).sin(), y + 0.1 * (5.0 * t).cos(), z + 0.05 * t]
        };
        let times = || (0..61).map(|k| 0.1 * f64::from(k));
        let references = times().map(|t| pose(t, reference(t), 0.2 * t)).collect();
        (references, times().map(|t| pose(t, estimate(t), 0.2 * t + 0.01 * t.sin())).collect())
    }

    fn assert_near(errors: Vec<f64>, expected: [f64; 6]) {
        let Statistics { rmse, mean, median, std, min, max } = Statistics::of(errors).expect("statistics");
        for (found, expected) in [rmse, mean, median, std, min, max].into_iter().zip(expected) {
            assert!((found - expected).abs() < 1e-12, "{found} instead of {expected}");
        }
    }

    /// Computed from these very paths by evo 1.38.1, `APE(translation_part)`: rmse, mean, median, std, min, max.
    #[test]
    fn absolute_errors_are_those_of_evo() {
        let (reference, estimate) = paths();
        let evo = [
            0.28522196193146343,
            0.2722832099408489,
            0.2803847150161234,
            0.08493186182076043,
            0.08317680718963609,
            0.4170816620429762,
        ];
        assert_near(absolute(&reference, &estimate), evo);
    }

    /// By `RPE(translation_part, delta=10, Unit.frames)` of the same.
    #[test]
    fn relative_errors_are_those_of_evo() {
        let (reference, estimate) = paths();
        let evo = [
            0.3501260810517247,
            0.31090205377525765,
            0.3377147298030688,
            0.16102231395358133,
            0.10875857648980265,
            0.5583708173825888,
        ];
        assert_near(relative(&reference, &estimate, 10), evo);
    }

    #[test]
    fn of_nothing_and_of_what_is_no_number_there_are_no_statistics() {
        assert_eq!(Statistics::of(Vec::new()), None);
        assert_eq!(Statistics::of(vec![1.0, f64::NAN]), None);
    }
}
