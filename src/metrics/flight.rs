//! Figures of a flight that mean the same for every vehicle that is tracked along a path.

use scenarios::{Plan, Scenario};
use sim::{Flight, Sample};

use super::{FlightMetrics, SmallestDistances, finite};
use crate::verdict::{self, FlownMotions, Motion};

/// Figures of a flight; `None` if its logs cannot be matched with the vehicles.
///
/// - `distances`: the smallest distances of the vehicles' motions
pub fn measure(
    scenario: &Scenario,
    plan: &Plan,
    flight: &Flight,
    distances: impl FnOnce(&[Motion]) -> SmallestDistances,
) -> Option<FlightMetrics> {
    let flown = &FlownMotions::new(scenario, plan, flight).ok()?;
    let vehicles = || flown.vehicles.iter();
    let speed = Dispersion::over(vehicles().map(|vehicle| vehicle.judged.iter().map(airspeed_mps)));
    let altitude = Dispersion::over(vehicles().map(|vehicle| vehicle.judged.iter().map(|sample| sample.position_m[2])));
    let worst = |value: fn(&[Sample]) -> f64| {
        let values: Option<Vec<f64>> = vehicles().map(|vehicle| finite(value(vehicle.tracked))).collect();
        values?.into_iter().reduce(f64::max)
    };
    Some(FlightMetrics {
        flight_time_s: finite(verdict::flown_duration_s(flown)),
        mean_speed_mps: speed.mean,
        speed_std_mps: speed.standard_deviation,
        altitude_std_m: altitude.standard_deviation,
        tracking_max_m: worst(|samples| verdict::largest_tracking_error(samples).0),
        tracking_rms_m: worst(verdict::root_mean_square_tracking_error),
        saturation: worst(verdict::saturation),
        distances: distances(&flown.motions),
    })
}

fn airspeed_mps(sample: &Sample) -> f64 {
    sample.air_velocity_mps().iter().map(|component| component * component).sum::<f64>().sqrt()
}

/// Mean over the vehicles of each one's mean and standard deviation.
pub struct Dispersion {
    /// Mean over the vehicles of their means.
    pub mean: Option<f64>,
    /// Mean over the vehicles of their standard deviations.
    pub standard_deviation: Option<f64>,
}

impl Dispersion {
    /// Over the values of every vehicle.
    pub fn over<V: Iterator<Item = f64> + Clone>(vehicles: impl Iterator<Item = V>) -> Self {
        let (mut count, mut mean, mut standard_deviation) = (0.0, 0.0, 0.0);
        for values in vehicles {
            let length = values.clone().count() as f64;
            let own_mean = values.clone().sum::<f64>() / length;
            let variance = values.map(|value| (value - own_mean).powi(2)).sum::<f64>() / length;
            count += 1.0;
            mean += own_mean;
            standard_deviation += variance.sqrt();
        }
        Self { mean: finite(mean / count), standard_deviation: finite(standard_deviation / count) }
    }
}
