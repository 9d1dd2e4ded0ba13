use nalgebra::Vector3;

/// Density of the air, kg/m³ (ICAO standard atmosphere, sea level).
const AIR_DENSITY_KGPM3: f64 = 1.225;

/// Maximum number of iterations for the velocity in the middle of a step.
const MAX_ITERATIONS: usize = 20;

/// Change of that velocity at which the iteration ends, m/s; the error that remains is smaller by the share of its speed
/// relative to the air that a body loses within half a step.
const TOLERANCE_MPS: f64 = 1e-9;

/// Drag on a body, N: half the density of the air times the drag area times the square of the relative speed.
///
/// - `relative_mps`: velocity of the air relative to the body
pub(crate) fn drag_n(relative_mps: &Vector3<f64>, drag_area_m2: f64) -> Vector3<f64> {
    relative_mps * (relative_mps.norm() * 0.5 * AIR_DENSITY_KGPM3 * drag_area_m2)
}

/// A body in the air, at the beginning of a step.
#[derive(Clone, Copy, Debug)]
pub(crate) struct DragBody {
    pub drag_area_m2: f64,
    pub mass_kg: f64,
    /// Velocity over ground, m/s.
    pub velocity_mps: Vector3<f64>,
}

impl DragBody {
    /// Drag in the middle of a step, N: the implicit midpoint rule, of second order.
    ///
    /// ```text
    /// v_m = v + h/2 (F + D(w - v_m)) / m
    /// ```
    ///
    /// - `wind_mps`: w, velocity of the air in the middle of the step
    /// - `others_n`: F, all other forces on the body
    /// - `step_s`: h
    pub fn mid_step_drag_n(&self, wind_mps: &Vector3<f64>, others_n: &Vector3<f64>, step_s: f64) -> Vector3<f64> {
        let drag_at = |velocity_mps: &Vector3<f64>| drag_n(&(wind_mps - velocity_mps), self.drag_area_m2);
        let mut middle_mps = self.velocity_mps;
        let mut drag_n = drag_at(&middle_mps);
        for _ in 0..MAX_ITERATIONS {
            let next_mps = self.velocity_mps + (others_n + drag_n) * (step_s / (2.0 * self.mass_kg));
            let change_mps = (next_mps - middle_mps).norm();
            middle_mps = next_mps;
            drag_n = drag_at(&middle_mps);
            if change_mps < TOLERANCE_MPS {
                break;
            }
        }
        drag_n
    }
}
