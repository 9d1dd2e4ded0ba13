//! The logged reference against the plan.
//!
//! Tracking is measured against the reference in the log. If that were the reference of another plan, or followed the vehicle
//! instead of the plan, the tracking would look perfect.

use nalgebra::Vector3;
use scenarios::{Scenario, Trajectory, Vehicle};
use sim::VehicleLog;

use crate::verdict::compare::exceeds;

/// Largest difference between the two, m: rounding.
const TOLERANCE_M: f64 = 1e-6;

/// A family's function that finds where the log of a vehicle has another reference than its flyable trajectory, in words.
pub type ReferenceDefect = fn(&Scenario, &Vehicle, &Trajectory, &VehicleLog) -> Option<String>;

/// The defect of a logged reference that is not at the planned position; `whose` is empty or, say, ` for the load`.
pub fn strays(whose: &str, t_s: f64, logged_m: [f64; 3], planned_m: &Vector3<f64>) -> Option<String> {
    let distance_m = (Vector3::from(logged_m) - planned_m).norm();
    exceeds(distance_m, TOLERANCE_M)
        .then(|| format!("at {t_s:.3} s the reference in the log{whose} is {distance_m:.3e} m from that of the plan"))
}
