//! The only place that knows rapier: bodies under gravity and forces, ropes and a ground.

use nalgebra::{Quaternion, UnitQuaternion, Vector3};
use rapier3d_f64::prelude::{
    ColliderBuilder, ImpulseJointHandle, MassProperties, PhysicsWorld, RigidBody, RigidBodyBuilder, RigidBodyHandle,
    RopeJointBuilder, Vector,
};
use scenarios::GRAVITY_MPS2;

use crate::kinematics::{AttitudeState, PointState};

/// Half the edge of the block whose top is the ground, m.
const HALF_GROUND_M: f64 = 1000.0;
/// How deep a ball at rest may be in the ground, m.
const MAX_REST_DEPTH_M: f64 = 1e-4;
/// Coefficient of friction between a ball and the ground: the ball stays where it lies.
const FRICTION: f64 = 0.8;

/// Point masses and rigid bodies under gravity and forces.
///
/// Rapier integrates by the semi-implicit Euler method, of first order. With half of every impulse applied before its
/// step and half after it, gravity's included, the position moves with the mean velocity of the step:
///
/// ```text
/// v_m = v + h/2 (F/m + g),   p' = p + h v_m,   v' = v_m + h/2 (F/m + g)
/// ```
///
/// which is the implicit midpoint rule, of second order, if F is the force at v_m in the middle of the step.
///
/// Bodies have no colliders unless they are to rest on the ground: a vehicle that collides leaves the flight, so that
/// no contact force is needed, and the families detect collisions from the paths of their vehicles.
pub(crate) struct RapierWorld {
    physics: PhysicsWorld,
    bodies: Vec<Body>,
}

/// A rope between two bodies.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Rope(ImpulseJointHandle);

struct Body {
    /// `None` once removed.
    handle: Option<RigidBodyHandle>,
    force_n: Vector3<f64>,
    torque_nm: Vector3<f64>,
}

impl RapierWorld {
    /// An empty world with gravity. Rapier clips speeds at `max_speed_mps`.
    ///
    /// With one solver iteration and no internal stabilisation, which dissipates energy, the impulse of a rope is
    /// applied in full and gives its tension.
    pub fn new(max_speed_mps: f64) -> Self {
        let mut physics = PhysicsWorld::new();
        physics.gravity = Vector::new(0.0, 0.0, -GRAVITY_MPS2);
        physics.integration_parameters.num_solver_iterations = 1;
        physics.integration_parameters.num_internal_stabilization_iterations = 0;
        physics.integration_parameters.normalized_max_linear_velocity = max_speed_mps;
        physics.integration_parameters.normalized_allowed_linear_error = MAX_REST_DEPTH_M;
        Self { physics, bodies: Vec::new() }
    }

    /// Adds a point mass. Returns its index: bodies are numbered from 0 in the order of adding.
    pub fn add_point_mass(&mut self, mass_kg: f64, start: &PointState) -> usize {
        self.insert(body_at(start).additional_mass(mass_kg).lock_rotations())
    }

    /// Adds a rigid body. Returns its index.
    ///
    /// - `inertia_kgm2`: moments of inertia about the body axes, kg m²
    pub fn add_rigid_body(
        &mut self,
        mass_kg: f64,
        inertia_kgm2: &Vector3<f64>,
        start: &PointState,
        AttitudeState { attitude, rate_radps }: &AttitudeState,
    ) -> usize {
        let mass_properties = MassProperties::new(Vector::ZERO, mass_kg, to_rapier(inertia_kgm2));
        let body = body_at(start)
            .rotation(to_rapier(&attitude.scaled_axis()))
            .angvel(to_rapier(&(attitude * rate_radps)))
            .additional_mass_properties(mass_properties);
        self.insert(body)
    }

    fn insert(&mut self, body: RigidBodyBuilder) -> usize {
        let handle = self.physics.bodies.insert(body);
        self.bodies.push(Body { handle: Some(handle), force_n: Vector3::zeros(), torque_nm: Vector3::zeros() });
        self.update_mass(handle);
        self.bodies.len() - 1
    }

    /// Makes rapier compute the mass of a body, which is otherwise 0 before the first step: the first impulse would be
    /// lost.
    fn update_mass(&mut self, handle: RigidBodyHandle) {
        let PhysicsWorld { bodies, colliders, .. } = &mut self.physics;
        bodies[handle].recompute_mass_properties_from_colliders(colliders);
    }

