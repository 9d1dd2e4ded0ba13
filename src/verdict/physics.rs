//! Does the flight obey the equations of motion, and was it flown as the scenario says?
//!
//! A log is a claim. What moved the vehicle stands in it too (controls, air), so that the motion can be integrated anew,
//! by another method than the simulator's, and compared. A vehicle that jumps, stands still for a moment, swaps places
//! with another, or is moved by something that is not in the log, is found by this and by nothing else. What remains of
//! an honest log is the error of the simulator's integration.

use nalgebra::Vector3;
use rayon::prelude::*;
use scenarios::{Scenario, Vehicle};
use sim::fixed_wing::{Acting, Knot, replayed};
use sim::{Flight, Sample, VehicleLog};

use crate::verdict::Check;
use crate::verdict::compare::is_larger;
use crate::verdict::question::{Evidence, Group, Measured, Question};

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

/// Largest distance between a log and where controls and air of that log lead by an independent integrator, restarted at
/// the beginning of every window.
///
/// A window is 2/ω long, ω the natural frequency of the tracker: a constant error d of the acceleration makes d/2 (2/ω)²
/// = 2 d/ω² there, twice what is left of it in closed loop. So the value is also an estimate, to the safe side, of how far
/// a flight by the better integrator would be from this one.
pub fn check(scenario: &Scenario, flight: Evidence<'_, Flight>) -> Check {
    let window_s = 2.0 / scenario.simulation.tracker.natural_frequency_radps;
    let mass_ratio = scenario.simulation.mismatch.mass_ratio;
    answer(scenario, flight, LIMIT_M, |_, log| Ok(largest_defect(log, window_s, mass_ratio)))
}

/// The check of the largest defect of any vehicle.
pub fn answer(
    scenario: &Scenario,
    flight: Evidence<'_, Flight>,
    limit_m: f64,
    largest: impl Fn(&Vehicle, &VehicleLog) -> Result<Option<Defect>, String> + Sync,
) -> Check {
    let question = Question::new(Group::Flight, "dynamics", "m");
    let flight = match flight {
        Err(reason) => return question.fail(reason),
        Ok(flight) => flight,
    };
    if flight.vehicles.len() != scenario.vehicles.len() {
        return question.fail("the logs cannot be matched with the vehicles");
    }
    let logs: Vec<(&Vehicle, &VehicleLog)> = scenario.vehicles.iter().zip(&flight.vehicles).collect();
    let defects: Vec<Result<Option<Defect>, String>> =
        logs.par_iter().map(|(vehicle, log)| largest(vehicle, log)).collect();
    let mut worst: Option<(Defect, &str)> = None;
    for ((vehicle, _), defect) in logs.iter().zip(defects) {
        match defect {
            Err(reason) => return question.fail(reason),
            Ok(None) => return question.fail(format!("the log of {} holds no step", vehicle.name)),
            Ok(Some(defect)) if worst.is_none_or(|(worst, _)| is_larger(defect.defect_m, worst.defect_m)) => {
                worst = Some((defect, &vehicle.name));
            }
            Ok(Some(_)) => {}
        }
    }
    match worst {
        None => question.fail("there is no vehicle"),
        Some((Defect { defect_m, t_s }, vehicle)) => {
            question.at_most(Measured::value(defect_m).at(t_s).with(vehicle), limit_m)
        }
    }
}

/// Of one aircraft. `None` if its log holds no step.
fn largest_defect(log: &VehicleLog, window_s: f64, mass_ratio: f64) -> Option<Defect> {
    let mut worst: Option<Defect> = None;
    let mut began_s = f64::NEG_INFINITY;
    let mut motion = knot(log.samples.first()?);
    for pair in log.samples.windows(2) {
        if pair[0].t_s - began_s >= window_s {
            (motion, began_s) = (knot(&pair[0]), pair[0].t_s);
        }
        let acting = Acting {
            control: pair[0].load_factors().control,
            wind_mps: [pair[0].wind_mps.into(), pair[1].wind_mps.into()],
            mass_ratio,
        };
        motion = replayed(&motion, &acting, pair[1].t_s);
        let logged = knot(&pair[1]);
        let defect_m = difference_m(
            &(motion.position_m - logged.position_m),
            &((motion.velocity_mps - logged.velocity_mps) * window_s),
        );
        let defect = Defect { defect_m, t_s: pair[1].t_s };
        worst = Some(worst.map_or(defect, |worst| worst.worse(defect)));
    }
    worst
}

/// The longer of two differences, m; NaN if either is none.
pub fn difference_m(one: &Vector3<f64>, other: &Vector3<f64>) -> f64 {
    let (one, other) = (one.norm(), other.norm());
    if is_larger(other, one) { other } else { one }
}

fn knot(sample: &Sample) -> Knot {
    Knot { t_s: sample.t_s, position_m: sample.position_m.into(), velocity_mps: sample.velocity_mps.into() }
}
