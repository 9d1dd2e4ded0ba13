use nalgebra::{UnitQuaternion, Vector3};
use scenarios::multirotor::{GRAVITY_MPS2, Model};

use crate::air::{LoggedAir, drag_n};
use crate::kinematics::PointState;
use crate::runge_kutta;

/// What lifts a multirotor over one step of the simulator.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum AppliedControls {
    /// Of a point mass: the acceleration in excess of the one that balances gravity, m/s².
    Acceleration(Vector3<f64>),
    /// Of a quadrotor: thrust along its vertical axis.
    Thrust {
        /// Mean of the rotors' total thrust over the step, N.
        mean_n: f64,
        /// World from body at the two ends of the step, with a constant angular velocity between them.
        attitude: [UnitQuaternion<f64>; 2],
    },
}

/// Replays a flight by its momentum: lift and air are taken from the log, the motion is integrated anew.
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
    /// For a vehicle of this model. `mass_ratio`: true mass over the nominal one.
    pub fn new(model: &Model, mass_ratio: f64) -> Self {
        let nominal_mass_kg = model.mass_kg;
        Self { nominal_mass_kg, mass_kg: nominal_mass_kg * mass_ratio, drag_area_m2: model.drag_area_m2 }
    }

    /// Integrates a step by a Runge-Kutta method of order 6. Returns position, m, and velocity, m/s, at its end.
    ///
    /// - first argument: position, m, and velocity, m/s, at the beginning of the step, world frame
    /// - `lift`, `air`: over the step
    pub fn advanced(
        &self,
        [position_m, velocity_mps]: [Vector3<f64>; 2],
        lift: &AppliedControls,
        air: &LoggedAir<'_>,
    ) -> [Vector3<f64>; 2] {
        let start = PointState { position_m, velocity_mps };
        let end =
            runge_kutta::advanced_point(&start, air.step_s(), &air.smooth_intervals(), |velocity_mps, fraction| {
                let drag_n = drag_n(&(air.velocity_mps(fraction) - velocity_mps), self.drag_area_m2);
                let force_n = self.lift_n(lift, fraction) + drag_n;
                force_n / self.mass_kg - Vector3::z() * GRAVITY_MPS2
            });
        [end.position_m, end.velocity_mps]
    }

    fn lift_n(&self, lift: &AppliedControls, fraction: f64) -> Vector3<f64> {
        match lift {
            AppliedControls::Acceleration(acceleration_mps2) => {
                (acceleration_mps2 + Vector3::z() * GRAVITY_MPS2) * self.nominal_mass_kg
            }
            AppliedControls::Thrust { mean_n, attitude: [from, to] } => {
                let rotation_vector = (from.inverse() * to).scaled_axis() * fraction;
                from * UnitQuaternion::from_scaled_axis(rotation_vector) * Vector3::z() * *mean_n
            }
        }
    }
}
