//! The only place that knows rapier: bodies, gravity, obstacles, and who touched whom when.

mod hoist;

use nalgebra::{Quaternion, UnitQuaternion, Vector3};
use rapier3d_f64::prelude::{
    ColliderBuilder, ColliderHandle, MassProperties, PhysicsWorld, RigidBody, RigidBodyBuilder, RigidBodyHandle, Vector,
};
use scenarios::{Cylinder, Map};

use crate::fixed_wing::gravity_mps2;
use crate::touch::{first_touch, horizontal};

pub(crate) use hoist::{Hoist, Loads};

/// Rapier cuts off faster bodies. It also bounds how far a body moves in a step.
const MAX_SPEED_MPS: f64 = 1000.0;

/// How far pillars reach beyond the map's altitudes, m.
const PILLAR_OVERHANG_M: f64 = 10_000.0;

/// Bodies under gravity, forces and contacts, at a fixed step.
///
/// Rapier integrates by the semi-implicit Euler method, of first order. With half of every impulse given before its step
/// and half after it, gravity's included, the position moves with the mean velocity of the step:
///
/// ```text
/// v_m = v + h/2 (F/m + g),   p' = p + h v_m,   v' = v_m + h/2 (F/m + g)
/// ```
///
/// which is the implicit midpoint rule, of second order, if F is the force at v_m in the middle of the step.
///
/// Colliders only sense: who touches is out of the flight, so no contact force is ever needed. They are larger than the
/// bodies by what a step can cover, and whom rapier finds near is then tested exactly along the step: nothing passes
/// through anything between two steps.
pub(crate) struct RapierWorld {
    physics: PhysicsWorld,
    bodies: Vec<Body>,
    pillars: Vec<Pillar>,
}

struct Body {
    /// `None` once removed.
    handle: Option<RigidBodyHandle>,
    radius_m: f64,
    force_n: Vector3<f64>,
    torque_nm: Vector3<f64>,
    step_start_m: Vector3<f64>,
}

struct Pillar {
    center_m: [f64; 2],
    radius_m: f64,
}

/// A body touched something during the last step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Touch {
    /// When, as a share of the step in [0, 1].
    pub share: f64,
    /// Index of the body.
    pub body: usize,
    /// What it touched.
    pub with: Touched,
}

/// What a body touched, by index in the order of adding.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Touched {
    Body(usize),
    Pillar(usize),
}

/// What a collider stands for; kept in rapier's user data.
#[derive(Clone, Copy)]
enum Tag {
    Body(usize),
    Pillar(usize),
}

impl RapierWorld {
    /// An empty world with gravity. `step_s` > 0.
    pub fn new(step_s: f64) -> Self {
        let mut physics = PhysicsWorld::new();
        physics.gravity = to_rapier(&gravity_mps2());
        physics.integration_parameters.dt = step_s;
        physics.integration_parameters.num_solver_iterations = 1;
        physics.integration_parameters.num_internal_stabilization_iterations = 0;
        physics.integration_parameters.normalized_max_linear_velocity = MAX_SPEED_MPS;
        Self { physics, bodies: Vec::new(), pillars: Vec::new() }
    }

    /// Adds a vertical cylinder that nobody may touch, from far below to far above the map.
    pub fn add_pillar(&mut self, cylinder: &Cylinder, map: &Map) {
        let Cylinder { center_m, radius_m, .. } = *cylinder;
        let middle_m = (map.z_m.min + map.z_m.max) / 2.0;
        let collider = ColliderBuilder::cylinder(map.z_m.width() / 2.0 + PILLAR_OVERHANG_M, radius_m)
            .translation(Vector::new(center_m[0], center_m[1], middle_m))
            // Rapier's cylinders stand along y.
            .rotation(Vector::new(std::f64::consts::FRAC_PI_2, 0.0, 0.0))
            .sensor(true)
            .user_data(Tag::Pillar(self.pillars.len()).to_user_data());
        self.physics.insert_collider(collider, None);
        self.pillars.push(Pillar { center_m, radius_m });
    }

