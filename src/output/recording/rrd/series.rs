//! Time series of the flight, and the lines they are held against.

use rayon::prelude::*;
use rerun::{Color, EntityPath, RecordingStream, Scalars, SeriesLines};
use scenarios::Scenario;
use sim::{Flight, VehicleLog};

use super::decimation::Curve;
use super::distances::Distances;
use super::quantity::Quantity;
use super::{Logged, entity, palette, sim_times};
use crate::number_format::given_quantity;

/// Most points of one series.
const MOST_POINTS: usize = 2000;
/// Most points of all series of the vehicles together: in a large fleet each gets fewer.
const MOST_POINTS_OF_FLEET: usize = 240_000;

/// Logs every series of the flight.
pub fn log(stream: &RecordingStream, scenario: &Scenario, flight: &Flight, distances: Distances) -> Logged {
    let end_s = end_s(flight);
    if let (Some(curve), Some(limit_m)) = (distances.separation, scenario.fleet.separation_m) {
        log_fleet(stream, "separation", "smallest separation", curve)?;
        log_limit(stream, "separation", "limit R =", limit_m, "m", end_s)?;
    }
    if let Some(curve) = distances.clearance {
        log_fleet(stream, "clearance", "smallest clearance", curve)?;
        log_limit(stream, "clearance", "surface,", 0.0, "m", end_s)?;
    }
    for quantity in Quantity::ALL {
        log_quantity(stream, quantity, flight)?;
        for (name, value) in quantity.limits(scenario) {
            log_limit(stream, quantity.group(), &name, value, quantity.unit(), end_s)?;
        }
    }
    Ok(())
}

/// Time of the last sample, s; 0 without samples.
pub fn end_s(flight: &Flight) -> f64 {
    let times_s = flight.vehicles.iter().filter_map(|log| log.samples.last()).map(|sample| sample.t_s);
    times_s.filter(|t_s| t_s.is_finite()).fold(0.0, f64::max)
}

/// A quantity of every vehicle over time.
pub fn log_quantity(stream: &RecordingStream, quantity: Quantity, flight: &Flight) -> Logged {
    let count = flight.vehicles.len();
    let points = (MOST_POINTS_OF_FLEET / (count.max(1) * Quantity::ALL.len())).clamp(200, MOST_POINTS);
    // Beyond its end there is no plan to be away from.
    let is_shown = |sample: &&sim::Sample| quantity != Quantity::Tracking || sample.t_s <= flight.plan_end_s;
    let curve = |log: &VehicleLog| -> Curve {
        log.samples.iter().filter(is_shown).map(|sample| (sample.t_s, quantity.of(sample))).collect()
    };
    let curves: Vec<Curve> = flight.vehicles.par_iter().map(|log| curve(log).decimated(points)).collect();
    for (index, (log, curve)) in flight.vehicles.iter().zip(curves).enumerate() {
        let path = entity(&format!("plots/{}", quantity.group()), &log.vehicle);
        log_curve(stream, path, &log.vehicle, palette::opaque(palette::vehicle(index, count)), 1.2, curve)?;
    }
    Ok(())
}

/// A quantity of the fleet as a whole.
pub fn log_fleet(stream: &RecordingStream, group: &str, name: &str, curve: Curve) -> Logged {
    let path = entity("plots", group) / "fleet";
    log_curve(stream, path, name, palette::opaque(palette::FLEET), 1.8, curve.decimated(2 * MOST_POINTS))
}

/// A horizontal line from the beginning to `end_s`, named with its value.
pub fn log_limit(stream: &RecordingStream, group: &str, name: &str, value: f64, unit: &str, end_s: f64) -> Logged {
    let title = format!("{name} {}", given_quantity(value, unit));
    let line: Curve = [(0.0, value), (end_s, value)].into_iter().collect();
    log_curve(stream, entity(&format!("limits/{group}"), name), &title, palette::opaque(palette::LIMIT), 1.5, line)
}

/// A curve with its name and looks.
pub fn log_curve(
    stream: &RecordingStream,
    path: EntityPath,
    name: &str,
    colour: Color,
    width: f32,
    curve: Curve,
) -> Logged {
    let style = SeriesLines::new().with_names([name]).with_colors([colour]).with_widths([width]);
    stream.log_static(path.clone(), &style)?;
    let values = Scalars::new(curve.values).columns_of_unit_batches()?;
    Ok(stream.send_columns(path, [sim_times(curve.times_s)], values)?)
}
