use nalgebra::Vector3;
use scenarios::fixed_wing::Control;

use super::air_path::{AirPath, gravity_mps2};

/// Maximum number of iterations for the velocity in the middle of a step. Each reduces the error by 2 V / (g n h), some
/// 500.
const MAX_ITERATIONS: usize = 10;

/// Change of the velocity at which the iteration ends, m/s; the error that remains is some 500 times smaller.
const TOLERANCE_MPS: f64 = 1e-6;

/// Force of the load factors in the middle of a step, N, world frame: the implicit midpoint rule, of second order.
///
/// ```text
/// v_m = v + h/2 (F(v_m) / m + g),   F(v) = m_0 g (n_x e_V + n_y e_h + n_z e_n),   axes of v - wind
/// ```
///
/// - `velocity_mps`: over ground, at the beginning of the step
/// - `wind_mps`: velocity of the air in the middle of the step
/// - `control`: constant over the step
/// - `nominal_mass_kg`: m_0, with which load factors become forces
/// - `mass_kg`: m, the true one
/// - `step_s`: h
pub(super) fn mid_step_force_n(
    velocity_mps: &Vector3<f64>,
    wind_mps: &Vector3<f64>,
    control: Control,
    nominal_mass_kg: f64,
    mass_kg: f64,
    step_s: f64,
) -> Vector3<f64> {
    let force_at =
        |velocity: &Vector3<f64>| AirPath::new(&(velocity - wind_mps)).specific_force_mps2(control) * nominal_mass_kg;
    let mut force_n = force_at(velocity_mps);
    let mut middle_mps = *velocity_mps;
    for _ in 0..MAX_ITERATIONS {
        let next_mps = velocity_mps + (force_n / mass_kg + gravity_mps2()) * (step_s / 2.0);
        let change_mps = (next_mps - middle_mps).norm();
        middle_mps = next_mps;
        force_n = force_at(&middle_mps);
        if change_mps < TOLERANCE_MPS {
            break;
        }
    }
    force_n
}
