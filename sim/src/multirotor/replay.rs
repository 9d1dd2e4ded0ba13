use nalgebra::{UnitQuaternion, Vector3, Vector6};
use scenarios::multirotor::{GRAVITY_MPS2, Model};

use crate::air::drag_n;
use crate::runge_kutta;

/// What carries a multirotor during one step of the simulator.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum AppliedControls {
    /// Of a point mass: the acceleration that it was told, beyond what carries its weight, m/s².
    Acceleration(Vector3<f64>),
    /// Of a quadrotor: thrust along its axis.
    Thrust {
        /// Mean of the rotors' total thrust over the step, N.
        mean_n: f64,
        /// World from body at the step's two ends, turning at a constant rate between them.
        attitude: [UnitQuaternion<f64>; 2],
    },
}

/// Follows a flight by its momentum: what carries and what blows is taken from the log, where it goes is integrated anew.
///
/// ```text
/// m p'' = m_0 (a + g e_3) - m g e_3 + drag     or     m p'' = F R(t) e_3 - m g e_3 + drag
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Replay {
    nominal_mass_kg: f64,
    mass_kg: f64,
    drag_area_m2: f64,
}

impl Replay {
    /// Of a vehicle of this model. `mass_ratio`: true mass over the nominal one.
    pub fn new(model: &Model, mass_ratio: f64) -> Self {
        let nominal_mass_kg = model.mass_kg;
        Self { nominal_mass_kg, mass_kg: nominal_mass_kg * mass_ratio, drag_area_m2: model.drag_area_m2 }
    }

    /// Where a step of `step_s`, s, leads, by a Runge-Kutta method of order 6.
    ///
    /// - `start`: position, m, and velocity, m/s, world frame; so is what is returned
    /// - `wind_mps`: velocity of the air at the step's two ends
    pub fn advanced(
        &self,
        [position_m, velocity_mps]: [Vector3<f64>; 2],
        lift: &AppliedControls,
        wind_mps: [Vector3<f64>; 2],
        step_s: f64,
    ) -> [Vector3<f64>; 2] {
        let mut motion = Vector6::zeros();
        motion.fixed_rows_mut::<3>(0).copy_from(&position_m);
        motion.fixed_rows_mut::<3>(3).copy_from(&velocity_mps);
        let motion = runge_kutta::advanced(&motion, step_s, |motion, share| {
            let velocity_mps = motion.fixed_rows::<3>(3).into_owned();
            let wind_mps = wind_mps[0] + (wind_mps[1] - wind_mps[0]) * share;
            let force_n = self.lift_n(lift, share) + drag_n(&(wind_mps - velocity_mps), self.drag_area_m2);
            let mut rate = Vector6::zeros();
            rate.fixed_rows_mut::<3>(0).copy_from(&velocity_mps);
            rate.fixed_rows_mut::<3>(3).copy_from(&(force_n / self.mass_kg - Vector3::z() * GRAVITY_MPS2));
            rate
        });
        [0, 3].map(|row| motion.fixed_rows::<3>(row).into_owned())
    }

    fn lift_n(&self, lift: &AppliedControls, share: f64) -> Vector3<f64> {
        match lift {
            AppliedControls::Acceleration(told_mps2) => {
                (told_mps2 + Vector3::z() * GRAVITY_MPS2) * self.nominal_mass_kg
            }
            AppliedControls::Thrust { mean_n, attitude: [from, to] } => {
                let turn = (from.inverse() * to).scaled_axis() * share;
                from * UnitQuaternion::from_scaled_axis(turn) * Vector3::z() * *mean_n
            }
        }
    }
}