    /// Adds a ground at this altitude, m, on which a body can rest by a ball about its centre of mass.
    pub fn add_ground(&mut self, ground_m: f64, body: usize, ball_radius_m: f64) {
        let handle = self.handle(body);
        let ball = ColliderBuilder::ball(ball_radius_m).density(0.0).friction(FRICTION);
        self.physics.colliders.insert_with_parent(ball, handle, &mut self.physics.bodies);
        let block = ColliderBuilder::cuboid(HALF_GROUND_M, HALF_GROUND_M, HALF_GROUND_M);
        let center = Vector::new(0.0, 0.0, ground_m - HALF_GROUND_M);
        self.physics.insert_collider(block.translation(center).friction(FRICTION), None);
        self.update_mass(handle);
    }

    /// Adds a rope of this length, m, between the centres of mass of two bodies.
    pub fn add_rope(&mut self, bodies: [usize; 2], length_m: f64) -> Rope {
        let rope = RopeJointBuilder::new(length_m).contacts_enabled(false).build();
        let [from, to] = bodies.map(|body| self.handle(body));
        Rope(self.physics.impulse_joints.insert(from, to, rope, true))
    }

    /// Impulse of a rope in the last step, N s.
    pub fn rope_impulse_ns(&self, rope: Rope) -> f64 {
        self.physics.impulse_joints.get(rope.0).map_or(0.0, |joint| joint.data.limits[0].impulse.abs())
    }

    /// Removes a body. Its index stays taken.
    pub fn remove_body(&mut self, body: usize) {
        if let Some(handle) = self.bodies[body].handle.take() {
            self.physics.remove_body(handle);
        }
    }

    /// Position and velocity.
    pub fn point_state(&self, body: usize) -> PointState {
        let body = self.rigid_body(body);
        PointState { position_m: from_rapier(body.translation()), velocity_mps: from_rapier(body.linvel()) }
    }

    /// Mass, kg.
    pub fn mass_kg(&self, body: usize) -> f64 {
        self.rigid_body(body).mass()
    }

    /// Attitude and angular velocity of a rigid body.
    pub fn attitude_state(&self, body: usize) -> AttitudeState {
        let body = self.rigid_body(body);
        let rotation = body.rotation();
        let quaternion = Quaternion::new(rotation.w, rotation.x, rotation.y, rotation.z);
        let attitude = UnitQuaternion::new_normalize(quaternion);
        AttitudeState { attitude, rate_radps: attitude.inverse() * from_rapier(body.angvel()) }
    }

    /// Sets the torque on a body in the middle of the coming step, world frame, N m.
    pub fn set_torque_nm(&mut self, body: usize, torque_nm: Vector3<f64>) {
        self.bodies[body].torque_nm = torque_nm;
    }

    /// Sets the force on a body in the middle of the coming step, world frame, N, without gravity.
    pub fn set_force_n(&mut self, body: usize, force_n: Vector3<f64>) {
        self.bodies[body].force_n = force_n;
    }

    /// Advances the world by a step of `step_s` > 0, s.
    pub fn step(&mut self, step_s: f64) {
        self.physics.integration_parameters.dt = step_s;
        // Rapier applies all of gravity's impulse before it moves the bodies: half of it is taken back before the step,
        // and applied after it.
        self.apply_half_impulses(-1.0);
        self.physics.step();
        self.apply_half_impulses(1.0);
    }

    fn step_s(&self) -> f64 {
        self.physics.integration_parameters.dt
    }

    fn rigid_body(&self, body: usize) -> &RigidBody {
        &self.physics.bodies[self.handle(body)]
    }

    fn handle(&self, body: usize) -> RigidBodyHandle {
        self.bodies[body].handle.expect("the body was removed from the world")
    }

    /// Applies half a step's impulse of every force, and half of gravity's times `gravity_sign`.
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

fn body_at(start: &PointState) -> RigidBodyBuilder {
    RigidBodyBuilder::dynamic()
        .translation(to_rapier(&start.position_m))
        .linvel(to_rapier(&start.velocity_mps))
        .can_sleep(false)
}

fn to_rapier(vector: &Vector3<f64>) -> Vector {
    Vector::new(vector.x, vector.y, vector.z)
}

fn from_rapier(vector: Vector) -> Vector3<f64> {
    Vector3::new(vector.x, vector.y, vector.z)
}
