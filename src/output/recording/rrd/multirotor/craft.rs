//! The moving vehicles: arms and rotors, the sphere that has to stay clear, the ring of the sensors.

use rerun::components::{FillMode, Translation3D};
use rerun::{Ellipsoids3D, LineStrips3D, Points3D, Quaternion, RecordingStream, Transform3D};
use scenarios::{Scenario, Vehicle};
use sim::{Flight, VehicleLog};

use super::super::paths::spaced;
use super::super::world::pixels;
use super::super::{Logged, SIM_TIME, entity, palette, sim_times, to_f32};

/// Time between two pictures, s.
const FRAME_S: f64 = 0.03;
/// Points of a circle.
const CIRCLE_POINTS: usize = 64;

/// Logs every vehicle.
pub fn log(stream: &RecordingStream, scenario: &Scenario, flight: &Flight) -> Logged {
    let count = flight.vehicles.len();
    for (index, (log, vehicle)) in flight.vehicles.iter().zip(&scenario.vehicles).enumerate() {
        let colour = palette::vehicle(index, count);
        stream.set_duration_secs(SIM_TIME, 0.0);
        log_looks(stream, scenario, vehicle, colour)?;
        stream.reset_time();
        log_motion(stream, log)?;
    }
    Ok(())
}

fn log_looks(stream: &RecordingStream, scenario: &Scenario, vehicle: &Vehicle, colour: [u8; 3]) -> Logged {
    let craft = entity("world/craft", &vehicle.name);
    let model = scenario.multirotor_model(vehicle);
    let body_m = model.body_radius_m;
    // Four rotors that touch the sphere from inside.
    let (hub, rotor) = (body_m * 0.42, body_m * 0.38);
    let hubs = [[hub, -hub], [-hub, -hub], [-hub, hub], [hub, hub]];
    let rotors = hubs.map(|[x, y]| circle([x, y, 0.0], rotor));
    let arms = [[hubs[0], hubs[2]], [hubs[1], hubs[3]]].map(|arm| arm.map(|[x, y]| to_f32([x, y, 0.0])).to_vec());
    let frame = LineStrips3D::new(rotors.into_iter().chain(arms))
        .with_colors([palette::opaque(colour)])
        .with_radii([pixels(1.6)]);
    stream.log(craft.clone() / "frame", &frame)?;
    let sphere = Ellipsoids3D::from_half_sizes([[body_m as f32; 3]])
        .with_colors([palette::translucent(colour, 0.35)])
        .with_line_radii([pixels(0.4)])
        .with_fill_mode(FillMode::MajorWireframe);
    stream.log(craft.clone() / "body", &sphere)?;
    let ring = LineStrips3D::new([circle([0.0; 3], model.sensor_range_m)])
        .with_colors([palette::opaque(palette::MAP)])
        .with_radii([pixels(0.7)]);
    stream.log(craft.clone() / "sensors", &ring)?;
    let name = Points3D::new([[0.0_f32; 3]])
        .with_labels([vehicle.name.as_str()])
        .with_show_labels(true)
        .with_colors([palette::opaque(colour)])
        .with_radii([pixels(1.5)]);
    Ok(stream.log(craft / "name", &name)?)
}

fn log_motion(stream: &RecordingStream, log: &VehicleLog) -> Logged {
    let samples = spaced(&log.samples, FRAME_S);
    let craft = entity("world/craft", &log.vehicle);
    let times = || sim_times(samples.iter().map(|sample| sample.t_s));
    let positions = samples.iter().map(|sample| Translation3D::from(to_f32(sample.position_m)));
    let attitudes = samples.iter().map(|sample| Quaternion::from_xyzw(to_f32(sample.world_from_body)));
    let translations = Transform3D::update_fields().with_many_translation(positions).columns_of_unit_batches()?;
    stream.send_columns(craft.clone(), [times()], translations)?;
    let rotations = Transform3D::update_fields().with_many_quaternion(attitudes).columns_of_unit_batches()?;
    Ok(stream.send_columns(craft / "frame", [times()], rotations)?)
}

fn circle([x, y, z]: [f64; 3], radius_m: f64) -> Vec<[f32; 3]> {
    let point = |i: usize| {
        let (sin, cos) = (std::f64::consts::TAU * i as f64 / CIRCLE_POINTS as f64).sin_cos();
        to_f32([x + radius_m * cos, y + radius_m * sin, z])
    };
    (0..=CIRCLE_POINTS).map(point).collect()
}
