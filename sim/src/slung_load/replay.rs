use nalgebra::{SVector, UnitQuaternion, Vector3};
use scenarios::slung_load::{GRAVITY_MPS2, Model};

use super::dynamics::Plant;
use super::state::SlungLoadState;
use crate::air::{LoggedAir, drag_n};
use crate::runge_kutta;

/// Thrust, tension and air of quadrotor and load over one step of the simulator.
#[derive(Clone, Debug)]
pub struct AppliedControls<'a> {
    /// Mean of the rotors' total thrust over the step, N.
    pub thrust_n: f64,
    /// World from body at the two ends of the step, with a constant angular velocity between them.
    pub attitude: [UnitQuaternion<f64>; 2],
    /// Mean tension of the cable over the step, N.
    pub tension_n: f64,
    /// The air.
    pub air: LoggedAir<'a>,
}

/// Replays a flight by the momentum of its two bodies: the forces are taken from the log, the motion is integrated
/// anew.
///
/// ```text
/// m_Q p_Q'' = F R(t) e_3 + T d - m_Q g e_3 + drag,     m_L p_L'' = -T d - m_L g e_3 + drag,   d along the cable
/// ```
///
/// Taut, slack and impact need no distinction: a slack cable has T = 0, and an impact is a large T over one step.
#[derive(Clone, Copy, Debug)]
pub struct Replay {
    plant: Plant,
    drag_area_m2: f64,
    load_drag_area_m2: f64,
}

/// Positions and velocities of quadrotor and load: p_Q, v_Q, p_L, v_L.
type Motion = SVector<f64, 12>;

impl Replay {
    /// For a vehicle of this model, and its plant with the true masses.
    pub fn new(model: &Model, plant: &Plant) -> Self {
        Self { plant: *plant, drag_area_m2: model.drag_area_m2, load_drag_area_m2: model.load_drag_area_m2 }
    }

    /// Integrates a step by a Runge-Kutta method of order 6. The attitude is the logged one at its end.
    pub fn advanced(&self, start: &SlungLoadState, applied: &AppliedControls<'_>) -> SlungLoadState {
        let mut motion = Motion::zeros();
        let parts = [start.position_m, start.velocity_mps, start.load_position_m, start.load_velocity_mps];
        for (index, part) in parts.iter().enumerate() {
            motion.fixed_rows_mut::<3>(3 * index).copy_from(part);
        }
        let rate = |motion: &Motion, fraction: f64| self.rate(motion, applied, fraction);
        let (step_s, intervals) = (applied.air.step_s(), applied.air.smooth_intervals());
        let motion = runge_kutta::advanced_over_intervals(&motion, step_s, &intervals, rate);
        let part = |index: usize| motion.fixed_rows::<3>(3 * index).into_owned();
        SlungLoadState {
            position_m: part(0),
            velocity_mps: part(1),
            load_position_m: part(2),
            load_velocity_mps: part(3),
            attitude: applied.attitude[1],
            body_rate_radps: Vector3::zeros(),
        }
    }

    fn rate(&self, motion: &Motion, applied: &AppliedControls<'_>, fraction: f64) -> Motion {
        let part = |index: usize| motion.fixed_rows::<3>(3 * index).into_owned();
        let (velocity_mps, load_velocity_mps) = (part(1), part(3));
        let rotation_vector = (applied.attitude[0].inverse() * applied.attitude[1]).scaled_axis() * fraction;
        let axis = applied.attitude[0] * UnitQuaternion::from_scaled_axis(rotation_vector) * Vector3::z();
        let pull_n = (part(2) - part(0)).try_normalize(0.0).unwrap_or_else(Vector3::zeros) * applied.tension_n;
        let wind_mps = applied.air.velocity_mps(fraction);
        let force_n = axis * applied.thrust_n + pull_n + drag_n(&(wind_mps - velocity_mps), self.drag_area_m2);
        let load_force_n = drag_n(&(wind_mps - load_velocity_mps), self.load_drag_area_m2) - pull_n;
        let gravity = Vector3::z() * GRAVITY_MPS2;
        let mut rate = Motion::zeros();
        rate.fixed_rows_mut::<3>(0).copy_from(&velocity_mps);
        rate.fixed_rows_mut::<3>(3).copy_from(&(force_n / self.plant.mass_kg - gravity));
        rate.fixed_rows_mut::<3>(6).copy_from(&load_velocity_mps);
        rate.fixed_rows_mut::<3>(9).copy_from(&(load_force_n / self.plant.load_mass_kg - gravity));
        rate
    }
}
