use nalgebra::Vector3;
use scenarios::in_loop::{Neighbour, Node, ObstacleMeasurement};
use scenarios::{MovingCylinder, Prism, World};

use crate::sensors::Sensors;

/// What one vehicle knows of the world.
pub(super) struct SensedWorld {
    range_m: f64,
    truth: World,
    prisms: Vec<Prism>,
    /// Names of the obstacles that are not known yet.
    unknown: Vec<String>,
    known: World,
    /// Names of the obstacles that were discovered since the planner's previous call.
    discovered: Vec<String>,
    sensors: Sensors,
}

/// The truth about another vehicle.
#[derive(Clone, Debug)]
pub(super) struct Other {
    pub name: String,
    pub body_radius_m: f64,
    pub position_m: Vector3<f64>,
    pub velocity_mps: Vector3<f64>,
    /// Its accepted reference if the fleet shares plans; otherwise empty.
    pub plan: Vec<Node>,
}

impl SensedWorld {
    /// Of a vehicle whose sensors reach `range_m`, from its centre to a surface. `sensors`: their noise.
    pub fn new(world: &World, range_m: f64, sensors: Sensors) -> Self {
        let unknown = world.names_that_may_be_hidden().filter(|name| world.is_hidden(name));
        Self {
            range_m,
            unknown: unknown.map(str::to_owned).collect(),
            known: world.known_before_flight(),
            prisms: world.prism_obstacles(),
            truth: world.clone(),
            discovered: Vec::new(),
            sensors,
        }
    }

    /// Adds the obstacles within range of a position, m, to the known ones. Returns the names of those that are new.
    pub fn discover(&mut self, position_m: &Vector3<f64>) -> Vec<String> {
        let new: Vec<String> =
            self.unknown.iter().filter(|name| self.distance_m(name, position_m) <= self.range_m).cloned().collect();
        if !new.is_empty() {
            self.unknown.retain(|name| !new.contains(name));
            self.known = self.truth.with_static_obstacles(|name| !self.unknown.iter().any(|unknown| unknown == name));
            self.discovered.extend(new.iter().cloned());
        }
        new
    }

    /// Map and obstacles known so far.
    pub fn known(&self) -> &World {
        &self.known
    }

    /// Names of the obstacles that were discovered since the previous call of this.
    pub fn take_discovered(&mut self) -> Vec<String> {
        std::mem::take(&mut self.discovered)
    }

    /// Measurements of the moving obstacles within range.
    pub fn measure_moving(&mut self, t_s: f64, position_m: &Vector3<f64>) -> Vec<ObstacleMeasurement> {
        let Self { truth, sensors, range_m, .. } = self;
        let in_range = truth.moving.iter().filter(|it| it.signed_distance_m(t_s, (*position_m).into()) <= *range_m);
        in_range.map(|moving| measurement_of(moving, t_s, sensors)).collect()
    }

    /// Measurements of the other vehicles within range.
    pub fn measure_neighbours(&mut self, position_m: &Vector3<f64>, others: &[Other]) -> Vec<Neighbour> {
        let Self { sensors, range_m, .. } = self;
        let distance_m = |other: &Other| (other.position_m - position_m).norm() - other.body_radius_m;
        let in_range = others.iter().filter(|other| distance_m(other) <= *range_m);
        in_range.map(|other| neighbour(other, sensors)).collect()
    }

    /// Signed distance from a position to the surface of a static obstacle, m; infinite if there is no such obstacle.
    fn distance_m(&self, name: &str, position_m: &Vector3<f64>) -> f64 {
        let cylinders = self.truth.cylinders.iter().filter(|it| it.name == name);
        let cylinders = cylinders.map(|it| it.signed_distance_m(position_m.x, position_m.y));
        let prisms = self.prisms.iter().filter(|it| it.name == name);
        let prisms = prisms.map(|it| it.signed_distance_in_space_m((*position_m).into()));
        cylinders.chain(prisms).fold(f64::INFINITY, f64::min)
    }
}

fn measurement_of(moving: &MovingCylinder, t_s: f64, sensors: &mut Sensors) -> ObstacleMeasurement {
    let in_space = |[x, y]: [f64; 2]| Vector3::new(x, y, 0.0);
    let measured = sensors.measure_other(in_space(moving.position_m(t_s)), in_space(moving.velocity_mps(t_s)));
    ObstacleMeasurement {
        name: moving.name.clone(),
        radius_m: moving.radius_m,
        z_m: moving.z_m,
        position_m: [measured.position_m.x, measured.position_m.y],
        velocity_mps: [measured.velocity_mps.x, measured.velocity_mps.y],
    }
}

fn neighbour(other: &Other, sensors: &mut Sensors) -> Neighbour {
    let measured = sensors.measure_other(other.position_m, other.velocity_mps);
    Neighbour {
        name: other.name.clone(),
        body_radius_m: other.body_radius_m,
        position_m: measured.position_m.into(),
        velocity_mps: measured.velocity_mps.into(),
        plan: other.plan.clone(),
    }
}
