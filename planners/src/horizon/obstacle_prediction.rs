//! Prediction of moving obstacles: at constant velocity, or along the plans that other vehicles share.

use scenarios::in_loop::{Neighbour, Observation, ObstacleMeasurement};

use crate::free_space::world::altitude_range_m;
use crate::free_space::{Displacement, MovingObstacle, Obstacle, Point};
use crate::multirotor::reference::motion_from_nodes;

/// Sampling time of another vehicle's plan, s.
const PLAN_SAMPLING_S: f64 = 0.125;

/// Predictions of everything that moves, with time 0 when the answer takes effect. Other vehicles have at least the radius
/// `min_neighbour_radius_m`.
pub fn predict(observation: &Observation<'_>, min_neighbour_radius_m: f64) -> Vec<MovingObstacle> {
    let delay_s = observation.takes_effect_s - observation.t_s;
    let obstacles = observation.moving.iter().map(|measurement| obstacle_at_constant_velocity(measurement, delay_s));
    let neighbours = observation.neighbours.iter().map(|neighbour| {
        let radius_m = neighbour.body_radius_m.max(min_neighbour_radius_m);
        neighbour_on_plan(neighbour, radius_m, observation.takes_effect_s)
            .unwrap_or_else(|| neighbour_at_constant_velocity(neighbour, radius_m, delay_s))
    });
    obstacles.chain(neighbours).collect()
}

fn obstacle_at_constant_velocity(measurement: &ObstacleMeasurement, delay_s: f64) -> MovingObstacle {
    let [x, y] = [0, 1].map(|axis| measurement.position_m[axis] + delay_s * measurement.velocity_mps[axis]);
    let shape = Obstacle::cylinder([x, y], measurement.radius_m, altitude_range_m(measurement.z_m));
    let [vx, vy] = measurement.velocity_mps;
    MovingObstacle::at_constant_velocity(shape, Point::new(vx, vy, 0.0))
}

fn neighbour_at_constant_velocity(neighbour: &Neighbour, radius_m: f64, delay_s: f64) -> MovingObstacle {
    let velocity = Point::from(neighbour.velocity_mps);
    let position = Point::from(neighbour.position_m) + velocity * delay_s;
    MovingObstacle::at_constant_velocity(neighbour_shape(position, radius_m), velocity)
}

/// `None` if the neighbour shares no plan.
fn neighbour_on_plan(neighbour: &Neighbour, radius_m: f64, takes_effect_s: f64) -> Option<MovingObstacle> {
    let motion = motion_from_nodes(&neighbour.plan, takes_effect_s)?;
    let (end_s, _) = *motion.last();
    let start = motion.state_at(0.0).position;
    let count = (end_s.max(0.0) / PLAN_SAMPLING_S).ceil() as usize;
    let knot = |i: usize| {
        let at_s = i as f64 * PLAN_SAMPLING_S;
        (at_s, motion.state_at(at_s).position - start)
    };
    let displacement = Displacement::PiecewiseLinear((0..=count).map(knot).collect());
    Some(MovingObstacle { shape: neighbour_shape(start, radius_m), displacement })
}

/// Vehicles keep their separation in the plane, whatever their altitudes.
fn neighbour_shape(position: Point, radius_m: f64) -> Obstacle {
    Obstacle::cylinder([position.x, position.y], radius_m, altitude_range_m(None))
}
