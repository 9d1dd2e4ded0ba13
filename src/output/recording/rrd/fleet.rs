//! The moving aircraft: position, attitude, name, safety volume.

use rerun::components::{FillMode, Translation3D};
use rerun::{Cylinders3D, Points3D, Quaternion, RecordingStream, Transform3D};
use scenarios::Scenario;
use sim::{Flight, Sample, VehicleLog};

use super::paths::spaced;
use super::world::pixels;
use super::{Logged, SIM_TIME, airframe, entity, palette, sim_times, to_f32};

/// Shortest time between two poses, s.
const POSE_INTERVAL_S: f64 = 0.1;
/// Most poses of a whole fleet: a large one is shown at a lower rate.
const MOST_POSES: f64 = 60_000.0;
/// Drawn wing span as a share of the map's larger side.
const SPAN_OF_MAP: f64 = 0.028;
/// Fleets larger than this show no names until an aircraft is pointed at.
const MOST_NAMES: usize = 20;

/// Wing span that aircraft are drawn with, m: large enough to be seen on the whole map.
///
/// More than a handful must be drawn smaller, or they hide each other.
pub fn drawn_span_m(scenario: &Scenario) -> f64 {
    let map = &scenario.world.map;
    let crowd = (scenario.vehicles.len() as f64 / 10.0).max(1.0).sqrt();
    SPAN_OF_MAP * map.x_m.width().max(map.y_m.width()) / crowd
}

/// Logs every aircraft of the flight.
pub fn log(stream: &RecordingStream, scenario: &Scenario, flight: &Flight) -> Logged {
    let time_flown_s: f64 = flight.vehicles.iter().map(|log| log.samples.len() as f64 * flight.step_s).sum();
    let interval_s = POSE_INTERVAL_S.max(time_flown_s / MOST_POSES);
    // The looks never change, but they are not static: on the planner's timeline, without poses, all would stand at 0.
    stream.set_duration_secs(SIM_TIME, 0.0);
    for (index, log) in flight.vehicles.iter().enumerate() {
        let colour = palette::vehicle(index, flight.vehicles.len());
        log_appearance(stream, scenario, log, colour)?;
        log_motion(stream, log, &spaced(&log.samples, interval_s))?;
    }
    stream.reset_time();
    Ok(())
}

fn log_appearance(stream: &RecordingStream, scenario: &Scenario, log: &VehicleLog, colour: [u8; 3]) -> Logged {
    let vehicle = entity("world/fleet", &log.vehicle);
    stream.log(vehicle.clone() / "airframe", &airframe::mesh(drawn_span_m(scenario), colour))?;
    let name = Points3D::new([[0.0_f32; 3]])
        .with_labels([log.vehicle.as_str()])
        .with_show_labels(scenario.vehicles.len() <= MOST_NAMES)
        .with_colors([palette::opaque(colour)])
        .with_radii([pixels(1.5)]);
    stream.log(vehicle.clone() / "name", &name)?;
    if let Some(separation_m) = scenario.fleet.separation_m {
        stream.log(vehicle / "safety", &safety_volume(scenario, separation_m, colour))?;
    }
    Ok(())
}

/// Upright cylinder of radius R/2: two of them touch when the separation is R. The rule is horizontal, so that its
/// height says nothing; a quarter of the map's is enough to be seen.
fn safety_volume(scenario: &Scenario, separation_m: f64, colour: [u8; 3]) -> Cylinders3D {
    let height_m = scenario.world.map.z_m.width() / 4.0;
    Cylinders3D::from_lengths_and_radii([height_m as f32], [(separation_m / 2.0) as f32])
        .with_colors([palette::translucent(colour, 0.7)])
        .with_line_radii([pixels(0.5)])
        .with_fill_mode(FillMode::TransparentFillMajorWireframe)
}

/// The position moves the vehicle, the attitude only its airframe: name and safety volume stay upright.
fn log_motion(stream: &RecordingStream, log: &VehicleLog, samples: &[Sample]) -> Logged {
    let vehicle = entity("world/fleet", &log.vehicle);
    let times = || sim_times(samples.iter().map(|sample| sample.t_s));
    let positions = samples.iter().map(|sample| Translation3D::from(to_f32(sample.position_m)));
    let attitudes = samples.iter().map(|sample| Quaternion::from_xyzw(to_f32(sample.world_from_body)));
    let translations = Transform3D::update_fields().with_many_translation(positions).columns_of_unit_batches()?;
    stream.send_columns(vehicle.clone(), [times()], translations)?;
    let rotations = Transform3D::update_fields().with_many_quaternion(attitudes).columns_of_unit_batches()?;
    Ok(stream.send_columns(vehicle / "airframe", [times()], rotations)?)
}
