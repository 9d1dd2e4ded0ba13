//! Smallest distances of the fleet over time, as the judge sees the flight.

use scenarios::Family;

use crate::metrics::{DistanceSample, clearance_in_space_over_time, clearance_over_time, separation_over_time};
use crate::verdict::{FlownMotions, is_flyable};

use super::Run;
use super::decimation::Curve;

/// Time between two points, s.
const STEP_S: f64 = 0.02;

/// Smallest separation and clearance of the fleet over time, m. Absent: not asked for, or not to be had from this flight.
#[derive(Clone, Debug, Default)]
pub struct Distances {
    /// Horizontal distance between the two vehicles that are closest.
    pub separation: Option<Curve>,
    /// Distance from an obstacle's surface to the vehicle that is closest; negative inside.
    pub clearance: Option<Curve>,
}

impl Distances {
    /// Of the flight in `run`, if there is one.
    pub fn of(run: &Run<'_>) -> Self {
        let flight = run.flight.filter(|_| is_flyable(run.scenario, run.plan).is_ok());
        let Some(Ok(flown)) = flight.map(|flight| FlownMotions::new(run.scenario, run.plan, flight)) else {
            return Self::default();
        };
        let cylinders = &run.scenario.world.cylinders;
        let clearance = match run.scenario.family() {
            Family::Multirotor => clearance_in_space_over_time(run.scenario, &flown.motions, STEP_S),
            _ => clearance_over_time(&flown.motions, cylinders, STEP_S),
        };
        let separation = match run.scenario.fleet.separation_m {
            Some(_) => separation_over_time(&flown.motions, STEP_S),
            None => Vec::new(),
        };
        Self {
            separation: with_worst(run, "flight.separation", &separation),
            clearance: with_worst(run, "flight.clearance", &clearance),
        }
    }
}

/// The curve through `series` and through the worst instant of the check: it lies between two instants of the series, and
/// the picture must not look better than the verdict.
fn with_worst(run: &Run<'_>, check: &str, series: &[DistanceSample]) -> Option<Curve> {
    let check = run.verdict.checks.iter().find(|candidate| candidate.name == check);
    let worst = check.and_then(|check| Some((check.at_s?, check.value?)));
    let mut points: Vec<(f64, f64)> = series.iter().map(|nearest| (nearest.t_s, nearest.distance_m)).collect();
    if points.is_empty() {
        return None;
    }
    points.extend(worst);
    points.sort_by(|a, b| a.0.total_cmp(&b.0));
    Some(points.into_iter().collect())
}
