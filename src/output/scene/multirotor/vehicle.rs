//! The moving vehicles: arms and rotors, the sphere that encloses the body, the ring of the sensor range.

use scenarios::{Scenario, Vehicle};
use sim::Flight;

use super::super::body::spaced;
use super::super::{Body, BodyKind, Lines, Paint, Part, Points, Pose, Scene, Sphere, circle, colours, item_path};

/// Time between two poses, s.
const FRAME_S: f64 = 0.03;
/// Points of a circle.
const CIRCLE_POINTS: usize = 64;

/// Adds every vehicle.
pub(super) fn add<'a>(scene: &mut Scene<'a>, scenario: &Scenario, flight: &'a Flight) {
    let count = flight.vehicles.len();
    for (index, (log, vehicle)) in flight.vehicles.iter().zip(&scenario.vehicles).enumerate() {
        scene.bodies.push(Body {
            frame: log.vehicle.clone(),
            path: item_path(&["vehicles", &log.vehicle]),
            kind: BodyKind::Vehicle,
            parts: parts(scenario, vehicle, colours::vehicle(index, count)),
            interval_s: FRAME_S,
            poses: Box::new(|interval_s| spaced(&log.samples, interval_s).iter().map(Pose::of).collect()),
        });
    }
}

fn parts(scenario: &Scenario, vehicle: &Vehicle, colour: [u8; 3]) -> Vec<Part> {
    let model = scenario.multirotor_model(vehicle);
    let radius_m = model.body_radius_m;
    // Four rotors that touch the sphere from inside.
    let (hub, rotor) = (radius_m * 0.42, radius_m * 0.38);
    let hubs = [[hub, -hub], [-hub, -hub], [-hub, hub], [hub, hub]];
    let rotors = hubs.map(|[x, y]| circle([x, y, 0.0], rotor, CIRCLE_POINTS));
    let arms = [[hubs[0], hubs[2]], [hubs[1], hubs[3]]].map(|arm| arm.map(|[x, y]| [x, y, 0.0]).to_vec());
    let frame = Lines::new(rotors.into_iter().chain(arms).collect(), Paint::opaque(colour), 1.6);
    let ring = circle([0.0; 3], model.sensor_range_m, CIRCLE_POINTS);
    vec![
        Part::fixed("frame", frame),
        Part::upright("body", Sphere { radius_m, paint: Paint::translucent(colour, 0.35), radius: 0.4 }),
        Part::upright("sensors", Lines::new(vec![ring], Paint::opaque(colours::MAP), 0.7)),
        Part::upright("name", Points::one([0.0; 3], colour, 1.5, vehicle.name.as_str(), true)),
    ]
}
