//! The wind at each vehicle as an arrow.

use sim::{Flight, Sample};

use super::body::spaced;
use super::{Animation, Paint, Scene, colours, distance_m, item_path, norm};

/// Time between two arrows, s.
const INTERVAL_S: f64 = 0.5;
/// Length of the arrow of the strongest wind, as a fraction of the diagonal of what is flown through.
const LENGTH: f64 = 0.06;
/// Wind below this is not drawn, m/s.
const CALM_MPS: f64 = 0.05;
/// Arrows of more vehicles hide the vehicles.
const MAX_VEHICLES: usize = 20;

/// Adds an arrow at each vehicle that points to where the wind blows; its length is proportional to the speed.
pub(super) fn add(scene: &mut Scene<'_>, flight: &Flight) {
    let samples = || flight.vehicles.iter().flat_map(|log| &log.samples);
    let strongest_mps = samples().map(|sample| norm(sample.wind_mps)).filter(|it| it.is_finite()).fold(0.0, f64::max);
    let Some(action) = scene.action.filter(|_| strongest_mps > CALM_MPS) else { return };
    if flight.vehicles.len() > MAX_VEHICLES {
        return;
    }
    let scale_s = LENGTH * distance_m(action.min_m, action.max_m) / strongest_mps;
    for log in &flight.vehicles {
        let samples = spaced(&log.samples, INTERVAL_S);
        scene.animations.push(Animation {
            path: item_path(&["wind", &log.vehicle]),
            times_s: samples.iter().map(|sample| sample.t_s).collect(),
            strips: samples.iter().map(|sample| arrow(sample, scale_s)).collect(),
            paints: vec![Paint::opaque(colours::WIND)],
            radius: 1.0,
        });
    }
    scene.legend.push(format!("- pale blue arrow at a vehicle: the wind there; the longest is {strongest_mps:.1} m/s"));
}

/// Shaft and head of an arrow, as one line, m.
fn arrow(sample: &Sample, scale_s: f64) -> Vec<[f64; 3]> {
    let [x, y, z] = sample.position_m;
    let [u, v, w] = sample.wind_mps.map(|wind_mps| if wind_mps.is_finite() { wind_mps * scale_s } else { 0.0 });
    let along =
        |fraction: f64, aside: f64| [x + fraction * u - aside * v, y + fraction * v + aside * u, z + fraction * w];
    vec![along(0.0, 0.0), along(1.0, 0.0), along(0.75, 0.12), along(1.0, 0.0), along(0.75, -0.12)]
}
