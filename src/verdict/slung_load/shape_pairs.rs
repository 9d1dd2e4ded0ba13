//! The pairs of shapes that are kept apart, and their distances at one instant.

use scenarios::geometry::Solid;
use scenarios::{Prism, Scenario, Vehicle};
use sim::slung_load::{Part, Parts, SeparatingPlane, SlungLoadState};

use super::motion::{Deviation, Speeds};

/// A shape of the vehicle and what it is kept clear of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shape {
    /// A part and an obstacle, by its index.
    Part(Part, usize),
    /// A part and an obstacle of any shape, by its index.
    Solid(Part, usize),
    /// The envelope circle and an obstacle, by its index.
    Envelope(usize),
    /// The body and the ground.
    AboveGround,
    /// The load and the vehicle's own body.
    LoadToBody,
    /// The cable and one of the vehicle's own rotors, counted from 0.
    CableToRotor(usize),
}

/// The shapes of the vehicle and of the world.
pub struct ShapePairs<'a> {
    pub(super) vehicle: &'a str,
    pub(super) parts: Parts,
    pub(super) obstacles: Vec<Prism>,
    pub(super) solids: Vec<Solid>,
    pub(super) ground_m: Option<f64>,
}

impl<'a> ShapePairs<'a> {
    /// The shapes of a vehicle of the scenario.
    pub fn new(scenario: &Scenario, vehicle: &'a Vehicle) -> Self {
        Self {
            vehicle: &vehicle.name,
            parts: Parts::new(scenario.slung_load_model(vehicle)),
            obstacles: scenario.world.prism_obstacles(),
            solids: scenario.world.solids(),
            ground_m: scenario.world.ground_m,
        }
    }

    /// SlungLoadState, cable and load with every obstacle, and the body with the ground.
    pub(super) fn parts(&self) -> Vec<Shape> {
        let parts = (0..self.obstacles.len()).flat_map(|i| Part::ALL.map(|part| Shape::Part(part, i)));
        let of_solids = (0..self.solids.len()).flat_map(|i| Part::ALL.map(|part| Shape::Solid(part, i)));
        parts.chain(of_solids).chain(self.ground_m.map(|_| Shape::AboveGround)).collect()
    }

    /// The envelope with every obstacle.
    pub(super) fn envelopes(&self) -> Vec<Shape> {
        (0..self.obstacles.len()).map(Shape::Envelope).collect()
    }

    /// Load and cable with the vehicle's own body and rotors.
    pub(super) fn own() -> Vec<Shape> {
        std::iter::once(Shape::LoadToBody).chain((0..Parts::ROTORS).map(Shape::CableToRotor)).collect()
    }

    /// A lower bound of the distance that is fast to compute, m.
    pub(super) fn distance_lower_bound_m(&self, shape: Shape, body: &SlungLoadState) -> f64 {
        match shape {
            Shape::Part(part, obstacle) => self.parts.distance_lower_bound_m(part, body, &self.obstacles[obstacle]),
            Shape::Solid(part, solid) => self.parts.distance_to_solid_lower_bound_m(part, body, &self.solids[solid]),
            _ => self.distance_m(shape, body),
        }
    }

    /// Signed distance, m, and a separating plane, if one is known.
    pub(super) fn distance_and_plane(&self, shape: Shape, body: &SlungLoadState) -> (f64, Option<SeparatingPlane>) {
        match shape {
            Shape::Part(part, obstacle) => {
                let (distance_m, plane) = self.parts.distance_and_plane(part, body, &self.obstacles[obstacle]);
                (distance_m, Some(plane))
            }
            _ => (self.distance_m(shape, body), None),
        }
    }

    /// Signed distance, m.
    pub(super) fn distance_m(&self, shape: Shape, body: &SlungLoadState) -> f64 {
        match shape {
            Shape::Part(part, obstacle) => self.parts.distance_m(part, body, &self.obstacles[obstacle]),
            Shape::Solid(part, solid) => self.parts.distance_to_solid_m(part, body, &self.solids[solid]),
            Shape::Envelope(obstacle) => self.parts.envelope_distance_m(body, &self.obstacles[obstacle]),
            Shape::AboveGround => self.parts.height_m(body) - self.ground_m.unwrap_or(f64::NEG_INFINITY),
            Shape::LoadToBody => self.parts.load_to_body_m(body),
            Shape::CableToRotor(rotor) => self.parts.cable_to_rotor_m(body, rotor),
        }
    }

    /// Largest distance of a point of the shape from where the curves place it, m.
    ///
    /// - `reach_m`: largest distance of the load from the quadrotor
    pub(super) fn deviation_m(&self, shape: Shape, deviation: Deviation, reach_m: f64) -> f64 {
        let Deviation { quadrotor_m, load_m, turn_rad } = deviation;
        match shape {
            Shape::Part(Part::Body, _) | Shape::Solid(Part::Body, _) | Shape::AboveGround => {
                quadrotor_m + turn_rad * self.parts.body_radius_m()
            }
            Shape::Part(Part::Load, _) | Shape::Solid(Part::Load, _) => load_m,
            Shape::Part(Part::Cable, _) | Shape::Solid(Part::Cable, _) => quadrotor_m.max(load_m),
            Shape::Envelope(_) => 2.0 * quadrotor_m + load_m,
            Shape::LoadToBody | Shape::CableToRotor(_) => quadrotor_m + load_m + turn_rad * reach_m,
        }
    }

    /// Upper bound of the speed of any point of the shape's surface relative to what it is kept clear of, m/s.
    pub(super) fn speed_mps(&self, shape: Shape, speeds: &Speeds) -> f64 {
        let body_mps = speeds.quadrotor_mps + speeds.turn_radps * self.parts.body_radius_m();
        match shape {
            Shape::Part(Part::Body, _) | Shape::Solid(Part::Body, _) | Shape::AboveGround => body_mps,
            Shape::Part(Part::Load, _) | Shape::Solid(Part::Load, _) => speeds.load_mps,
            Shape::Part(Part::Cable, _) | Shape::Solid(Part::Cable, _) => speeds.quadrotor_mps.max(speeds.load_mps),
            Shape::Envelope(_) => speeds.quadrotor_mps + speeds.relative_mps,
            Shape::LoadToBody | Shape::CableToRotor(_) => speeds.relative_mps + speeds.turn_radps * speeds.reach_m,
        }
    }
}
