//! The only place that knows rapier: bodies under gravity and forces.

mod tethered_pair;

use nalgebra::{Quaternion, UnitQuaternion, Vector3};
use rapier3d_f64::prelude::{MassProperties, PhysicsWorld, RigidBody, RigidBodyBuilder, RigidBodyHandle, Vector};

use crate::fixed_wing::gravity_mps2;

pub(crate) use tethered_pair::{AppliedForces, TetheredPair};

/// Rapier cuts off faster bodies.
const MAX_SPEED_MPS: f64 = 1000.0;

/// Bodies under gravity and forces, at a fixed step: points with mass, or such as turn.
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
/// Bodies have no colliders: who touches something is out of the flight, so no contact force is ever needed, and
/// whoever flies them finds out from their ways.
pub(crate) struct RapierWorld {
    physics: PhysicsWorld,
    bodies: Vec<Body>,
}

struct Body {
    /// `None` once removed.
    handle: Option<RigidBodyHandle>,
    force_n: Vector3<f64>,
    torque_nm: Vector3<f64>,
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
        Self { physics, bodies: Vec::new() }
    }

    /// Adds a point of `mass_kg`. Bodies count from 0 in the order of adding.
    pub fn add_body(&mut self, mass_kg: f64, position_m: Vector3<f64>, velocity_mps: Vector3<f64>) {
        let body = RigidBodyBuilder::dynamic()
            .translation(to_rapier(&position_m))
            .linvel(to_rapier(&velocity_mps))
            .additional_mass(mass_kg)
            .lock_rotations()
            .can_sleep(false);
        self.insert(body);
    }

    /// Adds a body that turns: level, at rest about its axes.
    ///
    /// - `inertia_kgm2`: moments of inertia about the body axes, kg m²
    pub fn add_turning_body(
        &mut self,
        mass_kg: f64,
        inertia_kgm2: Vector3<f64>,
        position_m: Vector3<f64>,
        velocity_mps: Vector3<f64>,
    ) {
        let body = RigidBodyBuilder::dynamic()
            .translation(to_rapier(&position_m))
            .linvel(to_rapier(&velocity_mps))
            .additional_mass_properties(MassProperties::new(Vector::ZERO, mass_kg, to_rapier(&inertia_kgm2)))
            .can_sleep(false);
        self.insert(body);
    }

    fn insert(&mut self, body: RigidBodyBuilder) {
        let PhysicsWorld { bodies, colliders, .. } = &mut self.physics;
        let handle = bodies.insert(body);
        // Without this the body has no mass before its first step, and loses the impulse that comes first.
        bodies[handle].recompute_mass_properties_from_colliders(colliders);
        self.bodies.push(Body { handle: Some(handle), force_n: Vector3::zeros(), torque_nm: Vector3::zeros() });
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

    /// Lets one step pass.
    pub fn step(&mut self) {
        // Rapier's own gravity comes before its drift, in full: half of it is taken back before and given after.
        self.apply_half_impulses(-1.0);
        self.physics.step();
        self.apply_half_impulses(1.0);
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
            let force = to_rapier(&body.force_n) + gravity * rigid_body.mass();
            rigid_body.apply_impulse(force * half_step_s, true);
            rigid_body.apply_torque_impulse(to_rapier(&body.torque_nm) * half_step_s, true);
        }
    }
}

fn to_rapier(vector: &Vector3<f64>) -> Vector {
    Vector::new(vector.x, vector.y, vector.z)
}

fn from_rapier(vector: Vector) -> Vector3<f64> {
    Vector3::new(vector.x, vector.y, vector.z)
}
