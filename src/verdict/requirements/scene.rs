//! What formulas are about: bodies, obstacles, geofences and logs.

use scenarios::geometry::{Solid, TerrainGrid};
use scenarios::requirement::{Quantity, Subject};
use scenarios::{Cylinder, Geofence, GeofenceKind, MovingCylinder, Prism, Scenario};
use sim::{Actuation, Flight, Sample};

use crate::verdict::compare::larger;
use crate::verdict::motion::Motion;
use crate::verdict::requirements::body::Body;
use crate::verdict::requirements::interval::Interval;

/// The bodies of a motion, planned or flown, and what surrounds them.
pub struct Scene<'a> {
    pub scenario: &'a Scenario,
    /// The vehicles, in the order of the scenario; after them the load, if there is one.
    pub bodies: Vec<Body<'a>>,
    pub obstacles: Vec<Obstacle<'a>>,
    /// The geofences, positive inside whatever their kind.
    pub geofences: Vec<Geofence>,
    /// Of the solid that is the terrain, if there is one.
    terrain: Option<Solid>,
    flight: Option<&'a Flight>,
}

/// An obstacle by its name, in space and as seen from above.
pub struct Obstacle<'a> {
    pub name: String,
    pub shape: Shape<'a>,
}

/// What bounds an obstacle.
pub enum Shape<'a> {
    /// Unbounded upwards and downwards.
    Cylinder(&'a Cylinder),
    /// A volume to keep out of, and the same without top and bottom.
    Prism([Geofence; 2]),
    /// The same.
    Moving([MovingCylinder; 2]),
    /// Any other shape.
    Solid(Solid),
}

impl<'a> Scene<'a> {
    /// - `flight`: the logs of a flown motion; `None` for a planned one
    pub fn new(scenario: &'a Scenario, motions: &'a [Motion], flight: Option<&'a Flight>) -> Self {
        let world = &scenario.world;
        let cylinders = world.cylinders.iter().map(|it| (it.name.as_str(), Shape::Cylinder(it)));
        let boxes = world.boxes.iter().map(|it| (it.name.as_str(), prism(&it.as_prism())));
        let prisms = world.prisms.iter().map(|it| (it.name.as_str(), prism(it)));
        let moving = world.moving.iter().map(|it| {
            let seen_from_above = MovingCylinder { z_m: None, ..it.clone() };
            (it.name.as_str(), Shape::Moving([it.clone(), seen_from_above]))
        });
        let upright = cylinders.chain(boxes).chain(prisms).chain(moving).map(|(name, shape)| (name.to_owned(), shape));
        let solids = world.solids().into_iter().map(|it| (it.name().to_owned(), Shape::Solid(it)));
        let obstacles = upright.chain(solids);
        let inside = |fence: &Geofence| Geofence { kind: GeofenceKind::StayIn, ..fence.clone() };
        Self {
            scenario,
            bodies: motions.iter().map(Body::new).collect(),
            obstacles: obstacles.map(|(name, shape)| Obstacle { name, shape }).collect(),
            geofences: world.geofences.iter().map(inside).collect(),
            terrain: world.solids().into_iter().find(Solid::is_terrain),
            flight,
        }
    }

    /// Whether there is a log of the flight, for quantities that the motion does not show.
    pub fn is_logged(&self) -> bool {
        self.flight.is_some()
    }

    /// The index of the body that a subject stands for.
    ///
    /// - `assigned`: the vehicle of every variable
    pub fn body_of(&self, subject: Subject, assigned: &[usize]) -> usize {
        match subject {
            Subject::Vehicle(index) => index,
            Subject::Variable(variable) => assigned[variable],
            Subject::Load => self.scenario.vehicles.len(),
        }
    }

    /// The heights of the terrain, if there is one.
    pub fn terrain(&self) -> Option<&TerrainGrid> {
        self.terrain.as_ref()?.terrain_grid()
    }

    /// Bounds of a logged quantity of a vehicle over an interval of time. A sample holds until the next one.
    pub fn logged(&self, quantity: Quantity, vehicle: usize, [from_s, to_s]: [f64; 2]) -> Interval {
        let Some(log) = self.flight.and_then(|flight| flight.vehicles.get(vehicle)) else { return Interval::ALL };
        let first = log.samples.partition_point(|sample| sample.t_s <= from_s).max(1) - 1;
        let end = log.samples.partition_point(|sample| sample.t_s <= to_s).max(first + 1);
        let values = (first..end.min(log.samples.len())).map(|index| match quantity {
            Quantity::Tension => log.loads.get(index).map_or(f64::NAN, |load| load.tension_n),
            _ => logged_value(quantity, &log.samples[index]),
        });
        Interval::hull(values)
    }
}

fn logged_value(quantity: Quantity, sample: &Sample) -> f64 {
    let norm = |a: [f64; 3], b: [f64; 3]| (0..3).map(|axis| (a[axis] - b[axis]).powi(2)).sum::<f64>().sqrt();
    match quantity {
        Quantity::Airspeed => norm(sample.velocity_mps, sample.wind_mps),
        Quantity::WindSpeed => norm(sample.wind_mps, [0.0; 3]),
        Quantity::TrackingError => norm(sample.position_m, sample.reference_position_m),
        Quantity::Bank => {
            let [x, y, z, w] = sample.world_from_body;
            // The vertical component of the body's y axis.
            (2.0 * (y * z + w * x)).abs().min(1.0).asin()
        }
        Quantity::LoadFactor(axis) => match &sample.actuation {
            Actuation::LoadFactors(it) => it.control.to_array()[axis],
            _ => f64::NAN,
        },
        Quantity::Thrust => match &sample.actuation {
            Actuation::Thrusts(it) => it.control.thrust_n.into_iter().fold(f64::NEG_INFINITY, larger),
            _ => f64::NAN,
        },
        _ => f64::NAN,
    }
}

fn prism<'a>(prism: &Prism) -> Shape<'a> {
    let volume = |z_m| Geofence {
        name: prism.name.clone(),
        kind: GeofenceKind::KeepOut,
        polygon_m: prism.corners_m.clone(),
        rings_m: Vec::new(),
        z_m,
    };
    Shape::Prism([volume(prism.z_m), volume(None)])
}
