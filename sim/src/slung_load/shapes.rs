//! Body, cable and load as convex shapes, and their signed distances from the obstacles.

mod convex_part;
mod distance;
mod golden_section;
mod own_body;
mod penetration;
mod solid;

use scenarios::Prism;
use scenarios::geometry::Solid;
use scenarios::slung_load::Model;

use self::convex_part::ConvexPart;
pub use self::distance::{OVERHANG_M, SeparatingPlane};
use self::distance::{point_to_prism_m, to_prism, to_prism_m};
use self::solid::{to_solid_lower_bound_m, to_solid_m};
use super::state::SlungLoadState;

/// A part of a quadrotor with a load.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Part {
    /// The disc over the rotors.
    Body,
    /// The straight line between the ends of the cable.
    Cable,
    /// The ball about the load.
    Load,
}

impl Part {
    /// All parts.
    pub const ALL: [Self; 3] = [Self::Body, Self::Cable, Self::Load];

    /// Its name.
    pub fn name(self) -> &'static str {
        match self {
            Self::Body => "body",
            Self::Cable => "cable",
            Self::Load => "load",
        }
    }
}

/// The parts of one vehicle.
#[derive(Clone, Copy, Debug)]
pub struct Parts {
    body_radius_m: f64,
    load_radius_m: f64,
    propeller_radius_m: f64,
}

impl Parts {
    /// The parts of a vehicle of this model.
    pub fn new(model: &Model) -> Self {
        let (body_radius_m, propeller_radius_m) = (model.body_radius_m(), model.propeller_radius_m);
        Self { body_radius_m, load_radius_m: model.load_radius_m, propeller_radius_m }
    }

    /// Signed distance between a part and an obstacle, whose corners are counterclockwise, m: negative if they overlap.
    pub fn distance_m(&self, part: Part, state: &SlungLoadState, obstacle: &Prism) -> f64 {
        match self.convex_part(part, state) {
            Some(convex) => to_prism_m(&convex, obstacle),
            None => point_to_prism_m(&state.load_position_m, obstacle) - self.load_radius_m,
        }
    }

    /// Signed distance as [`distance_m`](Self::distance_m), and the plane that separates obstacle and part (for the load, its
    /// centre) best, if they do not overlap, or least badly.
    pub fn distance_and_plane(&self, part: Part, state: &SlungLoadState, obstacle: &Prism) -> (f64, SeparatingPlane) {
        match self.convex_part(part, state) {
            Some(convex) => to_prism(&convex, obstacle),
            None => {
                let plane = to_prism(&ConvexPart::Line { ends_m: [state.load_position_m; 2] }, obstacle).1;
                (self.distance_m(part, state, obstacle), plane)
            }
        }
    }

    /// A cheap lower bound of [`distance_m`](Self::distance_m), from the ball around the part, m.
    pub fn distance_lower_bound_m(&self, part: Part, state: &SlungLoadState, obstacle: &Prism) -> f64 {
        match part {
            Part::Body => point_to_prism_m(&state.position_m, obstacle) - self.body_radius_m,
            Part::Cable => {
                let middle_m = (state.position_m + state.load_position_m) / 2.0;
                point_to_prism_m(&middle_m, obstacle) - state.cable_m().norm() / 2.0
            }
            Part::Load => self.distance_m(part, state, obstacle),
        }
    }

    /// Signed distance between a part and an obstacle of any shape, m: negative if they overlap.
    pub fn distance_to_solid_m(&self, part: Part, state: &SlungLoadState, solid: &Solid) -> f64 {
        match self.convex_part(part, state) {
            Some(convex) => to_solid_m(&convex, solid),
            None => solid.signed_distance_m(state.load_position_m.into()) - self.load_radius_m,
        }
    }

    /// A cheap lower bound of [`distance_to_solid_m`](Self::distance_to_solid_m), m.
    pub fn distance_to_solid_lower_bound_m(&self, part: Part, state: &SlungLoadState, solid: &Solid) -> f64 {
        match self.convex_part(part, state) {
            Some(convex) => to_solid_lower_bound_m(&convex, solid),
            None => self.distance_to_solid_m(part, state, solid),
        }
    }

    /// Disc or line; `None` for the load, which is a ball.
    fn convex_part(&self, part: Part, state: &SlungLoadState) -> Option<ConvexPart> {
        let (center_m, axis, radius_m) = (state.position_m, state.thrust_axis(), self.body_radius_m);
        match part {
            Part::Body => Some(ConvexPart::Disc { center_m, axis, radius_m }),
            Part::Cable => Some(ConvexPart::Line { ends_m: [state.position_m, state.load_position_m] }),
            Part::Load => None,
        }
    }

    /// Signed horizontal distance between the envelope circle and an obstacle, at any altitude, m.        [Kang 2020, eq. 14]
    pub fn envelope_distance_m(&self, state: &SlungLoadState, obstacle: &Prism) -> f64 {
        obstacle.signed_distance_m([state.position_m.x, state.position_m.y]) - self.envelope_radius_m(state)
    }

    /// Altitude of the lowest point of the body, m.
    pub fn height_m(&self, state: &SlungLoadState) -> f64 {
        let upright = state.thrust_axis().z;
        state.position_m.z - self.body_radius_m * (1.0 - upright * upright).max(0.0).sqrt()
    }

    /// Radius of the envelope circle, m: the larger one of the body's radius and the load's horizontal distance.
    pub fn envelope_radius_m(&self, state: &SlungLoadState) -> f64 {
        state.cable_m().xy().norm().max(self.body_radius_m)
    }

    /// Radius of the load's ball, m.
    pub fn load_radius_m(&self) -> f64 {
        self.load_radius_m
    }

    /// Radius of the body's disc, m.
    pub fn body_radius_m(&self) -> f64 {
        self.body_radius_m
    }
}
