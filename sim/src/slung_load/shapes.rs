//! Body, cable and load as shapes, and their signed distance to the obstacles.

use nalgebra::Vector3;
use parry3d_f64::math::{Pose, Rotation, Vector};
use parry3d_f64::query;
use parry3d_f64::shape::{Ball, ConvexPolyhedron, Cylinder, Segment, Shape};
use scenarios::slung_load::Model;
use scenarios::{Prism, World};

use super::body::Body;

/// Half the thickness of the disc that stands for the body, m.
const HALF_THICKNESS_M: f64 = 0.01;
/// How far a prism without bottom or top reaches beyond the map, m.
const OVERHANG_M: f64 = 100.0;

/// A part of a quadrotor with a load.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Part {
    /// The disc over the rotors.
    Body,
    /// The straight line between its ends.
    Cable,
    /// The ball about the load.
    Load,
}

impl Part {
    /// All of them.
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

/// An obstacle with flat faces.
#[derive(Clone, Debug)]
pub struct Obstacle {
    /// Its name.
    pub name: String,
    /// As a prism, its corners counterclockwise.
    pub prism: Prism,
    solid: ConvexPolyhedron,
}

/// The parts of one vehicle.
#[derive(Clone, Debug)]
pub struct Parts {
    disc: Cylinder,
    ball: Ball,
    body_radius_m: f64,
}

impl Obstacle {
    /// All obstacles of a world that have flat faces.
    pub fn all(world: &World) -> Vec<Self> {
        world.flat_obstacles().into_iter().map(|prism| Self::new(prism, world)).collect()
    }

    fn new(prism: Prism, world: &World) -> Self {
        let unbounded = [world.map.z_m.min - OVERHANG_M, world.map.z_m.max + OVERHANG_M];
        let [low, high] = prism.z_m.map_or(unbounded, |z| [z.min, z.max]);
        let corners: Vec<Vector> =
            prism.corners_m.iter().flat_map(|[x, y]| [low, high].map(|z| Vector::new(*x, *y, z))).collect();
        let solid =
            ConvexPolyhedron::from_convex_hull(&corners).expect("a prism over a convex polygon has a convex hull");
        Self { name: prism.name.clone(), prism, solid }
    }
}

impl Parts {
    /// The parts of a vehicle of this model.
    pub fn of(model: &Model) -> Self {
        Self {
            disc: Cylinder::new(HALF_THICKNESS_M, model.body_radius_m()),
            ball: Ball::new(model.load_radius_m),
            body_radius_m: model.body_radius_m(),
        }
    }

    /// Signed distance between a part and an obstacle, m: negative when they overlap.
    pub fn distance_m(&self, part: Part, body: &Body, obstacle: &Obstacle) -> f64 {
        match part {
            Part::Body => signed_distance_m(&self.disc, &disc_pose(body), obstacle),
            Part::Load => {
                signed_distance_m(&self.ball, &Pose::from_translation(to_parry(&body.load_position_m)), obstacle)
            }
            Part::Cable => {
                let segment = Segment::new(to_parry(&body.position_m), to_parry(&body.load_position_m));
                signed_distance_m(&segment, &Pose::IDENTITY, obstacle)
            }
        }
    }

    /// Signed distance in the plane between the envelope circle and an obstacle at whatever height, m.        [Kang 2020, eq. 14]
    pub fn envelope_distance_m(&self, body: &Body, obstacle: &Obstacle) -> f64 {
        obstacle.prism.signed_distance_m([body.position_m.x, body.position_m.y]) - self.envelope_radius_m(body)
    }

    /// Radius of the envelope circle: that of the body, or the horizontal reach of the load, whichever is larger, m.
    pub fn envelope_radius_m(&self, body: &Body) -> f64 {
        body.cable_m().xy().norm().max(self.body_radius_m)
    }

    /// Largest distance of a point of the body from its centre, m.
    pub fn body_reach_m(&self) -> f64 {
        self.body_radius_m.hypot(HALF_THICKNESS_M)
    }
}

fn signed_distance_m(shape: &dyn Shape, pose: &Pose, obstacle: &Obstacle) -> f64 {
    let contact = query::contact(pose, shape, &Pose::IDENTITY, &obstacle.solid, f64::MAX);
    contact.ok().flatten().map_or(f64::NAN, |contact| contact.dist)
}

/// Parry's cylinders stand along y; the disc lies across the thrust axis.
fn disc_pose(body: &Body) -> Pose {
    let q = body.attitude;
    let attitude = Rotation::from_xyzw(q.i, q.j, q.k, q.w);
    let upright = Rotation::from_rotation_x(std::f64::consts::FRAC_PI_2);
    Pose::from_parts(to_parry(&body.position_m), attitude * upright)
}

fn to_parry(vector: &Vector3<f64>) -> Vector {
    Vector::new(vector.x, vector.y, vector.z)
}
