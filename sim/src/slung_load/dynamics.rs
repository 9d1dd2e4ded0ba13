use nalgebra::{Quaternion, Vector3, Vector4};
use scenarios::slung_load::{Cable, GRAVITY_MPS2, Model};

use super::state::{Numbers, SlungLoadState};
use crate::quadrotor::RotorGeometry;

/// A load less than this above its resting height, m, and slower than this, m/s, lies on the ground.
const RESTING_M: f64 = 1e-4;
const RESTING_MPS: f64 = 1e-3;

/// Parameters of the equations of motion of a quadrotor and its load.
///
/// ```text
/// m_Q p_Q'' = F R e_3 - m_Q g e_3 + λ d          I ω' = τ - ω × I ω
/// m_L p_L'' =         - m_L g e_3 - λ d          R' = R [ω]×
/// d = (p_L - p_Q) / |p_L - p_Q|,   0 <= λ,   |p_L - p_Q| <= l_0
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Plant {
    /// Mass of the quadrotor m_Q, kg.
    pub mass_kg: f64,
    /// Moments of inertia about the body axes I, kg m².
    pub inertia_kgm2: Vector3<f64>,
    /// Mass of the load m_L, kg.
    pub load_mass_kg: f64,
    /// Length of the taut cable l_0, m.
    pub cable_length_m: f64,
    /// Lever arm of the rotors about x and y, m.
    pub arm_m: f64,
    /// Torque about z for each newton of a rotor's thrust, m.
    pub torque_per_thrust_m: f64,
    /// Height of the load's centre when it lies on the ground, m; -∞ without ground.
    pub resting_height_m: f64,
}

impl Plant {
    /// The nominal plant of a model, above ground at this altitude, m, if there is one.
    pub fn nominal(model: &Model, ground_m: Option<f64>) -> Self {
        Self {
            mass_kg: model.mass_kg,
            inertia_kgm2: model.inertia_kgm2.into(),
            load_mass_kg: model.load_mass_kg,
            cable_length_m: model.cable_length_m,
            arm_m: model.arm_m,
            torque_per_thrust_m: model.torque_per_thrust_m,
            resting_height_m: ground_m.map_or(f64::NEG_INFINITY, |ground_m| ground_m + model.load_radius_m),
        }
    }

    /// Total thrust, N, and torque in body axes, N m, of four rotors with these thrusts, N.        [Kang 2020, eq. 5]
    pub fn wrench(&self, thrust_n: &Vector4<f64>) -> (f64, Vector3<f64>) {
        self.rotors().wrench(thrust_n)
    }

    pub(super) fn rotors(&self) -> RotorGeometry {
        RotorGeometry { arm_m: self.arm_m, torque_per_thrust_m: self.torque_per_thrust_m }
    }

    /// Tension of a taut cable, N, that keeps its length constant; negative where the cable would have to push.
    ///
    /// ```text
    /// λ (1/m_Q + 1/m_L) = |p_L' - p_Q'|²/l - (F/m_Q) d·R e_3
    /// ```
    ///
    /// with the component of the relative velocity across the cable. Gravity acts on both ends alike and cancels.
    ///
    /// - `thrust_n`: total thrust F, N
    pub fn tension_n(&self, state: &SlungLoadState, thrust_n: f64) -> f64 {
        let cable_m = state.cable_m();
        let (length_m, d) = (cable_m.norm(), cable_m.normalize());
        let relative_mps = state.load_relative_mps();
        let across_mps = relative_mps - d * d.dot(&relative_mps);
        let pull_mps2 = across_mps.norm_squared() / length_m - thrust_n / self.mass_kg * d.dot(&state.thrust_axis());
        pull_mps2 * self.reduced_mass_kg()
    }

    /// Reduced mass m_Q m_L / (m_Q + m_L), kg.
    pub fn reduced_mass_kg(&self) -> f64 {
        self.mass_kg * self.load_mass_kg / (self.mass_kg + self.load_mass_kg)
    }

    /// Accelerations of quadrotor and load under a total thrust, N; world frame, m/s².
    pub fn accelerations_mps2(&self, state: &SlungLoadState, thrust_n: f64, cable: Cable) -> [Vector3<f64>; 2] {
        let gravity = Vector3::new(0.0, 0.0, -GRAVITY_MPS2);
        let free = state.thrust_axis() * (thrust_n / self.mass_kg) + gravity;
        match cable {
            Cable::Slack if self.is_resting(state) => [free, Vector3::zeros()],
            Cable::Slack => [free, gravity],
            Cable::Taut => {
                let pull_n = state.cable_m().normalize() * self.tension_n(state, thrust_n);
                [free + pull_n / self.mass_kg, gravity - pull_n / self.load_mass_kg]
            }
        }
    }

    /// Angular acceleration in body axes, rad/s².
    pub fn angular_acceleration_radps2(
        &self,
        body_rate_radps: &Vector3<f64>,
        torque_nm: &Vector3<f64>,
    ) -> Vector3<f64> {
        let momentum = self.inertia_kgm2.component_mul(body_rate_radps);
        (torque_nm - body_rate_radps.cross(&momentum)).component_div(&self.inertia_kgm2)
    }

    /// Does the load lie on the ground?
    pub fn is_resting(&self, state: &SlungLoadState) -> bool {
        state.load_position_m.z <= self.resting_height_m + RESTING_M && state.load_velocity_mps.norm() <= RESTING_MPS
    }

    /// Time derivative of the state under four thrusts, N.
    pub(super) fn rate(&self, numbers: &Numbers, thrust_n: &Vector4<f64>, cable: Cable) -> Numbers {
        let state = SlungLoadState::from_numbers(numbers);
        let (thrust_n, torque_nm) = self.wrench(thrust_n);
        let [acceleration, load_acceleration] = self.accelerations_mps2(&state, thrust_n, cable);
        let quaternion = Quaternion::from(numbers.fixed_rows::<4>(6).into_owned());
        let attitude_rate = quaternion * Quaternion::from_imag(state.body_rate_radps) * 0.5;
        let mut rate = Numbers::zeros();
        rate.fixed_rows_mut::<3>(0).copy_from(&state.velocity_mps);
        rate.fixed_rows_mut::<3>(3).copy_from(&acceleration);
        rate.fixed_rows_mut::<4>(6).copy_from(&attitude_rate.coords);
        rate.fixed_rows_mut::<3>(10).copy_from(&self.angular_acceleration_radps2(&state.body_rate_radps, &torque_nm));
        rate.fixed_rows_mut::<3>(13).copy_from(&state.load_velocity_mps);
        rate.fixed_rows_mut::<3>(16).copy_from(&load_acceleration);
        rate
    }
}

/// Inelastic impact at which a slack cable becomes taut: it removes the velocity ρ' at which the ends separate.
///
/// ```text
/// Λ = ρ' m_Q m_L / (m_Q + m_L),   p_Q' + Λ d/m_Q,   p_L' - Λ d/m_L
/// ```
///
/// Returns the state after the impact, and the impulse Λ, N s: 0 if the ends do not separate.
pub fn impact(plant: &Plant, before: &SlungLoadState) -> (SlungLoadState, f64) {
    let d = before.cable_m().normalize();
    let impulse_ns = (d.dot(&before.load_relative_mps()) * plant.reduced_mass_kg()).max(0.0);
    let after = SlungLoadState {
        velocity_mps: before.velocity_mps + d * (impulse_ns / plant.mass_kg),
        load_velocity_mps: before.load_velocity_mps - d * (impulse_ns / plant.load_mass_kg),
        ..*before
    };
    (after, impulse_ns)
}
