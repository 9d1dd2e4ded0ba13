use nalgebra::Vector3;
use scenarios::slung_load::Cable;

use super::dynamics::Plant;
use super::state::SlungLoadState;
use crate::kinematics::{AttitudeState, PointState};
use crate::rapier_world::{RapierWorld, Rope};

/// Rapier clips faster bodies.
const MAX_SPEED_MPS: f64 = 400.0;

/// A quadrotor, a load, and a rope between them as rapier bodies.
///
/// The rope keeps the distance by an impulse inside rapier's step, where the velocities along it are those of the
/// middle of the step (see [`RapierWorld`]).
pub(super) struct TetheredPair {
    world: RapierWorld,
    quadrotor: usize,
    load: usize,
    rope: Rope,
    /// Impulse of the rope in the last step, N s.
    impulse_ns: f64,
    /// Was the cable taut in the last step, and in the one before it?
    was_taut: [bool; 2],
}

/// What acts on quadrotor and load in the middle of a step, beside gravity, cable and ground.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct AppliedForces {
    /// Force on the quadrotor, world frame, N.
    pub force_n: Vector3<f64>,
    /// Torque on the quadrotor, world frame, N m.
    pub torque_nm: Vector3<f64>,
    /// Force on the load, world frame, N.
    pub load_force_n: Vector3<f64>,
}

impl TetheredPair {
    /// The pair in a state. `load_radius_m`: the load rests on the ground, if the plant has one, with its centre this
    /// high.
    pub fn new(plant: &Plant, load_radius_m: f64, start: &SlungLoadState) -> Self {
        let mut world = RapierWorld::new(MAX_SPEED_MPS);
        let quadrotor = world.add_rigid_body(
            plant.mass_kg,
            &plant.inertia_kgm2,
            &PointState { position_m: start.position_m, velocity_mps: start.velocity_mps },
            &start.attitude_state(),
        );
        let load_start = PointState { position_m: start.load_position_m, velocity_mps: start.load_velocity_mps };
        let load = world.add_point_mass(plant.load_mass_kg, &load_start);
        if plant.resting_height_m.is_finite() {
            world.add_ground(plant.resting_height_m - load_radius_m, load, load_radius_m);
        }
        let rope = world.add_rope([quadrotor, load], plant.cable_length_m);
        Self { world, quadrotor, load, rope, impulse_ns: 0.0, was_taut: [false; 2] }
    }

    /// The state now.
    ///
    /// Half of each step's impulses is applied after rapier's own step, but the rope's impulse inside it. While the
    /// cable stays taut, half of the rope's impulse belongs to the next step: without a correction the ends would seem
    /// to separate at λ h/(2 m). The correction is computed from this velocity and not from the last impulse, part of
    /// which may belong to an impact.
    pub fn state(&self) -> SlungLoadState {
        let PointState { position_m, velocity_mps } = self.world.point_state(self.quadrotor);
        let AttitudeState { attitude, rate_radps } = self.world.attitude_state(self.quadrotor);
        let load = self.world.point_state(self.load);
        let mut state = SlungLoadState {
            position_m,
            velocity_mps,
            attitude,
            body_rate_radps: rate_radps,
            load_position_m: load.position_m,
            load_velocity_mps: load.velocity_mps,
        };
        if self.was_taut == [true; 2] {
            let [mass_kg, load_mass_kg] = [self.quadrotor, self.load].map(|body| self.world.mass_kg(body));
            let direction = state.cable_m().normalize();
            let separation_mps = direction.dot(&state.load_relative_mps()).max(0.0);
            let half_ns = direction * (separation_mps / (1.0 / mass_kg + 1.0 / load_mass_kg));
            state.velocity_mps += half_ns / mass_kg;
            state.load_velocity_mps -= half_ns / load_mass_kg;
        }
        state
    }

    /// Advances the pair by a step of `step_s`, s, under the forces in its middle.
    pub fn step(&mut self, forces: &AppliedForces, step_s: f64) {
        self.world.set_force_n(self.quadrotor, forces.force_n);
        self.world.set_torque_nm(self.quadrotor, forces.torque_nm);
        self.world.set_force_n(self.load, forces.load_force_n);
        self.world.step(step_s);
        self.impulse_ns = self.world.rope_impulse_ns(self.rope);
        self.was_taut = [self.impulse_ns > 0.0, self.was_taut[0]];
    }

    /// Impulse of the cable in the last step, N s.
    pub fn impulse_ns(&self) -> f64 {
        self.impulse_ns
    }

    /// State of the cable in the last step.
    pub fn cable(&self) -> Cable {
        if self.was_taut[0] { Cable::Taut } else { Cable::Slack }
    }
}
