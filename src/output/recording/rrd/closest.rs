//! Marks in space: where the fleet came closest to a limit, as the judge found it, and where a vehicle crashed.

use rerun::{LineStrips3D, Points3D, RecordingStream};
use scenarios::Cylinder;
use sim::{EventKind, Flight, Sample};

use super::world::pixels;
use super::{Logged, Run, entity, is_drawable, palette, to_f32};
use crate::number_format::quantity;
use crate::verdict::{Check, Status};

/// The checks that have a place, and what to call them there.
const MARKED: [(&str, &str); 2] = [("flight.separation", "separation"), ("flight.clearance", "clearance")];

/// One line between the two that came closest, per check that names them.
pub fn log(stream: &RecordingStream, run: &Run<'_>, flight: &Flight) -> Logged {
    for (name, title) in MARKED {
        let Some(check) = run.verdict.checks.iter().find(|check| check.name == name) else { continue };
        if ended_in_crash(flight, check) {
            continue;
        }
        let Some(ends_m) = ends(run, flight, check) else { continue };
        let colour = if check.status == Status::Pass { palette::KEPT } else { palette::LIMIT };
        let value = check.value.map(|value| quantity(value, &check.unit)).unwrap_or_default();
        let label = format!("{title} {value}");
        let mark = LineStrips3D::new([ends_m.map(to_f32)])
            .with_colors([palette::opaque(colour)])
            .with_radii([pixels(2.5)])
            .with_labels([label])
            .with_show_labels(true);
        stream.log_static(entity("world/closest", name), &mark)?;
    }
    log_crashes(stream, flight)
}

/// Is it the crash itself that was closest? Then the crash's own mark says more, and says it in the same place.
fn ended_in_crash(flight: &Flight, check: &Check) -> bool {
    let Some(at_s) = check.at_s else { return false };
    let mut crashes = flight.events.iter().filter(|event| matches!(event.kind, EventKind::Crash { .. }));
    crashes.any(|crash| {
        (crash.t_s - at_s).abs() <= 2.0 * flight.step_s
            && crash.vehicles.iter().any(|vehicle| check.between.contains(vehicle))
    })
}

/// A dot where each vehicle that crashed was seen last.
fn log_crashes(stream: &RecordingStream, flight: &Flight) -> Logged {
    let crashes = flight.events.iter().filter(|event| matches!(event.kind, EventKind::Crash { .. }));
    for name in crashes.flat_map(|event| &event.vehicles) {
        let Some(log) = flight.vehicles.iter().find(|log| log.vehicle == *name) else { continue };
        let Some(last) = log.samples.iter().rfind(|sample| is_drawable(sample)) else { continue };
        let mark = Points3D::new([to_f32(last.position_m)])
            .with_colors([palette::opaque(palette::LIMIT)])
            .with_radii([pixels(6.0)])
            .with_labels([format!("{name} crashed at {:.1} s", last.t_s)])
            .with_show_labels(true);
        stream.log_static(entity("world/crashed", name), &mark)?;
    }
    Ok(())
}

/// Where the two stood: a vehicle and a vehicle, or a vehicle and the surface of an obstacle, m.
fn ends(run: &Run<'_>, flight: &Flight, check: &Check) -> Option<[[f64; 3]; 2]> {
    let [first, second] = check.between.as_slice() else { return None };
    let at_s = check.at_s?;
    let position_m = |name: &str| position_m(flight, name, at_s);
    let obstacle = |name: &str| run.scenario.world.cylinders.iter().find(|cylinder| cylinder.name == name);
    match (position_m(first), position_m(second)) {
        (Some(a), Some(b)) => Some([a, b]),
        (Some(a), None) => Some([a, surface_point_m(obstacle(second)?, a)]),
        (None, Some(b)) => Some([b, surface_point_m(obstacle(first)?, b)]),
        (None, None) => None,
    }
}

/// Position of a vehicle at the logged instant nearest to `t_s`.
fn position_m(flight: &Flight, vehicle: &str, t_s: f64) -> Option<[f64; 3]> {
    let log = flight.vehicles.iter().find(|log| log.vehicle == vehicle)?;
    let distance_s = |sample: &&Sample| (sample.t_s - t_s).abs();
    let nearest = log.samples.iter().min_by(|a, b| distance_s(a).total_cmp(&distance_s(b)))?;
    is_drawable(nearest).then_some(nearest.position_m)
}

/// The point of the cylinder's surface nearest to `from`, at the same height.
fn surface_point_m(cylinder: &Cylinder, [x, y, z]: [f64; 3]) -> [f64; 3] {
    let [cx, cy] = cylinder.center_m;
    let distance_m = (x - cx).hypot(y - cy).max(f64::MIN_POSITIVE);
    let scale = cylinder.radius_m / distance_m;
    [cx + (x - cx) * scale, cy + (y - cy) * scale, z]
}
