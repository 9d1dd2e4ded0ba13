use nalgebra::{UnitQuaternion, Vector3};
use rapier3d_f64::prelude::{
    ColliderBuilder, ImpulseJointHandle, MassProperties, PhysicsWorld, RigidBodyBuilder, RigidBodyHandle,
    RopeJointBuilder, Vector,
};
use scenarios::slung_load::{Cable, GRAVITY_MPS2};

use super::{from_rapier, to_rapier};
use crate::slung_load::{Plant, SlungLoadState};

/// Half the size of the block whose top is the ground, m.
const GROUND_M: f64 = 1000.0;
/// Friction between load and ground: it stays where it lies.
const FRICTION: f64 = 0.8;

/// A quadrotor, a load, and rapier's rope between them, at a fixed step.
///
/// Rapier's semi-implicit Euler method becomes one of second order by halves of every impulse before and after its step
/// (see [`RapierWorld`](super::RapierWorld)). The rope keeps the distance by an impulse inside the step, at which the
/// velocities along it are those of the middle of the step. With one solver iteration and none of the internal
/// stabilisation, which takes energy out, the rope's impulse is all of it, and says what the tension was.
pub(crate) struct TetheredPair {
    physics: PhysicsWorld,
    quadrotor: RigidBodyHandle,
    load: RigidBodyHandle,
    rope: ImpulseJointHandle,
    step_s: f64,
    /// Impulse of the rope in the last step, N s.
    impulse_ns: f64,
    /// Was the cable taut in the last step, and in the one before it?
    was_taut: [bool; 2],
}

/// What acts on quadrotor and load during a step, beside gravity, cable and ground.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct AppliedForces {
    /// Force on the quadrotor, world frame, N.
    pub force_n: Vector3<f64>,
    /// Torque on the quadrotor, world frame, N m.
    pub torque_nm: Vector3<f64>,
    /// Force on the load, world frame, N.
    pub load_force_n: Vector3<f64>,
}

impl TetheredPair {
    /// Both at `start`. `load_radius_m`: with it the load lies on the ground, if the plant has one.
    pub fn new(plant: &Plant, load_radius_m: f64, start: &SlungLoadState, step_s: f64) -> Self {
        let mut physics = PhysicsWorld::new();
        physics.gravity = Vector::new(0.0, 0.0, -GRAVITY_MPS2);
        physics.integration_parameters.dt = step_s;
        physics.integration_parameters.num_solver_iterations = 1;
        physics.integration_parameters.num_internal_stabilization_iterations = 0;
        let quadrotor = RigidBodyBuilder::dynamic()
            .translation(to_rapier(&start.position_m))
            .linvel(to_rapier(&start.velocity_mps))
            .rotation(to_rapier(&start.attitude.scaled_axis()))
            .angvel(to_rapier(&(start.attitude * start.body_rate_radps)))
            .additional_mass_properties(MassProperties::new(
                Vector::ZERO,
                plant.mass_kg,
                to_rapier(&plant.inertia_kgm2),
            ))
            .can_sleep(false);
        let load = RigidBodyBuilder::dynamic()
            .translation(to_rapier(&start.load_position_m))
            .linvel(to_rapier(&start.load_velocity_mps))
            .additional_mass(plant.load_mass_kg)
            .lock_rotations()
            .can_sleep(false);
        let quadrotor = physics.bodies.insert(quadrotor);
        let load = physics.bodies.insert(load);
        if plant.resting_height_m.is_finite() {
            let ball = ColliderBuilder::ball(load_radius_m).density(0.0).friction(FRICTION);
            physics.colliders.insert_with_parent(ball, load, &mut physics.bodies);
            let ground_m = plant.resting_height_m - load_radius_m;
            let ground = ColliderBuilder::cuboid(GROUND_M, GROUND_M, GROUND_M).translation(Vector::new(
                0.0,
                0.0,
                ground_m - GROUND_M,
            ));
            physics.insert_collider(ground.friction(FRICTION), None);
        }
        let PhysicsWorld { bodies, colliders, .. } = &mut physics;
        for handle in [quadrotor, load] {
            // Without this a body has no mass before its first step, and loses the impulse that comes first.
            bodies[handle].recompute_mass_properties_from_colliders(colliders);
        }
        let rope = RopeJointBuilder::new(plant.cable_length_m).contacts_enabled(false).build();
        let rope = physics.impulse_joints.insert(quadrotor, load, rope, true);
        Self { physics, quadrotor, load, rope, step_s, impulse_ns: 0.0, was_taut: [false; 2] }
    }

    /// The motion now.
    ///
    /// A half of each step's impulses comes after rapier's own step; the rope's came inside it. While the cable stays taut,
    /// half of it belongs to what comes after: without it, the ends would seem to part by λ h/(2 m). How much that is, is
    /// told by their parting itself, and not by the last impulse, of which the rest of an impact may be a part.
    pub fn body(&self) -> SlungLoadState {
        let (quadrotor, load) = (&self.physics.bodies[self.quadrotor], &self.physics.bodies[self.load]);
        let rotation = quadrotor.rotation();
        let attitude =
            UnitQuaternion::new_normalize(nalgebra::Quaternion::new(rotation.w, rotation.x, rotation.y, rotation.z));
        let mut body = SlungLoadState {
            position_m: from_rapier(quadrotor.translation()),
            velocity_mps: from_rapier(quadrotor.linvel()),
            attitude,
            body_rate_radps: attitude.inverse() * from_rapier(quadrotor.angvel()),
            load_position_m: from_rapier(load.translation()),
            load_velocity_mps: from_rapier(load.linvel()),
        };
        if self.was_taut == [true; 2] {
            let direction = body.cable_m().normalize();
            let parting_mps = direction.dot(&body.load_relative_mps()).max(0.0);
            let half_ns = direction * (parting_mps / (1.0 / quadrotor.mass() + 1.0 / load.mass()));
            body.velocity_mps += half_ns / quadrotor.mass();
            body.load_velocity_mps -= half_ns / load.mass();
        }
        body
    }

    /// Lets one step pass under `loads`, those of its middle.
    pub fn step(&mut self, loads: &AppliedForces) {
        self.apply_half_impulses(loads, -1.0);
        self.physics.step();
        self.apply_half_impulses(loads, 1.0);
        self.impulse_ns =
            self.physics.impulse_joints.get(self.rope).map_or(0.0, |joint| joint.data.limits[0].impulse.abs());
        self.was_taut = [self.impulse_ns > 0.0, self.was_taut[0]];
    }

    /// Impulse of the cable in the last step, N s.
    pub fn impulse_ns(&self) -> f64 {
        self.impulse_ns
    }

    /// What the cable did in the last step.
    pub fn cable(&self) -> Cable {
        if self.was_taut[0] { Cable::Taut } else { Cable::Slack }
    }

    /// Half a step's impulses, and half of gravity's with the sign that is given: rapier gives all of it in its step.
    fn apply_half_impulses(&mut self, loads: &AppliedForces, gravity_sign: f64) {
        let half_step_s = self.step_s / 2.0;
        let gravity = self.physics.gravity * gravity_sign;
        let bodies = &mut self.physics.bodies;
        let quadrotor = &mut bodies[self.quadrotor];
        let force = to_rapier(&loads.force_n) + gravity * quadrotor.mass();
        quadrotor.apply_impulse(force * half_step_s, true);
        quadrotor.apply_torque_impulse(to_rapier(&loads.torque_nm) * half_step_s, true);
        let load = &mut bodies[self.load];
        let force = to_rapier(&loads.load_force_n) + gravity * load.mass();
        load.apply_impulse(force * half_step_s, true);
    }
}
