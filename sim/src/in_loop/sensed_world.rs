use nalgebra::Vector3;
use scenarios::in_loop::{Neighbour, Node, ObstacleMeasurement};
use scenarios::{MovingCylinder, Prism, World};

use crate::sensors::Sensors;

/// What one vehicle has found out about the world.
pub(crate) struct SensedWorld {
    range_m: f64,
    truth: World,
    flat: Vec<Prism>,
    /// Obstacles that are not known yet, by name.
    unknown: Vec<String>,
    known: World,
    /// Found since the planner was told.
    news: Vec<String>,
    sensors: Sensors,
}

/// Another vehicle, as it is.
#[derive(Clone, Debug)]
pub(crate) struct Other {
    pub name: String,
    pub body_radius_m: f64,
    pub position_m: Vector3<f64>,
    pub velocity_mps: Vector3<f64>,
    /// What it is going to fly, if that is shared.
    pub plan: Vec<Node>,
}

impl SensedWorld {
    /// Of a vehicle that sees as far as `range_m`, from its centre to a surface. `sensors`: their noise.
    pub fn new(world: &World, range_m: f64, sensors: Sensors) -> Self {
        let moving = |name: &str| world.moving.iter().any(|moving| moving.name == name);
        let unknown = world.obstacle_names().filter(|name| !moving(name) && world.is_hidden(name));
        Self {
            range_m,
            unknown: unknown.map(str::to_owned).collect(),
            known: world.known_before_flight(),
            flat: world.prism_obstacles(),
            truth: world.clone(),
            news: Vec::new(),
            sensors,
        }
    }

    /// Looks around from a position, m. Returns the names of the obstacles that are new.
    pub fn look(&mut self, position_m: &Vector3<f64>) -> Vec<String> {
        let found: Vec<String> =
            self.unknown.iter().filter(|name| self.distance_m(name, position_m) <= self.range_m).cloned().collect();
        if !found.is_empty() {
            self.unknown.retain(|name| !found.contains(name));
            self.known = self.truth.with_static_obstacles(|name| !self.unknown.iter().any(|unknown| unknown == name));
            self.news.extend(found.iter().cloned());
        }
        found
    }

    /// Map and obstacles known so far.
    pub fn known(&self) -> &World {
        &self.known
    }

    /// What was found since this was asked last.
    pub fn news(&mut self) -> Vec<String> {
        std::mem::take(&mut self.news)
    }

    /// The moving obstacles within range, as measured.
    pub fn sightings(&mut self, t_s: f64, position_m: &Vector3<f64>) -> Vec<ObstacleMeasurement> {
        let Self { truth, sensors, range_m, .. } = self;
        let in_range = truth.moving.iter().filter(|it| it.signed_distance_m(t_s, (*position_m).into()) <= *range_m);
        in_range.map(|moving| sighting(moving, t_s, sensors)).collect()
    }

    /// The other vehicles within range, as measured.
    pub fn neighbours(&mut self, position_m: &Vector3<f64>, others: &[Other]) -> Vec<Neighbour> {
        let Self { sensors, range_m, .. } = self;
        let distance_m = |other: &Other| (other.position_m - position_m).norm() - other.body_radius_m;
        let in_range = others.iter().filter(|other| distance_m(other) <= *range_m);
        in_range.map(|other| neighbour(other, sensors)).collect()
    }

    /// From a position to the surface of an obstacle that does not move, m: infinite if there is none.
    fn distance_m(&self, name: &str, position_m: &Vector3<f64>) -> f64 {
        let cylinders = self.truth.cylinders.iter().filter(|it| it.name == name);
        let cylinders = cylinders.map(|it| it.signed_distance_m(position_m.x, position_m.y));
        let flat = self.flat.iter().filter(|it| it.name == name);
        let flat = flat.map(|it| it.signed_distance_in_space_m((*position_m).into()));
        cylinders.chain(flat).fold(f64::INFINITY, f64::min)
    }
}

fn sighting(moving: &MovingCylinder, t_s: f64, sensors: &mut Sensors) -> ObstacleMeasurement {
    let in_space = |[x, y]: [f64; 2]| Vector3::new(x, y, 0.0);
    let seen = sensors.sight(in_space(moving.position_m(t_s)), in_space(moving.velocity_mps(t_s)));
    ObstacleMeasurement {
        name: moving.name.clone(),
        radius_m: moving.radius_m,
        z_m: moving.z_m,
        position_m: [seen.position_m.x, seen.position_m.y],
        velocity_mps: [seen.velocity_mps.x, seen.velocity_mps.y],
    }
}

fn neighbour(other: &Other, sensors: &mut Sensors) -> Neighbour {
    let seen = sensors.sight(other.position_m, other.velocity_mps);
    Neighbour {
        name: other.name.clone(),
        body_radius_m: other.body_radius_m,
        position_m: seen.position_m.into(),
        velocity_mps: seen.velocity_mps.into(),
        plan: other.plan.clone(),
    }
}
