//! Replay of a flight log: its motion against a second integration of its own controls and air.
//!
//! The log holds what moved the vehicle, so that the motion can be integrated again, by another method than the simulator's.
//! This check alone finds a vehicle that jumps, stops for a moment, swaps places with another, or is moved by something that
//! is not in the log. For a correct log the difference is the integration error of the simulator.

use nalgebra::Vector3;
use rayon::prelude::*;
use scenarios::{CheckSpec, Scenario, Vehicle};
use sim::{Flight, VehicleLog};

use crate::verdict::compare::is_larger;
use crate::verdict::evidence::{CheckResult, Decide, Measurement};
use crate::verdict::missing_evidence::MissingEvidence;

/// Largest distance between a flight and its replay, m. With steps of 10 ms a correct flight has some hundredths of a millimetre.
const LIMIT_M: f64 = 1e-3;

/// The largest difference found between a log and its replay.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Defect {
    /// The larger of the differences of position, and of velocity times the length of the window, m.
    pub defect_m: f64,
    /// Its time, s.
    pub t_s: f64,
}

impl Defect {
    /// The larger of two; NaN counts as the largest.
    pub fn worse(self, other: Self) -> Self {
        if is_larger(other.defect_m, self.defect_m) { other } else { self }
    }
}

/// The check of the largest defect of any vehicle.
///
/// - `largest`: of one vehicle's log; `None` if the log has no step
pub fn check_largest(
    spec: &CheckSpec,
    scenario: &Scenario,
    flight: &Flight,
    largest: impl Fn(&Vehicle, &VehicleLog) -> Result<Option<Defect>, MissingEvidence> + Sync,
) -> CheckResult {
    let (logs, vehicles) = (flight.vehicles.len(), scenario.vehicles.len());
    if logs != vehicles {
        return Err(MissingEvidence::LogCount { logs, vehicles });
    }
    let pairs: Vec<(&Vehicle, &VehicleLog)> = scenario.vehicles.iter().zip(&flight.vehicles).collect();
    let defects: Vec<_> = pairs.par_iter().map(|(vehicle, log)| largest(vehicle, log)).collect();
    let mut worst: Option<(Defect, &str)> = None;
    for ((vehicle, _), defect) in pairs.iter().zip(defects) {
        let defect = defect?.ok_or_else(|| MissingEvidence::EmptyLog { vehicle: vehicle.name.clone() })?;
        if worst.is_none_or(|(worst, _)| is_larger(defect.defect_m, worst.defect_m)) {
            worst = Some((defect, &vehicle.name));
        }
    }
    let (Defect { defect_m, t_s }, vehicle) = worst.ok_or(MissingEvidence::NoVehicle)?;
    Ok(spec.at_most(Measurement::value(defect_m).at(t_s).with(vehicle), LIMIT_M))
}

/// Length of the longer of two differences, m; NaN if either has a NaN.
pub fn difference_m(one: &Vector3<f64>, other: &Vector3<f64>) -> f64 {
    let (one, other) = (one.norm(), other.norm());
    if is_larger(other, one) { other } else { one }
}