    /// Adds a ball of `mass_kg` and `radius_m` that does not turn. Bodies count from 0 in the order of adding.
    pub fn add_body(&mut self, mass_kg: f64, radius_m: f64, position_m: Vector3<f64>, velocity_mps: Vector3<f64>) {
        let body = RigidBodyBuilder::dynamic()
            .translation(to_rapier(&position_m))
            .linvel(to_rapier(&velocity_mps))
            .additional_mass(mass_kg)
            .lock_rotations()
            .can_sleep(false);
        self.insert(body, radius_m, position_m);
    }

    /// Adds a ball of `radius_m` that turns: level, at rest about its axes.
    ///
    /// - `inertia_kgm2`: moments of inertia about the body axes, kg m²
    pub fn add_turning_body(
        &mut self,
        mass_kg: f64,
        inertia_kgm2: Vector3<f64>,
        radius_m: f64,
        position_m: Vector3<f64>,
        velocity_mps: Vector3<f64>,
    ) {
        let body = RigidBodyBuilder::dynamic()
            .translation(to_rapier(&position_m))
            .linvel(to_rapier(&velocity_mps))
            .additional_mass_properties(MassProperties::new(Vector::ZERO, mass_kg, to_rapier(&inertia_kgm2)))
            .can_sleep(false);
        self.insert(body, radius_m, position_m);
    }

    fn insert(&mut self, body: RigidBodyBuilder, radius_m: f64, position_m: Vector3<f64>) {
        let reach_m = MAX_SPEED_MPS * self.step_s();
        let collider = ColliderBuilder::ball(radius_m + reach_m)
            .density(0.0)
            .sensor(true)
            .user_data(Tag::Body(self.bodies.len()).to_user_data());
        let (handle, _) = self.physics.insert(body, collider);
        // Without this the body has no mass before its first step, and loses the impulse that comes first.
        let PhysicsWorld { bodies, colliders, .. } = &mut self.physics;
        bodies[handle].recompute_mass_properties_from_colliders(colliders);
        self.bodies.push(Body {
            handle: Some(handle),
            radius_m,
            force_n: Vector3::zeros(),
            torque_nm: Vector3::zeros(),
            step_start_m: position_m,
        });
    }

    /// Takes a body out of the world.
    pub fn remove_body(&mut self, body: usize) {
        if let Some(handle) = self.bodies[body].handle.take() {
            self.physics.remove_body(handle);
        }
    }

    /// Position, m.
    pub fn position_m(&self, body: usize) -> Vector3<f64> {
        from_rapier(self.rigid_body(body).translation())
    }

    /// Velocity, m/s.
    pub fn velocity_mps(&self, body: usize) -> Vector3<f64> {
        from_rapier(self.rigid_body(body).linvel())
    }

    /// Mass, kg.
    pub fn mass_kg(&self, body: usize) -> f64 {
        self.rigid_body(body).mass()
    }

    /// Attitude, world from body.
    pub fn attitude(&self, body: usize) -> UnitQuaternion<f64> {
        let rotation = self.rigid_body(body).rotation();
        UnitQuaternion::new_normalize(Quaternion::new(rotation.w, rotation.x, rotation.y, rotation.z))
    }

    /// Angular velocity in body axes, rad/s.
    pub fn body_rate_radps(&self, body: usize) -> Vector3<f64> {
        self.attitude(body).inverse() * from_rapier(self.rigid_body(body).angvel())
    }

    /// Sets the torque on a body in the middle of the coming step, world frame, N m.
    pub fn set_torque_nm(&mut self, body: usize, torque_nm: Vector3<f64>) {
        self.bodies[body].torque_nm = torque_nm;
    }

    /// Sets the force on a body in the middle of the coming step, N; gravity comes on top.
    pub fn set_force_n(&mut self, body: usize, force_n: Vector3<f64>) {
        self.bodies[body].force_n = force_n;
    }

    /// Lets one step pass. Returns who touched what during it, in the order of time, then of the bodies.
    pub fn step(&mut self) -> Vec<Touch> {
        // Rapier's own gravity comes before its drift, in full: half of it is taken back before and given after.
        self.apply_half_impulses(-1.0);
        self.physics.step();
        self.apply_half_impulses(1.0);
        self.touches()
    }

