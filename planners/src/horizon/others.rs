//! What moves, as far as it can be foreseen: obstacles at constant velocity, other vehicles on the plans that they share.

use scenarios::in_loop::{Neighbour, Observation, ObstacleMeasurement};

use super::reference::motion;
use crate::free_space::known::altitude_m;
use crate::free_space::vector::{minus, plus, scaled};
use crate::free_space::{Mover, Obstacle, Track};

/// Time between two points of another vehicle's track, s.
const TRACK_S: f64 = 0.125;

/// Everything that moves, with time 0 where the answer takes effect. Other vehicles have `radius_m` at least.
pub fn movers(observation: &Observation<'_>, radius_m: f64) -> Vec<Mover> {
    let delay_s = observation.takes_effect_s - observation.t_s;
    let sighted = observation.moving.iter().map(|sighting| sighted(sighting, delay_s));
    let neighbours = observation.neighbours.iter().map(|neighbour| {
        let radius_m = neighbour.body_radius_m.max(radius_m);
        planned(neighbour, radius_m, observation.takes_effect_s)
            .unwrap_or_else(|| drifting(neighbour, radius_m, delay_s))
    });
    sighted.chain(neighbours).collect()
}

fn sighted(sighting: &ObstacleMeasurement, delay_s: f64) -> Mover {
    let [x, y] = [0, 1].map(|axis| sighting.position_m[axis] + delay_s * sighting.velocity_mps[axis]);
    let shape = Obstacle::cylinder([x, y], sighting.radius_m, altitude_m(sighting.z_m));
    Mover::straight(shape, [sighting.velocity_mps[0], sighting.velocity_mps[1], 0.0])
}

/// A vehicle that says nothing of its plans.
fn drifting(neighbour: &Neighbour, radius_m: f64, delay_s: f64) -> Mover {
    let position = plus(neighbour.position_m, scaled(neighbour.velocity_mps, delay_s));
    Mover::straight(Obstacle::cylinder([position[0], position[1]], radius_m, UNBOUNDED), neighbour.velocity_mps)
}

/// A vehicle that has told its plan.
fn planned(neighbour: &Neighbour, radius_m: f64, takes_effect_s: f64) -> Option<Mover> {
    let motion = motion(&neighbour.plan, takes_effect_s)?;
    let (end_s, _) = *motion.last();
    let begin = motion.state_at(0.0).position;
    let count = (end_s.max(0.0) / TRACK_S).ceil() as usize;
    let point = |i: usize| {
        let at_s = i as f64 * TRACK_S;
        (at_s, minus(motion.state_at(at_s).position, begin))
    };
    let shape = Obstacle::cylinder([begin[0], begin[1]], radius_m, UNBOUNDED);
    Some(Mover { shape, track: Track::Known((0..=count).map(point).collect()) })
}

/// Vehicles keep apart in the plane, whatever their altitudes.
const UNBOUNDED: [f64; 2] = [f64::NEG_INFINITY, f64::INFINITY];
