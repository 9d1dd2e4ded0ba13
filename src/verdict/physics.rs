//! Does the flight obey the equations of motion, and was it flown as the scenario says?
//!
//! A log is a claim. What moved the vehicle stands in it too (controls, air), so that the motion can be integrated anew,
//! by another method than the simulator's, and compared. A vehicle that jumps, stands still for a moment, swaps places
//! with another, or is moved by something that is not in the log, is found by this and by nothing else. What remains of
//! an honest log is the error of the simulator's integration.

use nalgebra::Vector3;
use rayon::prelude::*;
use scenarios::{CheckSpec, Scenario, Vehicle};
use sim::{Flight, VehicleLog};

use crate::verdict::Check;
use crate::verdict::compare::is_larger;
use crate::verdict::evidence::{Decide, Evidence, Measurement};

/// Largest distance between a flight and its replay, m. An honest flight at 10 ms leaves some hundredths of a millimetre.
pub const LIMIT_M: f64 = 1e-3;

/// The largest difference found between a log and its replay.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Defect {
    /// The larger of the differences of position, and of velocity times the length of the window, m.
    pub defect_m: f64,
    /// When, s.
    pub t_s: f64,
}

impl Defect {
    /// The worse of two; NaN is worse than anything.
    pub fn worse(self, other: Self) -> Self {
        if is_larger(other.defect_m, self.defect_m) { other } else { self }
    }
}

/// The check of the largest defect of any vehicle.
pub fn answer(
    spec: &CheckSpec,
    scenario: &Scenario,
    flight: Evidence<'_, Flight>,
    limit_m: f64,
    largest: impl Fn(&Vehicle, &VehicleLog) -> Result<Option<Defect>, String> + Sync,
) -> Check {
    let flight = match flight {
        Err(reason) => return spec.fail(reason),
        Ok(flight) => flight,
    };
    if flight.vehicles.len() != scenario.vehicles.len() {
        return spec.fail("the logs cannot be matched with the vehicles");
    }
    let logs: Vec<(&Vehicle, &VehicleLog)> = scenario.vehicles.iter().zip(&flight.vehicles).collect();
    let defects: Vec<Result<Option<Defect>, String>> =
        logs.par_iter().map(|(vehicle, log)| largest(vehicle, log)).collect();
    let mut worst: Option<(Defect, &str)> = None;
    for ((vehicle, _), defect) in logs.iter().zip(defects) {
        match defect {
            Err(reason) => return spec.fail(reason),
            Ok(None) => return spec.fail(format!("the log of {} holds no step", vehicle.name)),
            Ok(Some(defect)) if worst.is_none_or(|(worst, _)| is_larger(defect.defect_m, worst.defect_m)) => {
                worst = Some((defect, &vehicle.name));
            }
            Ok(Some(_)) => {}
        }
    }
    match worst {
        None => spec.fail("there is no vehicle"),
        Some((Defect { defect_m, t_s }, vehicle)) => {
            spec.at_most(Measurement::value(defect_m).at(t_s).with(vehicle), limit_m)
        }
    }
}

/// The longer of two differences, m; NaN if either is none.
pub fn difference_m(one: &Vector3<f64>, other: &Vector3<f64>) -> f64 {
    let (one, other) = (one.norm(), other.norm());
    if is_larger(other, one) { other } else { one }
}