    fn step_s(&self) -> f64 {
        self.physics.integration_parameters.dt
    }

    fn rigid_body(&self, body: usize) -> &RigidBody {
        &self.physics.bodies[self.bodies[body].handle.expect("the body was removed from the world")]
    }

    /// Half a step's impulse of every force, and half of gravity's with the sign that is given.
    fn apply_half_impulses(&mut self, gravity_sign: f64) {
        let half_step_s = self.step_s() / 2.0;
        let gravity = self.physics.gravity * gravity_sign;
        for body in &mut self.bodies {
            let Some(handle) = body.handle else { continue };
            let rigid_body = &mut self.physics.bodies[handle];
            if gravity_sign < 0.0 {
                body.step_start_m = from_rapier(rigid_body.translation());
            }
            let force = to_rapier(&body.force_n) + gravity * rigid_body.mass();
            rigid_body.apply_impulse(force * half_step_s, true);
            rigid_body.apply_torque_impulse(to_rapier(&body.torque_nm) * half_step_s, true);
        }
    }

    /// Follows every pair that rapier found near along the last step.
    fn touches(&self) -> Vec<Touch> {
        let tag = |collider: ColliderHandle| Tag::from_user_data(self.physics.colliders[collider].user_data);
        let near = self.physics.narrow_phase.intersection_pairs().filter(|(_, _, near)| *near);
        let mut touches: Vec<Touch> = near
            .flat_map(|(first, second, _)| match (tag(first), tag(second)) {
                (Tag::Body(a), Tag::Body(b)) => self.touch_of_bodies(a.min(b), a.max(b)),
                (Tag::Body(body), Tag::Pillar(pillar)) | (Tag::Pillar(pillar), Tag::Body(body)) => {
                    self.touch_of_pillar(body, pillar)
                }
                (Tag::Pillar(_), Tag::Pillar(_)) => None,
            })
            .collect();
        touches.sort_by(|a, b| a.share.total_cmp(&b.share).then(a.body.cmp(&b.body)));
        touches
    }

    fn touch_of_bodies(&self, body: usize, other: usize) -> Option<Touch> {
        let [start, end] = self.segment(body);
        let [other_start, other_end] = self.segment(other);
        let reach_m = self.bodies[body].radius_m + self.bodies[other].radius_m;
        let share = first_touch(&(start - other_start), &(end - other_end), reach_m)?;
        Some(Touch { share, body, with: Touched::Body(other) })
    }

    fn touch_of_pillar(&self, body: usize, pillar: usize) -> Option<Touch> {
        let Pillar { center_m: [x_m, y_m], radius_m } = self.pillars[pillar];
        let axis_m = Vector3::new(x_m, y_m, 0.0);
        let [start, end] = self.segment(body).map(|position| horizontal(&(position - axis_m)));
        let share = first_touch(&start, &end, self.bodies[body].radius_m + radius_m)?;
        Some(Touch { share, body, with: Touched::Pillar(pillar) })
    }

    /// Where a body was at the last step's beginning and end; rapier moves it along the straight line between them.
    fn segment(&self, body: usize) -> [Vector3<f64>; 2] {
        [self.bodies[body].step_start_m, self.position_m(body)]
    }
}

impl Tag {
    fn to_user_data(self) -> u128 {
        match self {
            Self::Body(index) => 2 * index as u128,
            Self::Pillar(index) => 2 * index as u128 + 1,
        }
    }

    fn from_user_data(data: u128) -> Self {
        let index = (data / 2) as usize;
        if data.is_multiple_of(2) { Self::Body(index) } else { Self::Pillar(index) }
    }
}

fn to_rapier(vector: &Vector3<f64>) -> Vector {
    Vector::new(vector.x, vector.y, vector.z)
}

fn from_rapier(vector: Vector) -> Vector3<f64> {
    Vector3::new(vector.x, vector.y, vector.z)
}
